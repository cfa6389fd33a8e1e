#ifndef BATTEN_TESTS_SOLVERS_CONTRACT_CASES_H_
#define BATTEN_TESTS_SOLVERS_CONTRACT_CASES_H_

#include <glog/logging.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cstring>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "problems/fit_problem.h"
#include "solvers/solver_registry.h"
#include "tests/solvers/test_context.h"
#include "tests/solvers/test_fits.h"
#include "tests/splines/example_splines.h"

namespace batten {

/// The suite that runs on every registered solver; its tests stand in several contract_*_test.cc.
class EverySolver : public ::testing::TestWithParam<std::string> {
 protected:
  /// As users would write it; what wraps a solver gets one.
  std::string name() const {
    const bool wraps = SolverRegistry::Global().Find(GetParam())->wraps_solver;
    return wraps ? GetParam() + ":lspia" : GetParam();
  }
};

inline std::unique_ptr<Solver> MakeSolver(const std::string& name_and_options) {
  NameSpec spec;
  std::string error;
  CHECK(ParseNameSpec(name_and_options, &spec, &error)) << error;
  std::unique_ptr<Solver> solver = SolverRegistry::Global().Make(spec, nullptr, &error);
  CHECK(solver != nullptr) << error;
  return solver;
}

inline std::string WhyUnsupported(const Problem& problem, const std::string& solver,
                                  bool compile = true) {
  return MakeSolver(solver)->WhyUnsupported(Objective(&problem, nullptr, {compile}));
}

/// One run from the problem's start.
struct SolverTrial {
  SolverTrial(const Problem& problem, const std::string& solver, TestContextOptions options = {},
              bool compile = true)
      : context(problem, options) {
    Objective objective(&problem, &context, {compile});
    x = objective.start();
    outcome = MakeSolver(solver)->Minimize(&objective, &context, &x);
    all = objective.Expand(x);
  }
  int iterations() const { return static_cast<int>(context.iterates().size()) - 1; }

  TestContext context;
  Eigen::VectorXd x;    // the free variables
  Eigen::VectorXd all;  // all variables
  Outcome outcome;
};

inline bool SameBits(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return a.size() == b.size() &&
         std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<std::size_t>(a.size())) == 0;
}

/// A fit with the interpolation term as a dense least-squares problem ||A P - Q||^2 in the units
/// inside, from the recursive definition of the basis, and its solution nearest to the start.
struct DenseFit {
  explicit DenseFit(const Problem& problem) {
    const CurveFit& fit = *problem.curve_fit();
    const auto m = fit.parameters().size();
    const int n = fit.basis().num_control_points();
    const int d = fit.dimension();
    a.resize(m, n);
    q.resize(m, d);
    for (Eigen::Index i = 0; i < m; ++i) {
      const double weight = problem.terms()[0].family->weight() *
                            (fit.data().weights.has_value() ? (*fit.data().weights)[i] : 1.0);
      for (int j = 0; j < n; ++j) {
        a(i, j) = std::sqrt(weight) * Coefficient(fit.basis(), fit.parameters()[i], j);
      }
      for (int c = 0; c < d; ++c) {
        q(i, c) = std::sqrt(weight) * (fit.data().points(i, c) - fit.setting().center[c]) *
                  fit.setting().scale;
      }
    }
    const Points start = Eigen::Map<const Points>(problem.start().data(), n, d);
    Eigen::JacobiSVD<Eigen::MatrixXd> svd(a, Eigen::ComputeThinU | Eigen::ComputeThinV);
    svd.setThreshold(1e-11);  // as BandedQr::kRankTolerance
    rank = static_cast<int>(svd.rank());
    smallest = svd.singularValues()[rank - 1];
    largest = svd.singularValues()[0];
    solution = start + svd.solve(q - a * start);
  }

  /// Of control point j in C(t).
  static double Coefficient(const BsplineBasis& basis, double t, int j) {
    const int n = basis.num_control_points();
    // The definition is empty at the last of p + 1 equal knots, where the curve ends in P_(n-1).
    if (!basis.periodic() && t == basis.knots().back()) return j == n - 1 ? 1.0 : 0.0;
    long double sum = 0.0L;
    for (int function = j; function < (basis.periodic() ? n + basis.degree() : n); function += n) {
      sum += BasisByDefinition(basis.knots(), function, basis.degree(), t);
    }
    return static_cast<double>(sum);
  }
  Points PointsOf(const Eigen::VectorXd& x) const {
    return Eigen::Map<const Points>(x.data(), a.cols(), q.cols());
  }
  Eigen::VectorXd solution_x() const {
    return Eigen::Map<const Eigen::VectorXd>(solution.data(), solution.size());
  }
  /// E(x) - E*.
  double Gap(const Eigen::VectorXd& x) const {
    return (a * (PointsOf(x) - solution)).squaredNorm();
  }
  double condition() const { return largest / smallest; }  ///< Of A, on its row space.
  /// How far x can be from the solution in what the rows see, when |g| is as given.
  double DistanceFor(double gradient_norm) const {
    return 0.5 * gradient_norm / (smallest * smallest);
  }

  Eigen::MatrixXd a;
  Eigen::MatrixXd q;
  Points solution;
  int rank = 0;
  double smallest = 0.0;  // singular value that is not zero
  double largest = 0.0;
};

struct ContractProblem {
  std::string name;
  std::function<std::unique_ptr<Problem>()> make;
};

inline DataSet WithoutWeights(DataSet data) {
  data.weights.reset();
  return data;
}

/// Degrees, ends, dimensions, knots and weights, m > n.
inline std::vector<ContractProblem> LeastSquaresProblems() {
  std::vector<ContractProblem> problems;
  const auto add = [&problems](FitSpec spec, int m) {
    const auto seed = static_cast<unsigned>(problems.size());
    const int d = 1 + static_cast<int>(seed % 4);
    const bool weighted = seed % 3 != 1;
    const char* ends = spec.closed                        ? "closed"
                       : spec.ends == EndKnots::kFloating ? "floating"
                                                          : "clamped";
    problems.push_back({std::string(ends) + " degree " + std::to_string(spec.degree) + ", " +
                            ToString(spec.knots) +
                            " knots, n = " + std::to_string(spec.control_points) +
                            ", d = " + std::to_string(d) + (weighted ? ", weighted" : ""),
                        [=] {
                          DataSet data = MakeNoisyLoop(m, d, 100 + seed);
                          return MakeFit(weighted ? data : WithoutWeights(data), spec);
                        }});
  };
  for (const int degree : {1, 2, 3, 5, 9}) {
    for (const KnotRule knots : {KnotRule::kUniform, KnotRule::kAveraged}) {
      for (const bool closed : {true, false}) {
        FitSpec spec = MakeSpec(degree, closed, 19);
        spec.knots = knots;
        add(spec, 60);
      }
      FitSpec spec = MakeSpec(degree, false, 15);
      spec.knots = knots;
      spec.ends = EndKnots::kFloating;
      add(spec, 60);
    }
  }
  // The basis wraps onto itself, or its band overlaps its corner.
  for (const auto& [degree, n] : {std::pair(3, 6), {3, 3}, {3, 1}, {2, 4}, {5, 2}, {9, 12}}) {
    add(MakeSpec(degree, true, n), 30);
  }
  return problems;
}

/// As many control points as points, without weights: what the geometric iteration takes too.
inline std::vector<ContractProblem> InterpolationProblems() {
  std::vector<ContractProblem> problems;
  for (const int degree : {1, 2, 3, 5}) {
    for (const bool closed : {true, false}) {
      const int d = 1 + static_cast<int>(problems.size() % 4);
      problems.push_back(
          {std::string(closed ? "closed" : "clamped") + " degree " + std::to_string(degree) +
               " through all points, d = " + std::to_string(d),
           [=] {
             FitSpec spec = MakeSpec(degree, closed, 24);
             spec.knots = KnotRule::kAveraged;
             return MakeFit(
                 WithoutWeights(MakeNoisyLoop(24, d, 200u + static_cast<unsigned>(degree))), spec);
           }});
    }
  }
  return problems;
}

/// A weighted fit and one through all points: each solver takes one of them at least.
inline std::vector<ContractProblem> TwoProblems() {
  return {{"weighted closed curve",
           [] { return MakeFit(MakeNoisyLoop(50, 2, 1), MakeSpec(3, true, 17)); }},
          InterpolationProblems()[5]};
}

}  // namespace batten

#endif  // BATTEN_TESTS_SOLVERS_CONTRACT_CASES_H_
