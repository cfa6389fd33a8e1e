#include "cost_functions/bezier_cut.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "tests/splines/example_splines.h"

namespace batten {
namespace {

BezierCurve CurveOf(const Points& points) { return BezierCurve::Make(points, nullptr).value(); }

double SumOfSquares(const ceres::CostFunction& cost, double u) {
  std::vector<double> residuals(static_cast<std::size_t>(cost.num_residuals()));
  const double* block = &u;
  EXPECT_TRUE(cost.Evaluate(&block, residuals.data(), nullptr));
  double sum = 0.0;
  for (const double residual : residuals) sum += residual * residual;
  return sum;
}

// Not by Ceres' GradientChecker: its first steps leave (0, 1) and cross kinks of the hull.
void ExpectDerivativeIsRight(const ceres::CostFunction& cost, double u) {
  const auto size = static_cast<std::size_t>(cost.num_residuals());
  std::vector<double> residuals(size), derivatives(size), after(size), before(size);
  const double step = std::cbrt(kEpsilon);
  const double ahead = u + step, behind = u - step;
  const double* block = &u;
  double* jacobian = derivatives.data();
  ASSERT_TRUE(cost.Evaluate(&block, residuals.data(), &jacobian));
  block = &ahead;
  ASSERT_TRUE(cost.Evaluate(&block, after.data(), nullptr));
  block = &behind;
  ASSERT_TRUE(cost.Evaluate(&block, before.data(), nullptr));
  // step^2 f''' / 6 with derivatives up to some n^3 times the value, and eps / step.
  constexpr double kTolerance = 1e-6;
  for (std::size_t i = 0; i < size; ++i) {
    EXPECT_NEAR(derivatives[i], (after[i] - before[i]) / (2 * step), kTolerance)
        << "residual " << i << " at " << u;
  }
}

TEST(BezierCutCost, SquaresOfTheFlatnessResidualsAddUpToTheValue) {
  std::mt19937 random(61);
  for (const int degree : {2, 3, 7, 25}) {
    for (const int dimension : {2, 3}) {
      const BezierCurve curve = CurveOf(RandomPoints(degree + 1, dimension, &random));
      const auto cost = MakeCutCostFunction<CutFlatness>(curve);
      EXPECT_EQ(cost->num_residuals(), 2 * (degree - 1) * (dimension == 2 ? 1 : 3));
      CutValue value(CutMeasure::kFlatness, degree, dimension, curve.control_points().data());
      for (const double u : {0.07, 0.4, 0.5, 0.93}) {
        // A hundred roundings of sums of 2 (n - 1) squares up to 8.
        EXPECT_NEAR(SumOfSquares(*cost, u), value(u), 100 * 16 * degree * kEpsilon);
      }
    }
  }
}

TEST(BezierCutCost, SquaresOfTheHullResidualsAddUpToTheValue) {
  std::mt19937 random(62);
  for (const int degree : {2, 3, 7, 25}) {
    const BezierCurve curve = CurveOf(RandomPoints(degree + 1, 2, &random));
    const auto cost = MakeCutCostFunction<CutHullArea>(curve);
    CutValue value(CutMeasure::kHullArea, degree, 2, curve.control_points().data());
    for (const double u : {0.07, 0.4, 0.5, 0.93}) {
      EXPECT_NEAR(SumOfSquares(*cost, u), value(u), 100 * 8 * kEpsilon);
    }
  }
}

TEST(BezierCutCost, DerivativesAreThoseOfDifferences) {
  std::mt19937 random(63);
  for (const int degree : {2, 3, 7, 16}) {
    const BezierCurve planar = CurveOf(RandomPoints(degree + 1, 2, &random));
    const BezierCurve spatial = CurveOf(RandomPoints(degree + 1, 3, &random));
    for (const double u : {0.1217, 0.4442, 0.7831}) {  // no corner of a hull changes near them
      ExpectDerivativeIsRight(*MakeCutCostFunction<CutFlatness>(planar), u);
      ExpectDerivativeIsRight(*MakeCutCostFunction<CutFlatness>(spatial), u);
      ExpectDerivativeIsRight(*MakeCutCostFunction<CutHullArea>(planar), u);
    }
  }
}

TEST(BezierCutCost, StraightCurvesHaveZeroResidualsAndDerivatives) {
  const BezierCurve line = CurveOf(PointsOf({{0, 0}, {1, 1}, {2, 2}, {4, 4}}));
  for (const auto& cost :
       {MakeCutCostFunction<CutFlatness>(line), MakeCutCostFunction<CutHullArea>(line)}) {
    const double u = 0.3;
    const double* block = &u;
    double residuals[4], derivatives[4];
    double* jacobian = derivatives;
    ASSERT_TRUE(cost->Evaluate(&block, residuals, &jacobian));
    for (int i = 0; i < cost->num_residuals(); ++i) {
      EXPECT_NEAR(residuals[i], 0.0, 8 * kEpsilon);
      EXPECT_NEAR(derivatives[i], 0.0, 64 * kEpsilon);
    }
  }
}

TEST(BezierCutCost, OutsideTheCurveThereIsNoValue) {
  const BezierCurve curve = CurveOf(PointsOf({{0, 0}, {1, 2}, {2, 0}}));
  for (const auto& cost :
       {MakeCutCostFunction<CutFlatness>(curve), MakeCutCostFunction<CutHullArea>(curve)}) {
    for (const double u : {-0.5, 0.0, 1.0, 1.5}) {
      const double* block = &u;
      double residuals[2];
      EXPECT_FALSE(cost->Evaluate(&block, residuals, nullptr)) << u;
    }
  }
}

}  // namespace
}  // namespace batten
