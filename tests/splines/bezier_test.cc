#include "splines/bezier.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/splines/bezier_pieces.h"
#include "tests/splines/example_splines.h"

namespace batten {
namespace {

/// sum_i P_i C(n, i) t^i (1 - t)^(n - i) in long double, coordinate `c`.
long double ByDefinition(const Points& points, long double t, int c) {
  const auto n = static_cast<int>(points.rows()) - 1;
  long double sum = 0.0L, binomial = 1.0L;
  for (int i = 0; i <= n; ++i) {
    sum += binomial * std::pow(t, static_cast<long double>(i)) *
           std::pow(1.0L - t, static_cast<long double>(n - i)) * points(i, c);
    binomial = binomial * (n - i) / (i + 1);
  }
  return sum;
}

/// de Casteljau's algorithm rounds three times a level, of numbers up to 1.
double CasteljauTolerance(int degree) { return 3 * (degree + 1) * kEpsilon / 2; }

TEST(Bezier, EvaluatesTheBernsteinSum) {
  std::mt19937 random(20261128);
  for (const int degree : {0, 1, 2, 3, 4, 5, 6, 12, 25, 60}) {
    for (const int dimension : {1, 2, 3, 4}) {
      const BezierCurve curve = CurveOf(RandomPoints(degree + 1, dimension, &random));
      for (const double t : {0.0, 0.1, 0.5, 0.7853, 1.0}) {
        double point[kMaxDimension];
        curve.Evaluate(t, point);
        for (int c = 0; c < dimension; ++c) {
          EXPECT_NEAR(point[c], ByDefinition(curve.control_points(), t, c),
                      CasteljauTolerance(degree))
              << "degree " << degree << ", t " << t;
        }
      }
    }
  }
}

// from scipy.interpolate import BPoly; import numpy as np
// P = np.array([((i * 37) % 101, (i * 53) % 97) for i in range(26)], float)
// b = BPoly(P.reshape(26, 1, 2), [0, 1]); print(b(0.125), b.derivative()(0.125)), ...
TEST(Bezier, AgreesWithSciPyAtDegree25) {
  Points points(26, 2);
  for (int i = 0; i < 26; ++i) points.row(i) << (i * 37) % 101, (i * 53) % 97;
  const BezierCurve curve = CurveOf(points);
  const struct {
    double t;
    double point[2];
    double derivative[2];
  } kReferences[] = {
      {0.125, {44.32815930487192, 38.28630157741219}, {75.1718026150559, 113.14079939757666}},
      {0.5, {45.076145857572556, 39.449093014001846}, {19.634129106998444, -5.873657763004303}},
      {0.7, {55.87560085303138, 52.041407560356824}, {29.919984248264516, 56.24877163518575}},
  };
  for (const auto& reference : kReferences) {
    double point[2], derivative[2];
    curve.Evaluate(reference.t, point);
    curve.Derivative().Evaluate(reference.t, derivative);
    for (int c = 0; c < 2; ++c) {
      // Both round; coordinates are below 101, legs below 101 n.
      EXPECT_NEAR(point[c], reference.point[c], 2 * 101 * CasteljauTolerance(25));
      EXPECT_NEAR(derivative[c], reference.derivative[c], 2 * 25 * 101 * CasteljauTolerance(25));
    }
  }
}

TEST(Bezier, CutsAQuadraticIntoKnownParts) {
  // C(t) = (2 t, 4 t (1 - t)), cut at 1/4: all numbers are exact.
  const Points points = PointsOf({{0, 0}, {1, 2}, {2, 0}});
  double first[6], second[6];
  CutBezier(2, 2, 0.25, points.data(), first, second);
  const double expected_first[] = {0, 0, 0.25, 0.5, 0.5, 0.75};
  const double expected_second[] = {0.5, 0.75, 1.25, 1.5, 2, 0};
  for (int k = 0; k < 6; ++k) {
    EXPECT_EQ(first[k], expected_first[k]);
    EXPECT_EQ(second[k], expected_second[k]);
  }
}

TEST(Bezier, BothPartsOfACutAreTheCurve) {
  std::mt19937 random(7);
  for (const int degree : {1, 2, 3, 4, 5, 9, 25}) {
    const Points points = RandomPoints(degree + 1, 3, &random);
    for (const double cut : {0.5, 0.2, 0.81}) {
      Points first = points, second = points;
      CutBezier(degree, 3, cut, points.data(), first.data(), second.data());
      for (const double s : {0.0, 0.3, 1.0}) {
        double point[3];
        for (int c = 0; c < 3; ++c) {
          EvaluateBezier(degree, 3, first.data(), s, point);
          EXPECT_NEAR(point[c], ByDefinition(points, static_cast<long double>(s) * cut, c),
                      2 * CasteljauTolerance(degree));
          EvaluateBezier(degree, 3, second.data(), s, point);
          EXPECT_NEAR(point[c], ByDefinition(points, cut + (1.0L - cut) * s, c),
                      2 * CasteljauTolerance(degree));
        }
      }
    }
  }
}

TEST(Bezier, TheSecondPartMayReplaceTheCurve) {
  std::mt19937 random(8);
  for (const int degree : {3, 11}) {
    Points points = RandomPoints(degree + 1, 2, &random);
    Points first = points, second = points, first_in_place = points;
    CutBezier(degree, 2, 0.3, points.data(), first.data(), second.data());
    CutBezier(degree, 2, 0.3, points.data(), first_in_place.data(), points.data());
    EXPECT_EQ(points, second);
    EXPECT_EQ(first_in_place, first);
  }
}

TEST(Bezier, APartIsTheCurveOverItsInterval) {
  std::mt19937 random(9);
  const BezierCurve curve = CurveOf(RandomPoints(12, 2, &random));
  const BezierCurve part = curve.Part(0.15, 0.4);
  for (const double s : {0.0, 0.5, 1.0}) {
    double point[2];
    part.Evaluate(s, point);
    for (int c = 0; c < 2; ++c) {
      // Two cuts, one evaluation, and the fraction begin / end rounded once.
      EXPECT_NEAR(point[c], ByDefinition(curve.control_points(), 0.15L + 0.25L * s, c),
                  4 * CasteljauTolerance(11));
    }
  }
  EXPECT_THROW(curve.Part(0.4, 0.4), std::logic_error);
  EXPECT_THROW(curve.Part(-0.1, 0.4), std::logic_error);
}

TEST(Bezier, RaisingTheDegreeKeepsTheCurve) {
  const BezierCurve parabola = CurveOf(PointsOf({{0, 0}, {1, 2}, {2, 0}}));
  const Points cubic = parabola.Raised(1).control_points();
  EXPECT_LT((cubic - PointsOf({{0, 0}, {2.0 / 3, 4.0 / 3}, {4.0 / 3, 4.0 / 3}, {2, 0}}))
                .cwiseAbs()
                .maxCoeff(),
            4 * kEpsilon);
  std::mt19937 random(10);
  const BezierCurve curve = CurveOf(RandomPoints(8, 2, &random));
  const BezierCurve raised = curve.Raised(53);
  EXPECT_EQ(raised.degree(), kMaxBezierDegree);
  double point[2], same[2];
  for (const double t : {0.0, 0.37, 1.0}) {
    curve.Evaluate(t, point);
    raised.Evaluate(t, same);
    // Each of the 53 levels rounds three times, then the evaluation.
    for (int c = 0; c < 2; ++c) EXPECT_NEAR(same[c], point[c], 2 * CasteljauTolerance(60));
  }
  EXPECT_THROW(curve.Raised(54), std::logic_error);
}

TEST(Bezier, RefusesWhatIsNoCurve) {
  std::string error;
  EXPECT_FALSE(BezierCurve::Make(Points(0, 2), &error));
  EXPECT_EQ(error, "found 0 control points; allowed: 1 to 61");
  EXPECT_FALSE(BezierCurve::Make(Points::Zero(62, 2), &error));
  EXPECT_EQ(error, "found 62 control points; allowed: 1 to 61");
  EXPECT_FALSE(BezierCurve::Make(Points::Zero(3, 5), &error));
  EXPECT_EQ(error, "found control points of 5 coordinates; allowed: 1 to 4");
  Points points = Points::Zero(3, 2);
  points(1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(BezierCurve::Make(points, &error));
  EXPECT_EQ(error, "control point 1 is not finite");
}

}  // namespace
}  // namespace batten
