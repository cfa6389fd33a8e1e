#include "solvers/moving_variables.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "solvers/ceres_problem.h"
#include "tests/roundoff.h"
#include "tests/solvers/test_fits.h"

namespace batten {
namespace {

std::unique_ptr<Problem> FreeFit(bool closed, int control_points,
                                 const std::vector<double>& knots) {
  FitSpec spec = MakeSpec(3, closed, control_points, "free_parameter");
  spec.parameter_kind = ParameterKind::kFree;
  spec.given_knots = knots;
  return MakeFit(MakeNoisyLoop(50, 2, 41), spec);
}

// Twice at the seam, three times at 0.25.
const std::vector<double> kRepeatedKnots = {-0.5, -0.4, -0.2, 0.0, 0.0, 0.25, 0.25, 0.25,
                                            0.5,  0.6,  0.8,  1.0, 1.0, 1.25, 1.25};

std::vector<std::unique_ptr<Problem>> Fits() {
  std::vector<std::unique_ptr<Problem>> fits;
  for (const int n : {1, 2, 3, 4, 5, 12}) fits.push_back(FreeFit(true, n, {}));
  fits.push_back(FreeFit(true, 8, kRepeatedKnots));
  for (const int n : {4, 5, 12}) fits.push_back(FreeFit(false, n, {}));
  fits.push_back(
      FreeFit(false, 9, {0.0, 0.0, 0.0, 0.0, 0.25, 0.25, 0.25, 0.5, 0.8, 1.0, 1.0, 1.0, 1.0}));
  return fits;
}

TEST(MovingVariables, AreInsideTheirWindowsOrAtAnEndWhenBound) {
  for (const auto& problem : Fits()) {
    const BsplineBasis& basis = problem->curve_fit()->basis();
    Eigen::VectorXd x = problem->start();
    const int first = problem->curve_fit()->setting().parameter_offset;
    for (int i = 0; i < 20; ++i) x[first + i] = basis.knots()[i % basis.knots().size()];
    const MovingVariables moving(*problem, &x);
    ASSERT_EQ(moving.windows().size(), 50U);
    for (const BindingWindow& window : moving.windows()) {
      EXPECT_EQ(x[window.variable], window.place);
      EXPECT_TRUE(window.place > window.low || window.low_is_end);
      EXPECT_TRUE(window.place < window.high || window.high_is_end);
      EXPECT_FALSE(basis.periodic() && (window.low_is_end || window.high_is_end));
    }
    EXPECT_FALSE(moving.AnyHasArrived(x));
    EXPECT_EQ(moving.AnyIsAtAnEnd(), !basis.periodic());
    x[first + 30] = moving.windows()[30].high;
    EXPECT_EQ(moving.AnyHasArrived(x), moving.windows()[30].place < x[first + 30]);
  }
}

TEST(MovingVariables, AnEndHoldsThoseWhoseEnergyFallsBeyondIt) {
  const auto problem = FreeFit(false, 12, {});
  const int first = problem->curve_fit()->setting().parameter_offset;
  Eigen::VectorXd x = problem->start();
  x[first + 7] = -3.0;
  const MovingVariables moving(*problem, &x);
  EXPECT_EQ(x[first + 7], 0.0);
  Eigen::VectorXd gradient = Eigen::VectorXd::Ones(x.size());
  EXPECT_EQ(moving.Pressed(x, gradient), (std::vector<int>{first, first + 7}));
  gradient *= -1.0;
  EXPECT_EQ(moving.Pressed(x, gradient), (std::vector<int>{first + 49}));
}

TEST(MovingVariables, CeresHasEAndItsGradientAnywhereInTheWindows) {
  std::mt19937 random(42);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (const auto& problem : Fits()) {
    Objective objective(problem.get(), nullptr);
    CeresProblem bound(&objective, Evaluation::kGradient, objective.start());
    bound.AddTerms();
    std::vector<double*> blocks;
    bound.problem()->GetParameterBlocks(&blocks);
    for (int trial = 0; trial < 10; ++trial) {
      for (double* block : blocks) {
        const int size = bound.problem()->ParameterBlockSize(block);
        for (int i = 0; i < size; ++i) {
          const double low = bound.problem()->GetParameterLowerBound(block, i);
          const double high = bound.problem()->GetParameterUpperBound(block, i);
          const double part = uniform(random);
          block[i] = size == 1 ? low + part * (high - low) : part - 0.5;
        }
      }
      double cost = 0.0;
      std::vector<double> half;
      ASSERT_TRUE(bound.problem()->Evaluate({}, &cost, nullptr, &half, nullptr));
      double energy = 0.0;
      Eigen::VectorXd gradient;
      ASSERT_EQ(objective.EnergyAndGradient(bound.state(), &energy, &gradient), Status::kOk);
      // Moving t by a period rounds it, by eps; derivatives of C by t are below 1e3, those of C'
      // below 1e5, and 100 residuals of size 1 are summed.
      EXPECT_NEAR(2.0 * cost, energy, 1e5 * kEpsilon);
      ASSERT_EQ(static_cast<Eigen::Index>(half.size()), gradient.size());
      const Eigen::Map<const Eigen::VectorXd> mapped(half.data(), gradient.size());
      EXPECT_LE((2.0 * mapped - gradient).norm(), 1e7 * kEpsilon);
    }
  }
}

TEST(MovingVariables, OneThatAConstraintHoldsMayBeInAnotherPeriod) {
  const auto problem = FreeFit(true, 12, {});
  const int held = problem->curve_fit()->setting().parameter_offset + 7;
  SetConstraints({{"held", {{held, 1.0}}, 4.3}}, problem.get());
  Objective objective(problem.get(), nullptr);
  CeresProblem bound(&objective, Evaluation::kGradient, objective.start());
  bound.AddTerms();
  EXPECT_EQ(bound.moving().windows().size(), 49U);
  double cost = 0.0;
  double energy = 0.0;
  ASSERT_TRUE(bound.problem()->Evaluate({}, &cost, nullptr, nullptr, nullptr));
  ASSERT_EQ(objective.Energy(objective.start(), &energy), Status::kOk);
  // 100 squares below 1, and one t rounded by 4 eps.
  EXPECT_NEAR(2.0 * cost, energy, 1000.0 * kEpsilon);
}

}  // namespace
}  // namespace batten
