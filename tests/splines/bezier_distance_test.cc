#include "splines/bezier_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

#include "splines/bezier_measures.h"
#include "tests/splines/bezier_pieces.h"
#include "tests/splines/example_splines.h"

namespace batten {
namespace {

DistanceBounds OfWhole(const BezierCurve& curve) {
  const Points& points = curve.control_points();
  const Points ends =
      (Points(2, curve.dimension()) << points.topRows(1), points.bottomRows(1)).finished();
  return BoundHausdorffDistance(curve, Eigen::Vector2d(0.0, 1.0), ends);
}

constexpr double kAccuracy = 1e-3;  // to which the upper bound is found

TEST(BezierDistance, AParabolasIsHalfItsControlPointsDistance) {
  const BezierCurve curve = CurveOf(PointsOf({{0, 0}, {1, 2}, {2, 0}}));
  const DistanceBounds bounds = OfWhole(curve);
  EXPECT_LE(bounds.lower, 1.0);
  EXPECT_GE(bounds.upper, 1.0);
  EXPECT_GT(bounds.lower, 1.0 - kAccuracy);
  EXPECT_LT(bounds.upper, 1.0 + kAccuracy);
  EXPECT_NEAR(bounds.t, 0.5, std::sqrt(kAccuracy));
}

TEST(BezierDistance, OvershootOnTheChordsLineCounts) {
  // x = 6 t (1 - t) + ... runs from 0 to 1 by way of 1.5 and beyond, on the x axis: the control
  // points are at distance zero from the line. x(t) = 12 t (1-t)^2 + ... has its maximum known from
  // x' = 0.
  const BezierCurve curve = CurveOf(PointsOf({{0, 0}, {4, 0}, {-3, 0}, {1, 0}}));
  // x(t) = 12 t (1-t)^2 - 9 t^2 (1-t) + t^3 = 12 t - 33 t^2 + 22 t^3, x' = 12 - 66 t + 66 t^2.
  const double t = 0.5 * (1.0 - std::sqrt(1.0 - 4.0 * 12.0 / 66.0));
  const double beyond = 12 * t - 33 * t * t + 22 * t * t * t - 1.0;
  const DistanceBounds bounds = OfWhole(curve);
  EXPECT_LE(bounds.lower, beyond + kEpsilon);
  EXPECT_GE(bounds.upper, beyond);
  EXPECT_LT(bounds.upper, beyond * (1.0 + kAccuracy));
}

TEST(BezierDistance, AClosedCurvesIsThatFromItsPoint) {
  // Symmetric about y: farthest at t = 1/2, at 3/4 of the height of the inner points.
  const BezierCurve curve = CurveOf(PointsOf({{0, 0}, {-1, 4}, {1, 4}, {0, 0}}));
  const DistanceBounds bounds = OfWhole(curve);
  EXPECT_GE(bounds.upper, 3.0);
  EXPECT_LT(bounds.upper, 3.0 * (1.0 + kAccuracy));
}

TEST(BezierDistance, BoundsHoldAgainstDenseSamples) {
  std::mt19937 random(12);
  for (const int degree : {2, 3, 7, 25}) {
    for (const int dimension : {2, 3}) {
      const BezierCurve curve = CurveOf(RandomPoints(degree + 1, dimension, &random));
      const Eigen::VectorXd parameters = Eigen::VectorXd::LinSpaced(9, 0.0, 1.0);
      Points vertices(9, dimension);
      for (int i = 0; i < 9; ++i) curve.Evaluate(parameters[i], vertices.data() + i * dimension);
      const DistanceBounds bounds = BoundHausdorffDistance(curve, parameters, vertices);
      double own = 0.0, any = 0.0;  // farthest from its own segment, from all
      for (int k = 0; k <= 8000; ++k) {
        const double t = k / 8000.0;
        double point[3];
        curve.Evaluate(t, point);
        double nearest = 1e300;
        for (int i = 0; i < 8; ++i) {
          const double* a = vertices.data() + i * dimension;
          const double distance = SquaredSegmentDistance(dimension, point, a, a + dimension);
          nearest = std::min(nearest, distance);
          if (i == std::min(k / 1000, 7)) own = std::max(own, distance);
        }
        any = std::max(any, nearest);
      }
      own = std::sqrt(own);
      EXPECT_GE(bounds.upper, own);
      // Samples 1/8000 apart miss a maximum by |C''| / 2 (1/16000)^2 <= 4 n^2 / 2 / 2.6e8.
      EXPECT_LE(bounds.upper, (own + degree * degree * 1e-8) * (1.0 + kAccuracy) + 1e-12);
      EXPECT_LE(bounds.lower, std::sqrt(any) + degree * degree * 1e-8);
      EXPECT_GT(bounds.lower, 0.0);
    }
  }
}

TEST(BezierDistance, HugeAndTinyCurvesAreMeasuredAlike) {
  const Points points = PointsOf({{0, 0}, {1, 2}, {2, 0}, {3, 5}});
  const double distance = OfWhole(CurveOf(points)).upper;
  for (const int exponent : {-900, 900}) {
    const double factor = std::ldexp(1.0, exponent);
    EXPECT_EQ(OfWhole(CurveOf(points * factor)).upper, distance * factor);
  }
}

TEST(BezierDistance, RefusesWhatIsNoPolyline) {
  const BezierCurve curve = CurveOf(PointsOf({{0, 0}, {1, 2}, {2, 0}}));
  const Points vertices = PointsOf({{0, 0}, {2, 0}});
  EXPECT_THROW(BoundHausdorffDistance(curve, Eigen::Vector2d(0.0, 0.9), vertices),
               std::logic_error);
  EXPECT_THROW(BoundHausdorffDistance(curve, Eigen::Vector3d(0.0, 0.0, 1.0), Points::Zero(3, 2)),
               std::logic_error);
  EXPECT_THROW(BoundHausdorffDistance(curve, Eigen::Vector3d(0.0, 0.5, 1.0), vertices),
               std::logic_error);
}

}  // namespace
}  // namespace batten
