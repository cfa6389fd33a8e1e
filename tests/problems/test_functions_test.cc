#include "problems/test_functions.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <map>
#include <ostream>
#include <random>
#include <set>

#include "tests/roundoff.h"

namespace batten {

void PrintTo(const TestFunction& function, std::ostream* stream) { *stream << function.name; }

namespace {

const double kStep = std::cbrt(kEpsilon);

double EnergyAt(const Problem& problem, const Eigen::VectorXd& x) {
  const BlockFamily& family = *problem.terms().front().family;
  double energy = 0.0;
  EXPECT_EQ(family.Evaluate(x, 0, family.size(), &energy, nullptr), Status::kOk);
  return energy;
}

Eigen::VectorXd GradientAt(const Problem& problem, const Eigen::VectorXd& x) {
  const BlockFamily& family = *problem.terms().front().family;
  double energy = 0.0;
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(x.size());
  EXPECT_EQ(family.Evaluate(x, 0, family.size(), &energy, &gradient), Status::kOk);
  return gradient;
}

/// Size of the roundings in the gradient: eps times what its terms would add up to without signs,
/// for residuals that carry a few roundings of their largest term, 1 or |x|.
Eigen::VectorXd GradientNoise(const Problem& problem, const Eigen::VectorXd& x) {
  const BlockFamily& family = *problem.terms().front().family;
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd residuals;
  EXPECT_EQ(family.Jacobian(x, 0, &entries), Status::kOk);
  EXPECT_EQ(family.Residuals(x, &residuals), Status::kOk);
  SparseRows jacobian(residuals.size(), x.size());
  jacobian.setFromTriplets(entries.begin(), entries.end());
  const Eigen::MatrixXd sizes = Eigen::MatrixXd(jacobian).cwiseAbs();
  const Eigen::VectorXd terms =
      sizes * x.cwiseAbs() + residuals.cwiseAbs() + Eigen::VectorXd::Ones(residuals.size());
  return 32 * kEpsilon * (sizes.transpose() * terms);
}

class EveryTestFunction : public ::testing::TestWithParam<TestFunction> {};

TEST_P(EveryTestFunction, StartsWhereTheLiteratureDoes) {
  // f(x0) of the standard starts: by hand where short, the others from an independent
  // implementation.
  const std::map<std::string, double> at_start = {
      {"rosenbrock", 24.2},
      {"freudenstein_roth", 400.5},
      {"powell_badly_scaled", 1.13526171734838},
      {"brown_badly_scaled", 999998000003.0},
      {"beale", 14.203125},
      {"helical_valley", 2500.0},
      {"powell_singular", 215.0},
      {"wood", 19192.0},
      {"brown_dennis", 7926693.33699743},
      {"trigonometric", 0.00707575946622},
  };
  const auto problem = MakeTestProblem(GetParam().name);
  ASSERT_NE(problem, nullptr);
  EXPECT_EQ(problem->start(), GetParam().start);
  const double expected = at_start.at(GetParam().name);
  const double tolerance = 1e-12 * expected;  // the literature's digits
  EXPECT_NEAR(EnergyAt(*problem, GetParam().start), expected, tolerance);
}

TEST_P(EveryTestFunction, HasItsStatedMinima) {
  const auto problem = MakeTestProblem(GetParam().name);
  double last = 0.0;
  for (const TestFunction::Minimum& minimum : GetParam().minima) {
    EXPECT_GE(minimum.energy, last) << "the least stands first";
    last = minimum.energy;
    const Eigen::VectorXd noise = GradientNoise(*problem, minimum.point);
    // (root + distance)^2 - root^2, where roundings move the residuals by that distance.
    const double root = std::sqrt(minimum.energy);
    const double distance = 64 * kEpsilon * (1.0 + root);
    const double tolerance = distance * distance + 2.0 * distance * root;
    EXPECT_NEAR(EnergyAt(*problem, minimum.point), minimum.energy, tolerance);
    const Eigen::VectorXd gradient = GradientAt(*problem, minimum.point);
    for (Eigen::Index i = 0; i < gradient.size(); ++i) {
      EXPECT_LE(std::abs(gradient[i]), noise[i]) << i;
    }
  }
  EXPECT_EQ(GetParam().min_energy(), GetParam().minima.front().energy);
}

TEST_P(EveryTestFunction, CurvesUpwardsAtItsMinima) {
  const auto problem = MakeTestProblem(GetParam().name);
  const BlockFamily& family = *problem->terms().front().family;
  for (const TestFunction::Minimum& minimum : GetParam().minima) {
    const Eigen::Index n = minimum.point.size();
    Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(n, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      Eigen::VectorXd column = Eigen::VectorXd::Zero(n);
      ASSERT_EQ(family.AddHessianTimes(minimum.point, Eigen::VectorXd::Unit(n, i), &column),
                Status::kOk);
      hessian.col(i) = column;
    }
    const Eigen::VectorXd eigenvalues =
        (0.5 * (hessian + hessian.transpose())).selfadjointView<Eigen::Lower>().eigenvalues();
    // Differences hold two thirds of the digits of the largest; the singular function has zeros.
    EXPECT_GT(eigenvalues.minCoeff(), -100 * kStep * kStep * eigenvalues.maxCoeff());
  }
}

TEST_P(EveryTestFunction, HasTheGradientOfItsEnergy) {
  const auto problem = MakeTestProblem(GetParam().name);
  std::mt19937 random(19810301);
  std::uniform_real_distribution<double> number(-0.3, 0.3);
  for (int trial = 0; trial < 4; ++trial) {
    Eigen::VectorXd x = GetParam().start;
    for (double& entry : x) entry += trial == 0 ? 0.0 : number(random);
    const Eigen::VectorXd gradient = GradientAt(*problem, x);
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(x.size(), i);
      const double after = EnergyAt(*problem, x + step);
      const double before = EnergyAt(*problem, x - step);
      // eps E / h by rounding, h^2 E''' / 6 by truncation; E''' is at most some 1e3 |E| here.
      const double tolerance = 4 * kEpsilon * after / kStep +
                               kStep * kStep * 1e3 * (std::abs(gradient[i]) + after + 1.0);
      EXPECT_NEAR(gradient[i], (after - before) / (2.0 * kStep), tolerance) << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Table, EveryTestFunction, ::testing::ValuesIn(TestFunctions()),
                         [](const auto& each) { return each.param.name; });

TEST(TestFunctions, HaveDistinctNamesAndSources) {
  std::set<std::string> names;
  std::set<std::string> citations;
  for (const TestFunction& function : TestFunctions()) {
    names.insert(function.name);
    citations.insert(function.citation);
  }
  EXPECT_EQ(names.size(), 10u);
  EXPECT_EQ(citations.size(), 10u);
  EXPECT_EQ(MakeTestProblem("rosenbrok"), nullptr);
}

TEST(TestFunctions, SecondMinimumOfFreudensteinAndRothIsAsPublished) {
  const TestFunction function = TestFunctions()[1];
  // More, Garbow, Hillstrom: f = 48.9842... at (11.41..., -0.8968...).
  EXPECT_NEAR(function.minima[1].energy, 48.9842, 1e-4);
  EXPECT_NEAR(function.minima[1].point[0], 11.41, 1e-2);
  EXPECT_NEAR(function.minima[1].point[1], -0.8968, 1e-4);
}

TEST(HelicalValley, TurnsWithoutAJumpAcrossTheNegativeAxisAndHasNoAngleOnItsAxis) {
  const auto problem = MakeTestProblem("helical_valley");
  const double above = EnergyAt(*problem, Eigen::Vector3d(-1.0, kEpsilon, 0.4));
  const double below = EnergyAt(*problem, Eigen::Vector3d(-1.0, -kEpsilon, 0.4));
  EXPECT_NEAR(above, below, 1e-10);
  const BlockFamily& family = *problem->terms().front().family;
  double energy = 0.0;
  EXPECT_EQ(family.Evaluate(Eigen::Vector3d(0.0, 0.0, 1.0), 0, 1, &energy, nullptr),
            Status::kNonFinite);
}

}  // namespace
}  // namespace batten
