#include "solvers/ceres_problem.h"

#include <ceres/autodiff_cost_function.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "cost_functions/cost_function_family.h"
#include "tests/roundoff.h"
#include "tests/solvers/test_context.h"
#include "tests/solvers/test_fits.h"

namespace batten {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

Objective::Options Uncompiled() {
  Objective::Options options;
  options.compile = false;
  return options;
}

/// x with noise of standard deviation 0.1 on every variable.
Eigen::VectorXd Disturbed(Eigen::VectorXd x, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 0.1);
  for (double& value : x) value += noise(random);
  return x;
}

struct CostAndGradient {
  CostAndGradient(const Problem& problem, const Eigen::VectorXd& x) {
    Objective objective(&problem, nullptr, Uncompiled());
    CeresProblem ceres_problem(&objective, Evaluation::kGradient, x);
    ceres_problem.AddTerms();
    std::vector<double> values;
    CHECK(ceres_problem.problem()->Evaluate({}, &cost, nullptr, &values, nullptr));
    gradient = Eigen::Map<const Eigen::VectorXd>(values.data(), x.size());
  }
  double cost = 0.0;
  Eigen::VectorXd gradient;
};

TEST(CeresProblem, CostAndGradientAreHalfOfOursBitForBit) {
  for (const char* terms : {"interpolation", "interpolation/weight=0.7",
                            "interpolation/loss=huber/loss_scale=0.05/weight=3,interpolation"}) {
    const auto problem = MakeFit(MakeNoisyLoop(80, 3, 31), MakeSpec(3, true, 15, terms));
    Objective objective(problem.get(), nullptr, Uncompiled());
    const Eigen::VectorXd x = Disturbed(objective.start(), 32);
    double energy = 0.0;
    Eigen::VectorXd gradient;
    ASSERT_EQ(objective.EnergyAndGradient(x, &energy, &gradient), Status::kOk);
    const CostAndGradient half(*problem, x);
    EXPECT_EQ(energy, 2.0 * half.cost) << terms;
    EXPECT_EQ(gradient, 2.0 * half.gradient) << terms;
  }
}

TEST(CeresProblem, HasTheBlocksOfTheTermsAndOneGate) {
  const auto problem = MakeFit(MakeNoisyLoop(80, 2, 33), MakeSpec(3, false, 15));
  Objective objective(problem.get(), nullptr);
  CeresProblem ceres_problem(&objective, Evaluation::kGradient, objective.start());
  ceres_problem.AddTerms();
  EXPECT_EQ(ceres_problem.problem()->NumParameterBlocks(), 15);
  EXPECT_EQ(ceres_problem.problem()->NumParameters(), 30);
  EXPECT_EQ(ceres_problem.problem()->NumResidualBlocks(), 81);
  EXPECT_EQ(ceres_problem.problem()->NumResiduals(), 161);
}

LinearConstraint Fixed(int variable, double value) { return {"fixed", {{variable, 1.0}}, value}; }

TEST(CeresProblem, FollowsTheFreeVariablesOfEveryKindOfConstraint) {
  auto problem = MakeFit(MakeNoisyLoop(80, 2, 34), MakeSpec(3, false, 12));
  LinearConstraint mean{"mean of x", {}, 0.25};
  for (int j = 0; j < 12; ++j) mean.coefficients.emplace_back(2 * j, 1.0 / 12.0);
  std::vector<LinearConstraint> first_span;
  for (int v = 0; v < 8; ++v) first_span.push_back(Fixed(v, 0.01 * v));
  const std::vector<std::vector<LinearConstraint>> all_constraints = {
      {},
      {HoldCurve(*problem, 0.4, 0, 0.1), HoldCurve(*problem, 0.4, 1, -0.2)},
      {HoldCurve(*problem, 0.4, 1, -0.2)},
      {mean},
      first_span,  // the blocks of the first span become constants
      {Fixed(0, 0.3), Fixed(23, 0.1), {"ends meet in y", {{1, 1.0}, {23, -1.0}}, 0.0}},
  };
  for (std::size_t i = 0; i < all_constraints.size(); ++i) {
    SetConstraints(all_constraints[i], problem.get());
    Objective objective(problem.get(), nullptr, Uncompiled());
    const Eigen::VectorXd y = Disturbed(objective.start(), 35);
    double energy = 0.0;
    Eigen::VectorXd gradient;
    ASSERT_EQ(objective.EnergyAndGradient(y, &energy, &gradient), Status::kOk);
    const CostAndGradient half(*problem, y);
    // 160 squares of residuals that are sums of few products below 2.
    EXPECT_NEAR(2.0 * half.cost, energy, 200.0 * kEpsilon * (energy + 1.0)) << i;
    EXPECT_LE((2.0 * half.gradient - gradient).norm(), 2.0 * objective.GradientRoundingFloor(y))
        << i;
  }
}

TEST(CeresProblem, CloseItsGateAtTheMonitorsFirstNo) {
  const auto problem = MakeFit(MakeNoisyLoop(80, 2, 36), MakeSpec(3, true, 12));
  TestContextOptions options;
  options.max_energies = 1;
  TestContext context(*problem, options);
  Objective objective(problem.get(), &context);
  CeresProblem ceres_problem(&objective, Evaluation::kJacobian, objective.start());
  ceres_problem.AddTerms();
  double cost = 0.0;
  EXPECT_TRUE(ceres_problem.problem()->Evaluate({}, &cost, nullptr, nullptr, nullptr));
  EXPECT_FALSE(ceres_problem.stopped());
  for (int i = 0; i < 2; ++i) {
    EXPECT_FALSE(ceres_problem.problem()->Evaluate({}, &cost, nullptr, nullptr, nullptr));
    EXPECT_TRUE(ceres_problem.stopped());
  }
  EXPECT_EQ(context.refused(), 1);
  EXPECT_EQ(context.count(Evaluation::kEnergy), 1);
}

TEST(CeresProblem, CountsDerivativesAsItIsTold) {
  const auto problem = MakeFit(MakeNoisyLoop(80, 2, 37), MakeSpec(3, true, 12));
  for (const Evaluation kind : {Evaluation::kGradient, Evaluation::kJacobian}) {
    TestContext context(*problem);
    Objective objective(problem.get(), &context);
    CeresProblem ceres_problem(&objective, kind, objective.start());
    ceres_problem.AddTerms();
    std::vector<double> gradient;
    double cost = 0.0;
    ceres_problem.problem()->Evaluate({}, &cost, nullptr, &gradient, nullptr);
    ASSERT_EQ(context.evaluations().size(), 2U);
    EXPECT_EQ(context.evaluations()[0].kind, Evaluation::kEnergy);
    EXPECT_EQ(context.evaluations()[1].kind, kind);
    EXPECT_EQ(context.evaluations()[1].x, objective.start());
  }
}

TEST(CeresProblem, MovesTheStartIntoTheBounds) {
  auto problem = MakeFit(MakeNoisyLoop(80, 2, 38), MakeSpec(3, true, 12));
  const double infinity = std::numeric_limits<double>::infinity();
  Eigen::VectorXd lower = Eigen::VectorXd::Constant(24, -infinity);
  Eigen::VectorXd upper = Eigen::VectorXd::Constant(24, infinity);
  lower[3] = problem->start()[3] + 0.5;
  upper[4] = problem->start()[4] - 0.25;
  problem->SetBounds(lower, upper);
  Objective objective(problem.get(), nullptr);
  CeresProblem ceres_problem(&objective, Evaluation::kJacobian, objective.start());
  ceres_problem.AddTerms();
  Eigen::VectorXd expected = problem->start();
  expected[3] = lower[3];
  expected[4] = upper[4];
  EXPECT_EQ(ceres_problem.state(), expected);
  const double* points = ceres_problem.state().data();
  EXPECT_EQ(ceres_problem.problem()->GetParameterLowerBound(points + 2, 1), lower[3]);
  EXPECT_EQ(ceres_problem.problem()->GetParameterUpperBound(points + 4, 0), upper[4]);
  EXPECT_EQ(ceres_problem.problem()->GetParameterUpperBound(points + 2, 1),
            std::numeric_limits<double>::max());
}

struct Sum {
  template <typename T>
  bool operator()(const T* x, T* residual) const {
    residual[0] = x[0] + x[1];
    return true;
  }
};

TEST(CeresProblem, SaysWhyNot) {
  auto problem = MakeFit(MakeNoisyLoop(80, 2, 39), MakeSpec(3, true, 12));
  EXPECT_THAT(WhyNoCeresProblem(*problem, "ceres_lm"), IsEmpty());
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(24);
  problem->SetBounds(-one, one);
  EXPECT_THAT(WhyNoCeresProblem(*problem, "ceres_lm"), IsEmpty());
  SetConstraints({Fixed(0, 0.0)}, problem.get());
  EXPECT_THAT(WhyNoCeresProblem(*problem, "ceres_lm"),
              HasSubstr("ceres_lm takes bounds or linear constraints, not both"));
  SetConstraints({}, problem.get());
  problem->SetBounds(one, one);
  EXPECT_THAT(WhyNoCeresProblem(*problem, "ceres_lm"), HasSubstr("needs room between"));

  auto family = std::make_unique<CostFunctionFamily>();
  family->AddBlock(std::make_unique<ceres::AutoDiffCostFunction<Sum, 1, 2>>(new Sum), {1});
  problem->AddTerm("across two points", std::move(family));
  EXPECT_THAT(WhyNoCeresProblem(*problem, "ceres_lm"),
              HasSubstr("ceres_lm needs terms that group the variables alike"));
}

TEST(VariableGroups, AreDisjoint) {
  VariableGroups groups(6);
  EXPECT_TRUE(groups.Add(2, 2));
  EXPECT_TRUE(groups.Add(2, 2));
  EXPECT_FALSE(groups.Add(2, 3));
  EXPECT_FALSE(groups.Add(1, 2));
  EXPECT_FALSE(groups.Add(3, 1));
  EXPECT_TRUE(groups.Add(4, 2));
  EXPECT_EQ(groups.size_at(2), 2);
  EXPECT_EQ(groups.size_at(3), 0);
  EXPECT_EQ(groups.begin_of(5), 4);
  EXPECT_EQ(groups.begin_of(1), -1);
}

}  // namespace
}  // namespace batten
