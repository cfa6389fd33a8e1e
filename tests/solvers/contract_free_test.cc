#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/roundoff.h"
#include "tests/solvers/contract_cases.h"

namespace batten {
namespace {

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
                            "free_parameter/weight=0.3/loss=huber/loss_scale=0.02",
                            "free_parameter,free_parameter/weight=0.5/loss=cauchy"}) {
    SCOPED_TRACE(terms);
    const auto problem =
        MakeFit(MakeNoisyLoop(50, 2, 1), MakeFreeSpec(3, true, 12, "circle", terms));
    ExpectRunsOrRefuses(*problem, free_name());
    if (!needs_free_parameters()) continue;
    const std::string why = WhyUnsupported(*problem, free_name());
    if (problem->terms().size() == 1) {
      EXPECT_EQ(why, "");
    } else {
      EXPECT_THAT(why, ::testing::HasSubstr("takes one free_parameter"));
    }
  }
}

/// The curve passes through a point where it begins, one coordinate is given further on, and two
/// control points are tied to each other.
std::vector<LinearConstraint> OnControlPoints(const Problem& problem) {
  const CurveFit& fit = *problem.curve_fit();
  const BsplineBasis& basis = fit.basis();
  const double unit = fit.setting().scale;
  std::vector<LinearConstraint> constraints;
  for (int c = 0; c < fit.dimension(); ++c) {
    constraints.push_back(
        HoldCurve(problem, basis.domain_begin(), c, (c == 0 ? 2.4 : 0.16) * unit));
  }
  constraints.push_back(
      HoldCurve(problem, basis.domain_begin() + 0.6 * basis.domain_length(), 1, -0.8 * unit));
  const int last = basis.num_control_points() - 1;
  const int d = fit.dimension();
  constraints.push_back({"tied", {{last * d, 1.0}, {(last - 1) * d, -1.0}}, 0.4 * unit});
  return constraints;
}

/// Parameters that are held stay so.
void AddConstraints(std::vector<LinearConstraint> constraints, Problem* problem) {
  const CurveFit& fit = *problem->curve_fit();
  if (fit.setting().ends_held) {
    for (const int i : {0, static_cast<int>(fit.parameters().size()) - 1}) {
      const int variable = fit.setting().parameter_offset + i;
      constraints.push_back({"end held", {{variable, 1.0}}, problem->start()[variable]});
    }
  }
  SetConstraints(constraints, problem);
}

double LargestMiss(const std::vector<LinearConstraint>& constraints, const Eigen::VectorXd& all) {
  double largest = 0.0;
  for (const LinearConstraint& constraint : constraints) {
    double miss = -constraint.value;
    for (const auto& [variable, coefficient] : constraint.coefficients) {
      miss += coefficient * all[variable];
    }
    largest = std::max(largest, std::abs(miss));
  }
  return largest;
}

TEST_P(EverySolver, HoldsConstraintsOnTheControlPointsOfFreeFits) {
  for (const ContractProblem& row : MovingProblems()) {
    const auto problem = row.make();
    const bool takes_it_without = WhyUnsupported(*problem, free_name()).empty();
    const std::vector<LinearConstraint> constraints = OnControlPoints(*problem);
    AddConstraints(constraints, problem.get());
    const std::string why = WhyUnsupported(*problem, free_name());
    if (!takes_it_without) continue;
    SCOPED_TRACE(row.name);
    ASSERT_EQ(why, "");
    const SolverTrial trial(*problem, free_name(), {3000});
    // Data are of size 1 inside.
    for (const Eigen::VectorXd& iterate : trial.context.iterates()) {
      ASSERT_LE(LargestMiss(constraints, problem->elimination().Expand(iterate)), 1e-12);
    }
    EXPECT_NE(trial.outcome.reason, StopReason::kNumericalFailure) << trial.outcome.message;
    const Objective objective(problem.get(), nullptr);
    SolverTrial copy(*problem, free_name(), {0});
    EXPECT_LT(copy.context.Energy(trial.x), copy.context.Energy(objective.start()));
    EXPECT_TRUE(IsSuccess(trial.outcome.reason) || !ReachesTheMinimum(GetParam()))
        << ToString(trial.outcome.reason) << ": " << trial.outcome.message;
    if (IsSuccess(trial.outcome.reason)) {
      // Along the constraints, by the terms' own derivatives.
      EXPECT_LE(copy.context.GradientNorm(trial.x),
                std::max(1e-10 * trial.context.gradient_norms().front(),
                         objective.GradientRoundingFloor(trial.x)));
    }
  }
}

TEST_P(EverySolver, FindsTheMinimumOfLbfgsWhereConstraintsBindFreeFits) {
  if (!ReachesTheMinimum(GetParam()) && GetParam() != "ceres_lm") return;
  for (const ContractProblem& row : MovingProblems()) {
    const auto problem = row.make();
    AddConstraints(OnControlPoints(*problem), problem.get());
    if (!WhyUnsupported(*problem, free_name()).empty()) continue;
    SCOPED_TRACE(row.name);
    SolverTrial trial(*problem, free_name(), {3000});
    // Ceres ends by itself where a step no longer changes E measurably (docs/solvers/ceres_lm.md).
    const bool is_end_of_ceres =
        GetParam() == "ceres_lm" && trial.outcome.reason == StopReason::kNativeStop;
    ASSERT_TRUE(IsSuccess(trial.outcome.reason) || is_end_of_ceres)
        << ToString(trial.outcome.reason);
    // From its end, moved along the constraints by up to 1e-3: the same basin.
    Objective objective(problem.get(), nullptr);
    Eigen::VectorXd x = trial.x;
    std::mt19937 random(20240904);
    for (double& coordinate : x) coordinate += RandomBetween(-1e-3, 1e-3, &random);
    problem->SetStart(objective.Expand(x));
    SolverTrial lbfgs(*problem, "lbfgs", {20000});
    const double energy = lbfgs.context.Energy(lbfgs.x);
    const double noise = Objective::EnergyRoundingFloor(energy, objective.ResidualSize(lbfgs.x));
    // E is flat at a minimum: of a gradient small by 1e-10 the square counts.
    EXPECT_NEAR(trial.context.Energy(trial.x), energy, 1e-9 * energy + 64 * noise)
        << ToString(lbfgs.outcome.reason);
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
