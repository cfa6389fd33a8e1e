#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "solvers/solver_registry.h"
#include "tests/experiments/outlines.h"
#include "tests/roundoff.h"

namespace batten {
namespace {

using ::testing::IsEmpty;

/// Of the data's size: what all solvers agree to in every control point.
constexpr double kAgreement = 1e-8;

/// All registered ones whose limit is the minimum, and the other steps of lspia that converge
/// everywhere.
std::vector<std::string> Solvers() {
  std::vector<std::string> solvers;
  for (const std::string& name : SolverRegistry::Global().Names()) {
    if (!SolverRegistry::Global().Find(name)->limit.empty()) continue;
    solvers.push_back(SolverRegistry::Global().UsualName(name));
  }
  for (const char* step : {"optimal", "cauchy", "barzilai_borwein"}) {
    solvers.push_back(std::string("lspia/step=") + step);
  }
  return solvers;
}

struct Change {
  std::string name;
  std::function<void(FixedFit*)> apply;
  /// Of control points: what the change makes of an answer.
  std::function<Points(const Points&)> answer;
};

Points Rotated(const Points& points) {
  Eigen::Matrix2d rotation;
  rotation << std::cos(0.7), std::sin(0.7), -std::sin(0.7), std::cos(0.7);
  return points * rotation;
}

Points ShiftedBy(const Points& points, Eigen::Index shift) {
  Points shifted(points.rows(), points.cols());
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    shifted.row(i) = points.row((i + shift) % points.rows());
  }
  return shifted;
}

Change Scaled(const std::string& name, double factor) {
  return {name, [factor](FixedFit* fit) { fit->data.points *= factor; },
          [factor](const Points& points) { return Points(factor * points); }};
}

/// The first point is another one, and parameters and knots move with it.
void ShiftDataWithTheirKnots(FixedFit* fit) {
  const Eigen::Index shift = 7;
  const Eigen::Index m = fit->data.points.rows();
  const double first = (*fit->data.parameters)[shift];
  fit->data.points = ShiftedBy(fit->data.points, shift);
  for (double& knot : fit->knots) knot -= first;
  Eigen::VectorXd parameters(m);
  for (Eigen::Index i = 0; i < m; ++i) {
    const Eigen::Index from = (i + shift) % m;
    parameters[i] = (*fit->data.parameters)[from] - first + (from < shift ? 1.0 : 0.0);
  }
  fit->data.parameters = parameters;
}

/// Backwards: parameter -t, knot -u. Basis function j becomes n + p - 1 - j, of n modulo n.
void Reverse(FixedFit* fit) {
  fit->data.points = Points(fit->data.points.colwise().reverse());
  fit->data.parameters = Eigen::VectorXd(-fit->data.parameters->reverse());
  std::reverse(fit->knots.begin(), fit->knots.end());
  for (double& knot : fit->knots) knot = -knot;
}

Points ReversedAnswer(const Points& points) {
  constexpr int kDegree = 3;
  const Eigen::Index n = points.rows();
  Points reversed(n, points.cols());
  for (Eigen::Index j = 0; j < n; ++j) reversed.row((n + kDegree - 1 - j) % n) = points.row(j);
  return reversed;
}

std::vector<Change> Changes(double size) {
  const double far = 1e6 * size;
  return {
      {"AsTheyAre", [](FixedFit*) {}, [](const Points& points) { return points; }},
      {"MovedByAMillionSizes", [far](FixedFit* fit) { fit->data.points.array() += far; },
       [far](const Points& points) { return Points(points.array() + far); }},
      Scaled("ScaledDown", 1e-6),
      Scaled("ScaledUp", 1e6),
      {"Rotated", [](FixedFit* fit) { fit->data.points = Rotated(fit->data.points); }, Rotated},
      {"Reversed", Reverse, ReversedAnswer},
      {"ShiftedWithTheirKnots", ShiftDataWithTheirKnots,
       [](const Points& points) { return points; }},
  };
}

class Agreement : public ::testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Outlines, Agreement,
                         ::testing::Values("rhino", "squirrel", "dolphin", "cat"),
                         [](const auto& outline) { return outline.param; });

/// Run to the floor, or to where its own search ends; not to a limit.
void ExpectEndedByItself(const RunResult& result) {
  EXPECT_TRUE(IsSuccess(result.outcome.reason) ||
              result.outcome.reason == StopReason::kNativeStop ||
              result.outcome.reason == StopReason::kLineSearchEnded)
      << ToString(result.outcome.reason) << " after " << result.iterations << ": "
      << result.outcome.message;
}

/// Every solver that takes `problem` against banded_qr; the number of those.
int ExpectAllAgree(const Problem& problem) {
  const RunResult direct = RunSolver(problem, "banded_qr");
  EXPECT_THAT(direct.outcome.message, IsEmpty()) << "else only A P could be compared";
  const Points expected = ControlPointsOf(problem, direct);
  const double size = problem.curve_fit()->size();
  int num_runs = 0;
  for (const std::string& solver : Solvers()) {
    SCOPED_TRACE(solver);
    const RunResult result = RunSolver(problem, solver, ToTheFloor());
    if (!result.skipped.empty()) continue;
    ++num_runs;
    ExpectEndedByItself(result);
    const Points difference = ControlPointsOf(problem, result) - expected;
    EXPECT_LT(difference.rowwise().norm().maxCoeff(), kAgreement * size);
  }
  return num_runs;
}

/// Solvers that do not refuse `problem`.
int NumberThatTake(const Problem& problem) {
  const Objective objective(&problem, nullptr);
  int number = 0;
  for (const std::string& solver : Solvers()) {
    NameSpec name;
    std::string error;
    EXPECT_TRUE(ParseNameSpec(solver, &name, &error));
    const auto made = SolverRegistry::Global().Make(name, nullptr, &error);
    number += made->WhyUnsupported(objective).empty() ? 1 : 0;
  }
  // Those of the first release but gim, and the second step of lspia.
  EXPECT_GE(number, 8);
  return number;
}

TEST_P(Agreement, AllSolversHoldThroughMovedScaledTurnedAndShiftedData) {
  const auto problem = LoadCatalogueProblem(GetParam());
  const Points plain = ControlPointsOf(*problem, RunSolver(*problem, "banded_qr"));
  for (const Change& change : Changes(SizeOf(problem->curve_fit()->data().points))) {
    SCOPED_TRACE(change.name);
    FixedFit fit(*problem);
    change.apply(&fit);
    const auto changed = fit.Make();
    EXPECT_EQ(ExpectAllAgree(*changed), NumberThatTake(*changed));
    const Points answer = ControlPointsOf(*changed, RunSolver(*changed, "banded_qr"));
    const Points expected = change.answer(plain);
    EXPECT_LT((answer - expected).rowwise().norm().maxCoeff(),
              kAgreement * changed->curve_fit()->size());
  }
}

TEST_P(Agreement, AllSolversIncludingGimPassThroughAllPoints) {
  const auto problem = LoadCatalogueProblem(GetParam() + "_interpolation");
  EXPECT_EQ(ExpectAllAgree(*problem), NumberThatTake(*problem));
  EXPECT_TRUE(RunSolver(*problem, "gim").skipped.empty());
}

TEST_P(Agreement, PowersOfTwoChangeNoBitAndNoIteration) {
  const auto problem = LoadCatalogueProblem(GetParam());
  for (const std::string& solver : Solvers()) {
    SCOPED_TRACE(solver);
    const RunResult plain = RunSolver(*problem, solver);
    if (!plain.skipped.empty()) continue;
    for (const double factor : {0x1p-20, 0x1p20}) {
      FixedFit fit(*problem);
      fit.data.points *= factor;
      const auto scaled = fit.Make();
      const RunResult result = RunSolver(*scaled, solver);
      EXPECT_EQ(result.iterations, plain.iterations);
      EXPECT_EQ(result.outcome.reason, plain.outcome.reason);
      EXPECT_EQ(ControlPointsOf(*scaled, result), factor * ControlPointsOf(*problem, plain));
      EXPECT_EQ(result.energy, factor * factor * plain.energy);
      EXPECT_EQ(result.gradient_norm, factor * plain.gradient_norm);
    }
  }
}

/// Iterations until |g| has lost six digits: before Ceres' line search, which sees differences of E
/// itself, ends in their rounding noise, where the iteration it ends in is chance.
int IterationsToSixDigits(const RunResult& result) {
  constexpr double kSixDigits = 1e-6;
  for (const TraceRow& row : result.trace) {
    if (row.gradient_norm <= kSixDigits * result.start_gradient_norm) return row.iteration;
  }
  ADD_FAILURE() << result.solver.ToString() << " does not come that far";
  return -1;
}

TEST_P(Agreement, ChangesHardlyMoveTheNumberOfIterations) {
  const auto problem = LoadCatalogueProblem(GetParam());
  for (const std::string& solver : Solvers()) {
    const RunResult plain = RunSolver(*problem, solver);
    if (!plain.skipped.empty()) continue;
    for (const Change& change : Changes(SizeOf(problem->curve_fit()->data().points))) {
      FixedFit fit(*problem);
      change.apply(&fit);
      const RunResult result = RunSolver(*fit.Make(), solver);
      // A tenth, and one for the first step, which the scale inside changes by up to 2.
      const int expected = IterationsToSixDigits(plain);
      // Where control points are numbered otherwise, draws hit others.
      const int part = solver == "randomised_pia" ? 5 : 10;
      EXPECT_NEAR(IterationsToSixDigits(result), expected, 1 + expected / part)
          << solver << " " << change.name;
    }
  }
}

/// (E(x_k) - E*) / (E(x_0) - E*) of each iterate kept: the rows' product with x_k - x*, which no
/// rounding of E blurs.
int IterationsToGap(const Problem& problem, const std::string& solver, double gap) {
  Objective objective(&problem, nullptr);
  const BandedRows& rows = objective.curve_view()->rows();
  const Eigen::VectorXd best = RunSolver(problem, "banded_qr").x;
  RunSpec spec;
  spec.gradient_tolerance = 0.0;
  spec.keep_iterates = true;
  const RunResult result = RunSolver(problem, solver, spec);
  double start_gap = 0.0;
  for (const Iterate& iterate : result.iterates) {
    const Eigen::VectorXd difference = iterate.x - best;
    const double now = rows.SquaredNormOfProduct(difference.data());
    if (iterate.iteration == 0) start_gap = now;
    if (now <= gap * start_gap) return iterate.iteration;
  }
  ADD_FAILURE() << solver << " does not reach gap " << gap;
  return 0;
}

TEST_P(Agreement, LbfgsNeedsAQuarterOfTheIterationsOfLspia) {
  const auto problem = LoadCatalogueProblem(GetParam());
  const int lbfgs = IterationsToGap(*problem, "lbfgs/memory=10", 1e-10);
  const int lspia = IterationsToGap(*problem, "lspia/step=diagonal", 1e-10);
  EXPECT_LE(4 * lbfgs, lspia);
  RecordProperty("lbfgs", lbfgs);
  RecordProperty("lspia", lspia);
}

/// ||A (x + v) - Q||^2 - ||A x - Q||^2 in long double, row by row, as v'(2 A'(A x - Q)) + |A v|^2.
long double ExactDifference(const Problem& problem, const Eigen::VectorXd& x,
                            const Eigen::VectorXd& v) {
  Objective uncompiled(&problem, nullptr, {false});
  SparseRows jacobian;
  Eigen::VectorXd residuals;
  EXPECT_EQ(uncompiled.Jacobian(x, &residuals, &jacobian), Status::kOk);
  using LongVector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;
  const LongVector av = jacobian.cast<long double>() * v.cast<long double>();
  return 2.0L * av.dot(residuals.cast<long double>()) + av.squaredNorm();
}

TEST_P(Agreement, EnergyAlongALineIsTheExactDifference) {
  const auto problem = LoadCatalogueProblem(GetParam());
  Objective objective(problem.get(), nullptr);
  ASSERT_TRUE(objective.is_quadratic());
  const Eigen::VectorXd x = RunSolver(*problem, "lspia",
                                      [] {
                                        RunSpec spec;
                                        spec.max_iterations = 20;
                                        return spec;
                                      }())
                                .x;
  Eigen::VectorXd gradient, product;
  ASSERT_EQ(objective.Gradient(x, &gradient), Status::kOk);
  const Eigen::VectorXd direction = -gradient;
  ASSERT_EQ(objective.HessianTimes(x, direction, &product), Status::kOk);
  const double slope = gradient.dot(direction), curvature = direction.dot(product);
  double energy = 0.0;
  ASSERT_EQ(objective.Energy(x, &energy), Status::kOk);
  for (const double step : {1.0, 1e-2, 1e-5, 1e-8, 1e-13}) {
    const double change = step * (slope + 0.5 * step * curvature);
    const auto exact = static_cast<double>(ExactDifference(*problem, x, step * direction));
    // The gradient carries the rounding of residuals, eps times the data, not that of E.
    const double rounding = 64 * kEpsilon * std::sqrt(static_cast<double>(x.size()));
    EXPECT_NEAR(change, exact, rounding * step * direction.norm()) << step;
    EXPECT_NEAR(change / exact, 1.0, 1e-6) << step;
    if (step > 1e-13) continue;
    double after = 0.0;
    ASSERT_EQ(objective.Energy(x + step * direction, &after), Status::kOk);
    EXPECT_GT(std::abs((after - energy) / exact - 1.0), 1e-3)
        << "a difference of energies is noise";
  }
}

}  // namespace
}  // namespace batten
