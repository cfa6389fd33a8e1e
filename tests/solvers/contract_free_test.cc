#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/solvers/contract_cases.h"

namespace batten {
namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();

/// Methods that come near their minimum faster than linearly, or linearly at a good rate: points
/// slide along the curve, which takes the others thousands of iterations.
bool ReachesTheMinimum(const std::string& registered) {
  for (const char* fast : {"foot_newton", "newton", "lm_schur", "varpro", "sdm"}) {
    if (registered == fast) return true;
  }
  return false;
}

void ExpectEndsLower(const SupportedProblem& row, bool is_fast) {
  SolverTrial trial(*row.problem, row.solver, {3000});
  const double start = trial.context.Energy(Objective(row.problem.get(), nullptr).start());
  // Noise is a small part of how far the start is off; 0.2 leaves room for what ends early.
  EXPECT_LT(trial.context.Energy(trial.x), 0.2 * start);
  EXPECT_NE(trial.outcome.reason, StopReason::kNumericalFailure) << trial.outcome.message;
  EXPECT_TRUE(IsSuccess(trial.outcome.reason) || !is_fast)
      << ToString(trial.outcome.reason) << ": " << trial.outcome.message << ", iterations "
      << trial.iterations();
  if (!IsSuccess(trial.outcome.reason)) return;
  // What is claimed is seen by an objective that the solver does not know.
  const double first = trial.context.gradient_norms().front();
  const double last = trial.context.GradientNorm(trial.x);
  const double floor = Objective(row.problem.get(), nullptr).GradientRoundingFloor(trial.x);
  EXPECT_LE(last, std::max(1e-10 * first, floor));
}

std::vector<ContractProblem> MovingProblems() {
  std::vector<ContractProblem> problems = FreeProblems();
  for (ContractProblem& row : ProjectedProblems()) problems.push_back(std::move(row));
  return problems;
}

TEST_P(EverySolver, EndsFreeFitsWhereTheJointGradientIsSmall) {
  int num_runs = 0;
  for (const SupportedProblem& row : SupportedProblems(GetParam())) {
    if (!row.problem->curve_fit()->has_free_parameters() || keeps_its_spans()) continue;
    SCOPED_TRACE(row.name);
    ++num_runs;
    ExpectEndsLower(row, ReachesTheMinimum(GetParam()));
  }
  if (needs_free_parameters()) {
    EXPECT_EQ(num_runs, static_cast<int>(FreeProblems().size()));
  }
}

TEST_P(EverySolver, EndsProjectedFitsWhereTheGradientIsSmall) {
  int num_runs = 0;
  for (const SupportedProblem& row : SupportedProblems(GetParam())) {
    if (!row.problem->curve_fit()->is_projected()) continue;
    SCOPED_TRACE(row.name);
    ++num_runs;
    ExpectEndsLower(row, ReachesTheMinimum(GetParam()));
  }
  for (const char* known :
       {"lbfgs", "ceres_lbfgs", "ceres_lm", "newton", "lm_schur", "gi", "pdm", "tdm", "sdm"}) {
    if (GetParam() != known) continue;
    EXPECT_EQ(num_runs, static_cast<int>(ProjectedProblems().size()));
  }
}

TEST_P(EverySolver, ScalesFreeFitsExactlyWithPowersOfTwo) {
  for (const ContractProblem& row : MovingProblems()) {
    const auto problem = row.make();
    if (!WhyUnsupported(*problem, free_name()).empty()) continue;
    SCOPED_TRACE(row.name);
    const SolverTrial plain(*problem, free_name(), {60});
    for (const double scale : {0x1p-20, 0x1p20}) {
      DataSet data = problem->curve_fit()->data();
      data.points *= scale;
      const auto scaled = MakeFit(data, problem->curve_fit()->spec());
      ASSERT_TRUE(SameBits(problem->start(), scaled->start()));
      const SolverTrial trial(*scaled, free_name(), {60});
      EXPECT_EQ(plain.iterations(), trial.iterations());
      EXPECT_TRUE(SameBits(plain.x, trial.x));
    }
  }
}

TEST_P(EverySolver, StaysAtTheMinimumOfAFreeFit) {
  for (const ContractProblem& row : MovingProblems()) {
    const auto problem = row.make();
    if (!WhyUnsupported(*problem, free_name()).empty()) continue;
    SCOPED_TRACE(row.name);
    const SolverTrial best(*problem, "newton");
    ASSERT_TRUE(IsSuccess(best.outcome.reason)) << ToString(best.outcome.reason);
    TestContext context(*problem, {100, -1.0, false});
    Objective objective(problem.get(), &context);
    Eigen::VectorXd x = best.x;
    MakeSolver(free_name())->Minimize(&objective, &context, &x);
    const double energy = context.Energy(best.x);
    // Differences of E are seen to this; methods that may rise by it do so a few times.
    const double noise =
        64 * Objective::EnergyRoundingFloor(energy, objective.ResidualSize(best.x));
    for (const Eigen::VectorXd& iterate : context.iterates()) {
      ASSERT_LE(context.Energy(iterate), energy + noise);
    }
  }
}

TEST_P(EverySolver, RunsOrRefusesLossesOnFreeParameters) {
  for (const char* terms : {"free_parameter/loss=cauchy/loss_scale=0.01",
                            "free_parameter,interpolation/loss=huber/loss_scale=0.02",
                            "free_parameter,free_parameter/weight=0.5/loss=cauchy"}) {
    SCOPED_TRACE(terms);
    const auto problem =
        MakeFit(MakeNoisyLoop(50, 2, 1), MakeFreeSpec(3, true, 12, "circle", terms));
    ExpectRunsOrRefuses(*problem, free_name());
    if (needs_free_parameters()) {
      EXPECT_THAT(WhyUnsupported(*problem, free_name()), ::testing::HasSubstr("without loss"));
    }
  }
}

TEST_P(EverySolver, RunsOrRefusesConstraintsOnTheControlPointsOfFreeFits) {
  const auto problem = FreeProblems()[0].make();
  SetConstraints({HoldCurve(*problem, 0.3, 0, 0.1), HoldCurve(*problem, 0.3, 1, -0.2)},
                 problem.get());
  if (!keeps_its_spans()) ExpectRunsOrRefuses(*problem, free_name());
  if (needs_free_parameters()) {
    EXPECT_THAT(WhyUnsupported(*problem, free_name()), ::testing::HasSubstr("no constraints but"));
  }
}

TEST_P(EverySolver, RunsOrRefusesBoundsOnFreeFits) {
  const auto problem = FreeProblems()[0].make();
  Eigen::VectorXd upper =
      Eigen::VectorXd::Constant(problem->num_variables(), std::numeric_limits<double>::infinity());
  upper.head(problem->ranges().front().size).setConstant(0.6);
  problem->SetBounds(-upper, upper);
  ExpectRunsOrRefuses(*problem, free_name());
  if (needs_free_parameters()) {
    EXPECT_THAT(WhyUnsupported(*problem, free_name()), ::testing::HasSubstr("ignores bounds"));
  }
}

TEST_P(EverySolver, RefusesFixedParametersWhereItNeedsFreeOnes) {
  if (!needs_free_parameters()) return;
  const auto problem = MakeFit(MakeNoisyLoop(50, 2, 1), MakeSpec(3, true, 12));
  const std::string why = WhyUnsupported(*problem, free_name());
  ExpectOneSentenceWithAWayOut(why, free_name());
  EXPECT_THAT(why, ::testing::HasSubstr("needs free parameters; here they are fixed"));
}

}  // namespace
}  // namespace batten
