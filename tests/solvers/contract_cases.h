#ifndef BATTEN_TESTS_SOLVERS_CONTRACT_CASES_H_
#define BATTEN_TESTS_SOLVERS_CONTRACT_CASES_H_

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
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

/// Numbers are about 1: roundings of a step, with room.
inline constexpr double kRoundingOfStep = 1e-13;

/// A solver as users would write it for problems with free parameters.
std::string FreeName(const std::string& registered);

/// The suite that runs on every registered solver; its tests stand in several contract_*_test.cc.
class EverySolver : public ::testing::TestWithParam<std::string> {
 protected:
  /// As users would write it; what wraps a solver gets one.
  std::string name() const { return SolverRegistry::Global().UsualName(GetParam()); }
  /// The same for problems with free parameters, where another base is usual.
  std::string free_name() const { return FreeName(GetParam()); }
  /// Ceres' blocks keep the spans that the points are in at the start, and are no part of E once a
  /// point leaves them and their neighbours.
  bool keeps_its_spans() const { return GetParam() == "ceres_lm"; }
  /// It takes no problem but those with free parameters.
  bool needs_free_parameters() const {
    const std::vector<std::string> needs = SolverRegistry::Global().Find(GetParam())->needs;
    return std::find(needs.begin(), needs.end(), "free parameters") != needs.end();
  }
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

/// A number that the run has noted.
double Noted(const SolverTrial& trial, const std::string& name);

/// The run ended where SolverInfo::limit says, which is not the minimum of E.
bool HasItsOwnLimit(const SolverTrial& trial);

void ExpectOneSentenceWithAWayOut(const std::string& sentence, const std::string& solver);

/// A solver takes a problem and lowers E, or says why it does not.
void ExpectRunsOrRefuses(const Problem& problem, const std::string& solver, bool compile = true);

/// Where solvers start, in the free variables.
Eigen::VectorXd StartOf(const Problem& problem);

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

/// Parameters are variables: closed and open, 2-D and 3-D, weighted, few control points, with ends
/// held and with another term.
std::vector<ContractProblem> FreeProblems();

/// Parameters are the foot points: closed and open, 2-D and 3-D, weighted.
std::vector<ContractProblem> ProjectedProblems();

struct SupportedProblem {
  std::string solver;  // as it is written for this problem
  std::string name;
  std::unique_ptr<Problem> problem;
};

/// Those of TwoProblems(), FreeProblems() and ProjectedProblems() that a registered solver takes.
std::vector<SupportedProblem> SupportedProblems(const std::string& registered);

}  // namespace batten

#endif  // BATTEN_TESTS_SOLVERS_CONTRACT_CASES_H_
