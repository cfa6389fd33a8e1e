#include "solvers/exact_newton.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "tests/solvers/contract_cases.h"

namespace batten {
namespace {

struct HessianCase {
  const char* name;
  int degree;
  bool closed;
  int control_points;
  int dimension;
  const char* terms;
};

const HessianCase kHessianCases[] = {
    {"Bending", 3, false, 12, 2, "interpolation,curve_fairing/weight=1e-3"},
    {"VariationInSpace", 4, false, 13, 3,
     "interpolation,curve_fairing/measure=variation/weight=1e-8"},
    {"Closed", 3, true, 17, 2, "interpolation,curve_fairing/weight=1e-3"},
    {"ClosedWithFewControlPoints", 3, true, 5, 2, "interpolation,curve_fairing/weight=1e-3"},
    {"WithALoss", 2, true, 11, 2, "interpolation/loss=cauchy/loss_scale=0.1,fairing/weight=1e-4"},
};

std::unique_ptr<Problem> MakeCase(const HessianCase& c) {
  return MakeFit(MakeNoisyBean(60, c.dimension, 801),
                 MakeSpec(c.degree, c.closed, c.control_points, c.terms));
}

class ExactNewtonCases : public ::testing::TestWithParam<HessianCase> {};
INSTANTIATE_TEST_SUITE_P(Fits, ExactNewtonCases, ::testing::ValuesIn(kHessianCases),
                         [](const auto& c) { return c.param.name; });

TEST_P(ExactNewtonCases, HessianIsTheDerivativeOfTheGradient) {
  const auto problem = MakeCase(GetParam());
  Objective objective(problem.get(), nullptr);
  // Off the start, where nothing is symmetric.
  Eigen::VectorXd x = objective.start();
  std::mt19937 random(20240911);
  for (double& coordinate : x) coordinate += RandomBetween(-0.02, 0.02, &random);
  std::vector<const BlockFamily*> terms;
  for (const Problem::TermInstance& term : problem->terms()) terms.push_back(term.family.get());
  HessianBand hessian(problem->curve_fit()->basis(), GetParam().dimension, 0, terms, x);
  ASSERT_EQ(hessian.Sum(x, [] { return true; }), Status::kOk);
  const Eigen::MatrixXd found = hessian.band().ToDense();
  Eigen::MatrixXd expected(x.size(), x.size());
  // Central, the step near the cube root of eps.
  const double step = 6e-6;
  double energy = 0.0;
  Eigen::VectorXd above, below;
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    Eigen::VectorXd moved = x;
    moved[k] = x[k] + step;
    ASSERT_EQ(objective.EnergyAndGradient(moved, &energy, &above), Status::kOk);
    moved[k] = x[k] - step;
    ASSERT_EQ(objective.EnergyAndGradient(moved, &energy, &below), Status::kOk);
    expected.col(k) = (above - below) / (2.0 * step);
  }
  // Third derivatives of the gradient are up to some 1e4 of its first; step^2 is 4e-11.
  EXPECT_LT((found - expected).norm(), 1e-6 * expected.norm());
}

TEST_P(ExactNewtonCases, EndsQuadratically) {
  const auto problem = MakeCase(GetParam());
  SolverTrial trial(*problem, "newton", {200, -1.0, true});
  EXPECT_TRUE(IsSuccess(trial.outcome.reason))
      << ToString(trial.outcome.reason) << ": " << trial.outcome.message;
  const std::vector<double>& norms = trial.context.gradient_norms();
  ASSERT_GE(norms.size(), 4U);
  const double floor = Objective(problem.get(), nullptr).GradientRoundingFloor(trial.x);
  // log |g_(k+1)| / |g_k| doubles from one step to the next: of the last three norms above
  // rounding, the last ratio is the one before it to the power 2. 1.5 lies halfway to linear.
  std::vector<double> above;
  for (const double norm : norms) {
    if (norm > 10.0 * floor) above.push_back(norm);
  }
  ASSERT_GE(above.size(), 3U);
  const std::size_t last = above.size() - 1;
  const double order =
      std::log(above[last] / above[last - 1]) / std::log(above[last - 1] / above[last - 2]);
  EXPECT_GT(order, 1.5) << above[last - 2] << " " << above[last - 1] << " " << above[last];
}

TEST_P(ExactNewtonCases, FindsTheMinimumOfLbfgs) {
  const auto problem = MakeCase(GetParam());
  SolverTrial newton(*problem, "newton", {200});
  ASSERT_TRUE(IsSuccess(newton.outcome.reason));
  Objective objective(problem.get(), nullptr);
  problem->SetStart(objective.Expand(newton.x) + Eigen::VectorXd::Constant(newton.x.size(), 1e-3));
  SolverTrial lbfgs(*problem, "lbfgs", {20000});
  const double energy = lbfgs.context.Energy(lbfgs.x);
  EXPECT_NEAR(newton.context.Energy(newton.x), energy, 1e-9 * energy);
}

TEST(ExactNewton, HoldsLinearConstraints) {
  const auto problem = MakeCase(kHessianCases[0]);
  const LinearConstraint held = HoldCurve(*problem, 0.4, 0, 0.1);
  SetConstraints({held, {"tied", {{6, 1.0}, {9, -1.0}}, 0.03}}, problem.get());
  SolverTrial trial(*problem, "newton", {200});
  EXPECT_TRUE(IsSuccess(trial.outcome.reason))
      << ToString(trial.outcome.reason) << ": " << trial.outcome.message;
  double miss = -held.value;
  for (const auto& [index, coefficient] : held.coefficients) miss += coefficient * trial.all[index];
  EXPECT_NEAR(miss, 0.0, 1e-12);
  EXPECT_NEAR(trial.all[6] - trial.all[9], 0.03, 1e-12);
  // Along the constraints the gradient is small.
  EXPECT_LE(trial.context.gradient_norms().back(), 1e-9 * trial.context.gradient_norms().front());
}

}  // namespace
}  // namespace batten
