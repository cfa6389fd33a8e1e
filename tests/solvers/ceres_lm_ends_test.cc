// How runs of ceres_lm are counted and how they end; ceres_lm_test.cc is about their answers.
#include <ceres/sized_cost_function.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "cost_functions/cost_function_family.h"
#include "problems/test_functions.h"
#include "solvers/ceres_lm.h"
#include "tests/roundoff.h"
#include "tests/solvers/test_fits.h"
#include "tests/solvers/trial.h"

namespace batten {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

using LmTrial = Trial<CeresLmSolver>;

TEST(CeresLmEnds, CountsWhatCeresEvaluates) {
  // Accepted steps: E at the new point, then E, r and J there once more; at the start the latter.
  const auto problem = Rhino();
  const LmTrial trial(*problem, "ceres_lm/radius=1e4");
  const int iterations = static_cast<int>(trial.context.iterates().size()) - 1;
  EXPECT_GE(iterations, 2);
  EXPECT_EQ(trial.context.count(Evaluation::kJacobian), iterations + 1);
  EXPECT_EQ(trial.context.count(Evaluation::kEnergy), 2 * iterations + 1);
  EXPECT_EQ(trial.context.count(Evaluation::kGradient), 0);
  EXPECT_EQ(trial.context.evaluations().front().x, trial.context.iterates().front());
}

TEST(CeresLmEnds, StopsWhenTheMonitorSaysNoAndAsksItNoMore) {
  const auto problem = Rhino();
  for (const int max_energies : {0, 1, 2, 3}) {
    TestContextOptions options;
    options.max_energies = max_energies;
    LmTrial trial(*problem, "ceres_lm/radius=1e4", options);
    EXPECT_EQ(trial.outcome.reason, StopReason::kTimeLimit) << max_energies;
    EXPECT_EQ(trial.context.count(Evaluation::kEnergy), max_energies);
    EXPECT_EQ(trial.context.refused(), 1) << max_energies;
    EXPECT_EQ(trial.context.iterates().front(), problem->start()) << max_energies;
    EXPECT_EQ(trial.context.iterates().back(), trial.x) << max_energies;
  }
}

TEST(CeresLmEnds, SaysWhenCeresEndsByItselfAndLogsNothing) {
  const auto problem = Rhino();
  TestContextOptions never;
  never.gradient_tolerance = -1.0;
  never.stop_at_rounding_floor = false;
  for (const char* name : {"ceres_lm", "ceres_lm/radius=1e4", "ceres_lm/strategy=dogleg"}) {
    ::testing::internal::CaptureStderr();
    LmTrial trial(*problem, name, never);
    EXPECT_THAT(::testing::internal::GetCapturedStderr(), IsEmpty()) << name;
    EXPECT_EQ(trial.outcome.reason, StopReason::kNativeStop) << name;
    EXPECT_THAT(trial.outcome.message, StartsWith("Ceres: ")) << name;
    EXPECT_EQ(trial.context.iterates().back(), trial.x) << name;
    for (const Eigen::VectorXd& iterate : trial.context.iterates()) {
      // Ceres compares its own sums of 200 squares; these are summed in another order.
      EXPECT_LE(trial.context.Energy(trial.x),
                trial.context.Energy(iterate) * (1.0 + 200.0 * kEpsilon))
          << name;
    }
  }
}

TEST(CeresLmEnds, ReturnsTheStartWhereNothingIsFree) {
  const auto problem = MakeTestProblem("rosenbrock");
  SetConstraints({{"first", {{0, 1.0}}, 0.25}, {"second", {{1, 1.0}}, 0.5}}, problem.get());
  LmTrial trial(*problem, "ceres_lm");
  EXPECT_EQ(trial.x.size(), 0);
  EXPECT_EQ(trial.context.iterates().size(), 1U);
  EXPECT_TRUE(IsSuccess(trial.outcome.reason));
}

/// Has no value left of zero.
class RootCost final : public ceres::SizedCostFunction<1, 1> {
 public:
  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    if (x[0][0] < 0.0) return false;
    residuals[0] = std::sqrt(x[0][0]) - 2.0;
    if (jacobians != nullptr) jacobians[0][0] = 0.5 / std::sqrt(x[0][0]);
    return true;
  }
};

std::unique_ptr<Problem> MakeRootProblem(double start) {
  auto problem = std::make_unique<Problem>("root");
  problem->AddVariables("x", Eigen::VectorXd::Constant(1, start));
  auto family = std::make_unique<CostFunctionFamily>();
  family->AddBlock(std::make_unique<RootCost>(), {0});
  problem->AddTerm("root", std::move(family));
  return problem;
}

TEST(CeresLmEnds, BacksUpFromPointsWithoutAValue) {
  const auto problem = MakeRootProblem(100.0);
  const LmTrial trial(*problem, "ceres_lm");  // Gauss-Newton steps to -60
  EXPECT_EQ(trial.outcome.reason, StopReason::kGradientSmall);
  EXPECT_NEAR(trial.x[0], 4.0, 1e-8);  // E'' = 1 / 8 there, |g| <= 1e-10 |g(start)| < 1e-10
}

TEST(CeresLmEnds, CallsAStartWithoutAValueANumericalFailure) {
  const auto problem = MakeRootProblem(-1.0);
  TestContextOptions never;
  never.gradient_tolerance = -1.0;
  const LmTrial trial(*problem, "ceres_lm", never);
  EXPECT_EQ(trial.outcome.reason, StopReason::kNumericalFailure);
  EXPECT_EQ(trial.x[0], -1.0);
}

TEST(CeresLmEnds, SaysWhyNot) {
  const auto problem = Rhino();
  EXPECT_THAT(WhyUnsupported<CeresLmSolver>(*problem, "ceres_lm"), IsEmpty());
  EXPECT_THAT(
      WhyUnsupported<CeresLmSolver>(*problem, "ceres_lm/strategy=dogleg/linear_solver=cgnr"),
      HasSubstr("needs a factorization"));
}

}  // namespace
}  // namespace batten
