#include "cost_functions/curve_condition.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/cost_functions/example_fit.h"

namespace batten {
namespace {

using Kind = CurveCondition::Kind;

/// Conditions of all kinds at given and at free parameters, which stand where the fit has those of
/// its data.
std::vector<CurveCondition> AllKinds(const ExampleFit& fit, std::mt19937* random) {
  std::vector<CurveCondition> all;
  for (const Kind kind : {Kind::kDirection, Kind::kCurvature}) {
    for (const int order : {0, 1}) {
      for (const int variable : {-1, fit.setting.parameter_offset + 2}) {
        CurveCondition condition;
        condition.name = "made";
        condition.kind = kind;
        condition.order = order;
        condition.t = RandomParameter(fit.basis, random);
        condition.parameter_variable = variable;
        condition.is_inequality = order == 1;
        for (double& entry : condition.direction) entry = RandomBetween(-1.0, 1.0, random);
        condition.value = RandomBetween(0.02, 0.08, random);
        condition.unit = 0.7;
        all.push_back(condition);
      }
    }
  }
  return all;
}

TEST(CurveCondition, DerivativesAreThoseOfItsNumbers) {
  std::mt19937 random(20250701);
  for (const auto& [degree, dimension] : {std::pair(3, 2), {4, 3}, {2, 2}, {5, 4}}) {
    for (const EndKnots ends : {EndKnots::kEndInterpolating, EndKnots::kPeriodic}) {
      SCOPED_TRACE(degree);
      const ExampleFit fit(MakeBasis({degree, ends, true}, 11, &random), dimension, 9, false,
                           &random);
      const CurveConditionFamily family(fit.setting, AllKinds(fit, &random));
      const Eigen::VectorXd x = fit.RoundVariables(&random);
      // Of a curve of radius 20 derivatives by t are that many times as large, at each order.
      const double third_derivative = ExampleFit::kRadius * std::pow(2.0 * M_PI, 3);
      ExpectDerivativesOf(family, x, &random, third_derivative);
      const Eigen::VectorXd scales = Eigen::VectorXd::LinSpaced(family.size(), 0.5, 1.5);
      const Eigen::VectorXd shifts = Eigen::VectorXd::LinSpaced(family.size(), -0.9, 0.4);
      const auto penalty = family.MakePenalty(2.5, scales, shifts);
      ExpectDerivativesOf(*penalty, x, &random, third_derivative);
      // By hand: inequalities have a say where they are missed only.
      const Eigen::VectorXd h = ResidualsAt(family, x);
      double energy = 0.0;
      for (int k = 0; k < family.size(); ++k) {
        double bracket = scales[k] * h[k] + shifts[k];
        if (family.is_inequality(k)) bracket = std::min(bracket, 0.0);
        energy += 2.5 * bracket * bracket;
      }
      EXPECT_NEAR(EnergyAt(*penalty, x), energy, 1e-12 * (1.0 + energy));
    }
  }
}

TEST(CurveCondition, GivesCeresTheSameNumbers) {
  std::mt19937 random(20250702);
  const ExampleFit fit(MakeBasis({3, EndKnots::kPeriodic, false}, 9, &random), 2, 9, false,
                       &random);
  const CurveConditionFamily family(fit.setting, AllKinds(fit, &random));
  const Eigen::VectorXd x = fit.RoundVariables(&random);
  const Eigen::VectorXd h = ResidualsAt(family, x);
  const Eigen::MatrixXd jacobian = JacobianAt(family, x);
  for (int k = 0; k < family.size(); ++k) {
    std::vector<int> offsets, sizes;
    family.Bind(x, k, &offsets, &sizes);
    const auto cost = family.MakeCeresCostFunction(x, k);
    std::vector<const double*> parameters;
    std::vector<std::vector<double>> columns;
    std::vector<double*> pointers;
    for (const int size : sizes) columns.emplace_back(size);
    for (std::size_t b = 0; b < sizes.size(); ++b) {
      parameters.push_back(x.data() + offsets[b]);
      pointers.push_back(columns[b].data());
    }
    double residual = 0.0;
    ASSERT_TRUE(cost->Evaluate(parameters.data(), &residual, pointers.data()));
    EXPECT_EQ(residual, h[k]);
    Eigen::RowVectorXd rest = jacobian.row(k);
    for (std::size_t b = 0; b < sizes.size(); ++b) {
      for (int i = 0; i < sizes[b]; ++i) {
        EXPECT_EQ(columns[b][i], jacobian(k, offsets[b] + i));
        rest[offsets[b] + i] = 0.0;
      }
    }
    EXPECT_TRUE(rest.isZero(0.0));
  }
}

TEST(CurveCondition, OfCurvatureIsThatOfAParabolaAndHasNoNumberWhereTheCurveStands) {
  // (t, t^2 / 2, 0): kappa = (1 + t^2)^(-3/2).
  const BsplineBasis basis = BasisOf(2, false, {0, 0, 0, 1, 1, 1});
  for (const int dimension : {2, 3}) {
    FitSetting setting;
    setting.basis = &basis;
    setting.dimension = dimension;
    CurveCondition condition;
    condition.kind = Kind::kCurvature;
    condition.t = 0.6;
    condition.value = std::pow(1.36, -1.5);
    const CurveConditionFamily family(setting, {condition});
    Eigen::VectorXd x = Eigen::VectorXd::Zero(3 * dimension);
    x[dimension] = 0.5;
    x[2 * dimension] = 1.0;
    x[2 * dimension + 1] = 0.5;
    EXPECT_NEAR(ResidualsAt(family, x)[0], 0.0, 1e-14);
    // Turned over it bends the other way; in space there is no other way.
    x[2 * dimension + 1] = -0.5;
    EXPECT_NEAR(ResidualsAt(family, x)[0], dimension == 2 ? -2.0 * condition.value : 0.0, 1e-14);
    Eigen::VectorXd h;
    EXPECT_EQ(family.Residuals(Eigen::VectorXd::Zero(x.size()), &h), Status::kNonFinite);
  }
}

}  // namespace
}  // namespace batten
