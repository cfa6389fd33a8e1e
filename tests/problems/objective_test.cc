#include "problems/objective.h"

#include <gtest/gtest.h>

#include "tests/roundoff.h"
#include "tests/solvers/test_fits.h"

namespace batten {
namespace {

struct ObjectiveCase {
  int degree;
  bool closed;
  int dimension;
  const char* terms;
  bool constrained;
};

std::string NameOf(const ::testing::TestParamInfo<ObjectiveCase>& info) {
  const ObjectiveCase& c = info.param;
  return "Degree" + std::to_string(c.degree) + (c.closed ? "Closed" : "Open") + "Dimension" +
         std::to_string(c.dimension) +
         (std::string(c.terms).find(',') != std::string::npos ? "TwoTerms" : "OneTerm") +
         (c.constrained ? "Constrained" : "");
}

/// One problem seen through compiled rows and through the functor, at a point away from the start.
class CompiledAndNot : public ::testing::TestWithParam<ObjectiveCase> {
 protected:
  CompiledAndNot() : problem_(MakeProblem(GetParam())) {
    x_ = compiled_.start();
    std::mt19937 random(20240701);
    std::uniform_real_distribution<double> uniform(-0.3, 0.3);
    v_.resize(x_.size());
    for (double& entry : x_) entry += uniform(random);
    for (double& entry : v_) entry = uniform(random);
  }
  static std::unique_ptr<Problem> MakeProblem(const ObjectiveCase& c) {
    auto problem =
        MakeFit(MakeNoisyLoop(60, c.dimension, 4), MakeSpec(c.degree, c.closed, 17, c.terms));
    if (c.constrained) {
      std::vector<LinearConstraint> constraints;
      for (int k = 0; k < c.dimension; ++k) {
        constraints.push_back(HoldCurve(*problem, 0.43, k, 0.05 * k - 0.1));
      }
      SetConstraints(constraints, problem.get());
    }
    return problem;
  }
  /// Sums over the data of a handful of roundings each.
  double Roundings(double size) const { return 256 * kEpsilon * (1.0 + size); }

  std::unique_ptr<Problem> problem_;
  Objective compiled_{problem_.get(), nullptr, {true}};
  Objective plain_{problem_.get(), nullptr, {false}};
  Eigen::VectorXd x_;
  Eigen::VectorXd v_;
};

TEST_P(CompiledAndNot, HaveTheSameEnergyAndGradient) {
  ASSERT_TRUE(compiled_.is_quadratic());
  ASSERT_FALSE(plain_.is_quadratic());
  double compiled = 0.0, plain = 0.0, alone = 0.0;
  Eigen::VectorXd compiled_gradient, plain_gradient, band_gradient;
  ASSERT_EQ(compiled_.EnergyAndGradient(x_, &compiled, &compiled_gradient), Status::kOk);
  ASSERT_EQ(plain_.EnergyAndGradient(x_, &plain, &plain_gradient), Status::kOk);
  EXPECT_NEAR(compiled, plain, Roundings(plain));
  EXPECT_LT((compiled_gradient - plain_gradient).norm(), Roundings(plain_gradient.norm()));
  for (Objective* objective : {&compiled_, &plain_}) {
    ASSERT_EQ(objective->Energy(x_, &alone), Status::kOk);
    EXPECT_NEAR(alone, plain, Roundings(plain));
    ASSERT_EQ(objective->Gradient(x_, &band_gradient), Status::kOk);
    EXPECT_LT((band_gradient - plain_gradient).norm(), Roundings(plain_gradient.norm()));
  }
}

TEST_P(CompiledAndNot, HaveTheSameSecondDerivative) {
  Eigen::VectorXd compiled, plain;
  ASSERT_EQ(compiled_.HessianTimes(x_, v_, &compiled), Status::kOk);
  ASSERT_EQ(plain_.HessianTimes(x_, v_, &plain), Status::kOk);
  EXPECT_LT((compiled - plain).norm(), Roundings(plain.norm()));
  // And it is that of E: along x + v, exact for a quadratic.
  double here = 0.0, there = 0.0;
  Eigen::VectorXd gradient;
  ASSERT_EQ(plain_.EnergyAndGradient(x_, &here, &gradient), Status::kOk);
  ASSERT_EQ(plain_.Energy(x_ + v_, &there), Status::kOk);
  EXPECT_NEAR(there - here, gradient.dot(v_) + 0.5 * v_.dot(plain), Roundings(here + there));
}

TEST_P(CompiledAndNot, ResidualsAndJacobianMakeTheEnergyAndGradient) {
  double energy = 0.0;
  Eigen::VectorXd gradient, residuals;
  SparseRows jacobian;
  ASSERT_EQ(plain_.EnergyAndGradient(x_, &energy, &gradient), Status::kOk);
  for (Objective* objective : {&compiled_, &plain_}) {
    ASSERT_EQ(objective->Jacobian(x_, &residuals, &jacobian), Status::kOk);
    ASSERT_EQ(jacobian.cols(), x_.size());
    EXPECT_NEAR(residuals.squaredNorm(), energy, Roundings(energy));
    EXPECT_LT((2.0 * (jacobian.transpose() * residuals) - gradient).norm(),
              Roundings(gradient.norm()));
  }
}

TEST_P(CompiledAndNot, PartialEnergiesAddUp) {
  double energy = 0.0;
  ASSERT_EQ(plain_.Energy(x_, &energy), Status::kOk);
  double sum = 0.0;
  for (std::size_t t = 0; t < problem_->terms().size(); ++t) {
    const int size = problem_->terms()[t].family->size();
    for (int begin = 0; begin < size; begin += 7) {
      double part = 0.0;
      ASSERT_EQ(
          compiled_.PartialEnergy(x_, static_cast<int>(t), begin, std::min(begin + 7, size), &part),
          Status::kOk);
      EXPECT_GE(part, 0.0);
      sum += part;
    }
  }
  EXPECT_NEAR(sum, energy, Roundings(energy));
}

TEST_P(CompiledAndNot, CurveViewMultipliesByTheRows) {
  CurveView& view = *compiled_.curve_view();
  double energy = 0.0;
  Eigen::VectorXd gradient, product, normal;
  Points residuals;
  ASSERT_EQ(plain_.EnergyAndGradient(x_, &energy, &gradient), Status::kOk);
  ASSERT_EQ(view.Residuals(x_, &residuals), Status::kOk);
  EXPECT_NEAR(residuals.squaredNorm(), energy, Roundings(energy));
  ASSERT_EQ(view.TransposedProduct(residuals, &product), Status::kOk);
  EXPECT_LT((-2.0 * product - gradient).norm(), Roundings(gradient.norm()));
  ASSERT_EQ(view.NormalResidual(x_, &normal), Status::kOk);
  EXPECT_LT((-2.0 * normal - gradient).norm(), Roundings(gradient.norm()));
}

TEST_P(CompiledAndNot, CurveViewSumsATakenBandAgain) {
  CurveView& view = *compiled_.curve_view();
  const LargeArray band = view.normal_band().band();
  NormalBand taken = view.TakeNormalBand(1);
  EXPECT_EQ(taken.band(), band);
  std::fill(taken.band().begin(), taken.band().end(), 7.0);
  EXPECT_EQ(view.normal_band().band(), band);
}

INSTANTIATE_TEST_SUITE_P(
    Fits, CompiledAndNot,
    ::testing::Values(ObjectiveCase{3, true, 2, "interpolation", false},
                      ObjectiveCase{3, false, 3, "interpolation/weight=0.3", false},
                      ObjectiveCase{7, true, 1, "interpolation", false},
                      ObjectiveCase{4, false, 4, "interpolation,interpolation/weight=2", false},
                      ObjectiveCase{2, true, 2, "interpolation", true},
                      ObjectiveCase{5, false, 3, "interpolation", true}),
    NameOf);

TEST(ObjectiveRounding, FloorOfTheEnergyIsAboveWhatTwoWaysOfSummingDifferBy) {
  const auto problem = MakeFit(MakeNoisyLoop(200, 2, 9), MakeSpec(3, true, 20));
  Objective compiled(problem.get(), nullptr, {true});
  Objective plain(problem.get(), nullptr, {false});
  const Eigen::VectorXd x = compiled.start();
  double a = 0.0, b = 0.0;
  ASSERT_EQ(compiled.Energy(x, &a), Status::kOk);
  ASSERT_EQ(plain.Energy(x, &b), Status::kOk);
  const double floor = Objective::EnergyRoundingFloor(a, plain.ResidualSize(x));
  EXPECT_LE(std::abs(a - b), floor);
  // 4 roundings of each of 200 residuals and of the curve and data, up to 1 each, behind it.
  EXPECT_LE(floor, 4 * kEpsilon * (2.0 * std::sqrt(a) * std::sqrt(200.0 * 2.0) * 2.0 * 1.5 + a));
}

TEST(ObjectiveRounding, ResidualSizeIsThatOfDataAndCurve) {
  // At zero control points the residuals are the data themselves: |Q| + |A P - 0| = |Q|.
  const auto problem = MakeFit(MakeNoisyLoop(50, 2, 9), MakeSpec(3, true, 12));
  Objective objective(problem.get(), nullptr);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(objective.num_variables());
  double energy = 0.0;
  ASSERT_EQ(objective.Energy(zero, &energy), Status::kOk);
  EXPECT_NEAR(objective.ResidualSize(zero), std::sqrt(energy), 16 * kEpsilon * std::sqrt(energy));
}

}  // namespace
}  // namespace batten
