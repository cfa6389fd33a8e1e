#include "solvers/lbfgs.h"

#include <ceres/autodiff_cost_function.h>
#include <gtest/gtest.h>

#include "cost_functions/cost_function_family.h"
#include "problems/test_functions.h"
#include "tests/roundoff.h"
#include "tests/solvers/contract_cases.h"

namespace batten {
namespace {

class LbfgsOnTestFunctions : public ::testing::TestWithParam<const char*> {};

TEST_P(LbfgsOnTestFunctions, ReachesAKnownMinimum) {
  for (const TestFunction& function : TestFunctions()) {
    SCOPED_TRACE(function.name);
    const auto problem = MakeTestProblem(function.name);
    SolverTrial trial(*problem, GetParam());
    // The floor of sums of squares that vanish, and the last digit of those that do not.
    EXPECT_TRUE(IsSuccess(trial.outcome.reason) ||
                trial.outcome.reason == StopReason::kLineSearchEnded)
        << ToString(trial.outcome.reason) << " after " << trial.iterations();
    const double energy = trial.context.Energy(trial.x);
    double above = std::numeric_limits<double>::infinity();
    double scale = 1.0;
    for (const TestFunction::Minimum& minimum : function.minima) {
      if (std::abs(energy - minimum.energy) >= above) continue;
      above = std::abs(energy - minimum.energy);
      scale = std::max(1.0, minimum.energy);
    }
    EXPECT_LT(above, 1e-10 * scale);
    EXPECT_LT(trial.context.gradient_norms().back(),
              1e-6 * std::max(1.0, trial.context.gradient_norms().front()));
  }
}

INSTANTIATE_TEST_SUITE_P(Options, LbfgsOnTestFunctions,
                         ::testing::Values("lbfgs", "lbfgs/memory=3", "lbfgs/memory=20",
                                           "lbfgs/wolfe=strong", "lbfgs/wolfe=strong/c2=0.5"),
                         [](const auto& options) {
                           return "Case" + std::to_string(options.index);
                         });

TEST(Lbfgs, EvaluatesNoPointTwice) {
  for (const char* name : {"rosenbrock", "wood", "helical_valley"}) {
    const auto problem = MakeTestProblem(name);
    const SolverTrial trial(*problem, "lbfgs");
    std::vector<Eigen::VectorXd> points;
    for (const auto& evaluated : trial.context.evaluations()) {
      if (evaluated.kind == Evaluation::kGradient) points.push_back(evaluated.x);
    }
    for (std::size_t i = 1; i < points.size(); ++i) {
      EXPECT_FALSE(SameBits(points[i], points[i - 1])) << name << " evaluation " << i;
    }
  }
}

TEST(Lbfgs, BeginsWithThePlainGradientAtMostOfLengthOne) {
  const auto problem = MakeTestProblem("rosenbrock");
  const SolverTrial trial(*problem, "lbfgs", {1});
  Objective objective(problem.get(), nullptr);
  Eigen::VectorXd gradient;
  ASSERT_EQ(objective.Gradient(problem->start(), &gradient), Status::kOk);
  // The paper's H0 = I gives the direction; the first trial step is 1 / |g| where |g| > 1.
  const auto& first_trial = trial.context.evaluations()[2].x;
  EXPECT_LT((first_trial - problem->start() + gradient.normalized()).norm(), 8 * kEpsilon);
}

TEST(Lbfgs, OnAQuadraticAnIterationIsOneProductAndOneGradient) {
  const auto problem = MakeFit(MakeNoisyLoop(50, 2, 1), MakeSpec(3, true, 17));
  const SolverTrial trial(*problem, "lbfgs");
  EXPECT_EQ(trial.outcome.reason, StopReason::kGradientSmall);
  EXPECT_EQ(trial.context.count(Evaluation::kEnergy), 0);
  EXPECT_EQ(trial.context.count(Evaluation::kGradient), 1 + trial.iterations());
  EXPECT_EQ(trial.context.count(Evaluation::kProduct), trial.iterations());
}

TEST(Lbfgs, ReachesTheRoundingFloorOfAQuadratic) {
  TestContextOptions options;
  options.gradient_tolerance = -1.0;
  for (const char* name : {"animals/rhino_100.csv", "animals/dolphin_80.csv"}) {
    const auto problem = MakeFileFit(name, MakeSpec(3, true, 40));
    const SolverTrial trial(*problem, "lbfgs", options);
    EXPECT_EQ(trial.outcome.reason, StopReason::kRoundingFloor) << trial.outcome.message;
  }
}

TEST(Lbfgs, NeedsNoMoreIterationsForHugeWeights) {
  const auto plain = MakeFit(MakeNoisyLoop(50, 2, 1), MakeSpec(3, true, 17));
  const auto heavy =
      MakeFit(MakeNoisyLoop(50, 2, 1), MakeSpec(3, true, 17, "interpolation/weight=1e30"));
  const SolverTrial a(*plain, "lbfgs");
  const SolverTrial b(*heavy, "lbfgs");
  // Only the first step knows the unit of E.
  EXPECT_LE(b.iterations(), a.iterations() + 10);
  EXPECT_TRUE(IsSuccess(b.outcome.reason));
}

/// Two blocks: x0^2 + x1^2, and one without a number where x0 > 1.
struct Edge {
  template <typename T>
  bool operator()(const T* x, T* residuals) const {
    residuals[0] = x[0] + T(3.0);
    residuals[1] = 100.0 * x[1];
    return x[0] < T(1.0) && x[0] > T(-2.5);
  }
};

TEST(Lbfgs, BacksUpWhereTheObjectiveHasNoNumber) {
  Problem problem("edge");
  problem.AddVariables("x", Eigen::Vector2d(0.5, 0.3));
  auto family = std::make_unique<CostFunctionFamily>();
  family->AddBlock(std::make_unique<ceres::AutoDiffCostFunction<Edge, 2, 2>>(new Edge), {0});
  problem.AddTerm("edge", std::move(family));
  SolverTrial trial(problem, "lbfgs", {60});
  // The infimum lies on the edge, x0 = -2.5, which has no value itself.
  EXPECT_TRUE(trial.x.allFinite());
  EXPECT_GT(trial.x[0], -2.5);
  EXPECT_NEAR(trial.x[0], -2.5, 1e-3);
  EXPECT_NEAR(trial.x[1], 0.0, 1e-3);
}

TEST(Lbfgs, WeakConditionsNeedNoMoreEvaluationsThanStrongOnes) {
  for (const char* name : {"rosenbrock", "wood", "brown_dennis"}) {
    const auto problem = MakeTestProblem(name);
    const SolverTrial weak(*problem, "lbfgs/wolfe=weak/c2=0.5");
    const SolverTrial strong(*problem, "lbfgs/wolfe=strong/c2=0.5");
    EXPECT_TRUE(weak.x.allFinite() && strong.x.allFinite());
    const auto per_iteration = [](const SolverTrial& trial) {
      return static_cast<double>(trial.context.count(Evaluation::kGradient)) / trial.iterations();
    };
    EXPECT_LE(per_iteration(weak), per_iteration(strong) + 0.05) << name;
  }
}

}  // namespace
}  // namespace batten
