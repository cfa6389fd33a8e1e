#ifndef BATTEN_TESTS_SOLVERS_CONTRACT_CASES_H_
#define BATTEN_TESTS_SOLVERS_CONTRACT_CASES_H_

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "problems/fit_problem.h"
#include "solvers/solver_registry.h"
#include "tests/solvers/dense_fit.h"
#include "tests/solvers/test_context.h"
#include "tests/solvers/test_fits.h"
#include "tests/splines/example_splines.h"

namespace batten {

/// The suite that runs on every registered solver; its tests stand in several contract_*_test.cc.
class EverySolver : public ::testing::TestWithParam<std::string> {
 protected:
  /// As users would write it; what wraps a solver gets one.
  std::string name() const { return SolverRegistry::Global().UsualName(GetParam()); }
};

std::unique_ptr<Solver> MakeSolver(const std::string& name_and_options);

std::string WhyUnsupported(const Problem& problem, const std::string& solver, bool compile = true);

/// One run from the problem's start.
struct SolverTrial {
  SolverTrial(const Problem& problem, const std::string& solver, TestContextOptions options = {},
              bool compile = true);
  int iterations() const { return static_cast<int>(context.iterates().size()) - 1; }

  SolverInfo info;
  TestContext context;
  Eigen::VectorXd x;    // the free variables
  Eigen::VectorXd all;  // all variables
  Outcome outcome;
};

/// The run ended where SolverInfo::limit says, which is not the minimum of E.
bool HasItsOwnLimit(const SolverTrial& trial);

bool SameBits(const Eigen::VectorXd& a, const Eigen::VectorXd& b);

struct ContractProblem {
  std::string name;
  std::function<std::unique_ptr<Problem>()> make;
};

DataSet WithoutWeights(DataSet data);

/// Degrees, ends, dimensions, knots and weights, m > n.
std::vector<ContractProblem> LeastSquaresProblems();

/// As many control points as points, without weights: what the geometric iteration takes too.
std::vector<ContractProblem> InterpolationProblems();

/// A weighted fit and one through all points: each solver takes one of them at least.
std::vector<ContractProblem> TwoProblems();

}  // namespace batten

#endif  // BATTEN_TESTS_SOLVERS_CONTRACT_CASES_H_
