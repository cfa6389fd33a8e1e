#include "experiments/curve_fairness.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/experiments/outlines.h"
#include "tests/splines/example_splines.h"

namespace batten {
namespace {

BsplineCurve FittedQuintic(const Points& points, bool closed, int n, const char* solver) {
  DataSet data;
  data.name = "quintic";
  data.points = points;
  FitSpec spec;
  spec.degree = 5;
  spec.closed = closed;
  spec.control_points = n;
  std::string error;
  const auto problem = MakeFitProblem(data, spec, &error);
  return problem->curve_fit()->Curve(RunSolver(*problem, solver).x);
}

/// A closed quintic that interpolates (a cos t, b sin(k t)) to many digits: n control points fitted
/// to it. k = 1: an ellipse.
BsplineCurve Ellipse(double a, double b, int n, int k = 1) {
  const int m = 8 * n;
  Points points(m, 2);
  for (int i = 0; i < m; ++i) {
    const double t = 2.0 * M_PI * i / m;
    points.row(i) << a * std::cos(t), b * std::sin(k * t);
  }
  return FittedQuintic(points, true, n, "banded_qr");
}

/// Turned by the angle, then moved.
Points Moved(const Points& points, double angle, double x, double y) {
  Points moved(points.rows(), 2);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    moved.row(i) << x + std::cos(angle) * points(i, 0) - std::sin(angle) * points(i, 1),
        y + std::sin(angle) * points(i, 0) + std::cos(angle) * points(i, 1);
  }
  return moved;
}

void ExpectNoShape(const BsplineCurve& curve) {
  const CurveFairness fairness = MeasureFairness(curve);
  EXPECT_EQ(fairness.bending_energy, 0.0);
  EXPECT_EQ(fairness.curvature_variation, 0.0);
  EXPECT_EQ(fairness.max_curvature, 0.0);
  EXPECT_EQ(fairness.num_curvature_extrema, 0);
  EXPECT_TRUE(fairness.curvature_extrema.empty());
  EXPECT_EQ(fairness.num_inflections, 0);
}

/// y = size (t - 0.2)(t - 0.5)(t - 0.8) integrated twice, x = t: q'' is size times a cubic that
/// changes its sign three times and turns twice.
Points Wiggle(double size) {
  // q = size (t^5 / 20 - t^4 / 8 + 0.11 t^3 - 0.04 t^2); Bezier points are sums of its
  // coefficients.
  const double coefficients[] = {0.0, 0.0, -0.04, 0.11, -0.125, 0.05};
  constexpr double kBinomials[6][6] = {{1},          {1, 1},          {1, 2, 1},
                                       {1, 3, 3, 1}, {1, 4, 6, 4, 1}, {1, 5, 10, 10, 5, 1}};
  Points points(6, 2);
  for (int j = 0; j <= 5; ++j) {
    double y = 0.0;
    for (int i = 0; i <= j; ++i) y += kBinomials[j][i] / kBinomials[5][i] * coefficients[i];
    points.row(j) << j / 5.0, size * y;
  }
  return points;
}

TEST(CurveFairness, OfACircleIsThatOfItsRadius) {
  const double radius = 2.5;
  const CurveFairness fairness = MeasureFairness(Ellipse(radius, radius, 60));
  // A quintic with 60 control points is off the circle by (pi / 30)^6 / 720 of it, its second
  // derivative by that over a squared step.
  const double tolerance = 1e-6;
  EXPECT_NEAR(fairness.bending_energy, 2.0 * M_PI / radius, tolerance);
  EXPECT_NEAR(fairness.max_curvature, 1.0 / radius, tolerance);
  EXPECT_NEAR(fairness.curvature_variation, 0.0, 240 * tolerance);
  EXPECT_EQ(fairness.num_inflections, 0);
}

TEST(CurveFairness, OfAnEllipseHasItsFourVertices) {
  const double a = 3.0, b = 1.0;
  const CurveFairness fairness = MeasureFairness(Ellipse(a, b, 90));
  // Curvature goes from b / a^2 to a / b^2 and back, twice.
  EXPECT_NEAR(fairness.max_curvature, a / (b * b), 1e-3);
  EXPECT_NEAR(fairness.curvature_variation, 4.0 * (a / (b * b) - b / (a * a)), 1e-2);
  // One is at the seam.
  EXPECT_EQ(fairness.num_curvature_extrema, 4);
  EXPECT_EQ(fairness.num_inflections, 0);
  double energy = 0.0;  // of the ellipse, by the trapezoidal rule over its period
  const int steps = 4000;
  for (int i = 0; i < steps; ++i) {
    const double t = 2.0 * M_PI * i / steps;
    const double speed = std::hypot(a * std::sin(t), b * std::cos(t));
    energy += std::pow(a * b / std::pow(speed, 3), 2) * speed * 2.0 * M_PI / steps;
  }
  EXPECT_NEAR(fairness.bending_energy, energy, 1e-4);
}

TEST(CurveFairness, CountsInflectionsInThePlaneOnly) {
  // C(t) = (t, t^3 - t) bends one way, then the other, at t = 0.
  const BsplineBasis basis = BasisOf(3, false, {-1, -1, -1, -1, 1, 1, 1, 1});
  const Points plane = PointsOf({{-1, 0}, {-1.0 / 3, 4.0 / 3}, {1.0 / 3, -4.0 / 3}, {1, 0}});
  const CurveFairness fairness = MeasureFairness(BsplineCurve(basis, plane));
  EXPECT_EQ(fairness.num_inflections, 1);
  EXPECT_EQ(fairness.num_curvature_extrema, 2);
  ASSERT_EQ(fairness.inflections.size(), 1U);
  EXPECT_NEAR(fairness.inflections[0], 0.0, 1e-12);
  // Where 45 t^4 - 12 t^2 - 2 = 0; it is read at 32 places over a length of 2.
  const double extremum = std::sqrt((12.0 + std::sqrt(504.0)) / 90.0);
  ASSERT_EQ(fairness.curvature_extrema.size(), 2U);
  EXPECT_NEAR(fairness.curvature_extrema[0].t, -extremum, 2.0 / 32.0);
  EXPECT_NEAR(fairness.curvature_extrema[1].t, extremum, 2.0 / 32.0);
  Points space = Points::Zero(4, 3);
  space.leftCols(2) = plane;
  const CurveFairness lifted = MeasureFairness(BsplineCurve(basis, space));
  EXPECT_EQ(lifted.num_inflections, -1);
  EXPECT_TRUE(lifted.inflections.empty());
  EXPECT_NEAR(lifted.bending_energy, fairness.bending_energy, 1e-12 * fairness.bending_energy);
  EXPECT_NEAR(lifted.max_curvature, fairness.max_curvature, 1e-12 * fairness.max_curvature);
}

TEST(CurveFairness, KeepsTheFirstThousandPlacesOnly) {
  constexpr int kZigzags = 3000;
  std::vector<double> knots(4, 0.0);
  for (int i = 1; i < kZigzags - 3; ++i) knots.push_back(i);
  knots.insert(knots.end(), 4, kZigzags - 3.0);
  Points points(kZigzags, 2);
  for (int i = 0; i < kZigzags; ++i) points.row(i) << i, i % 2;
  const CurveFairness fairness =
      MeasureFairness(BsplineCurve(BasisOf(3, false, std::move(knots)), points));
  EXPECT_GT(fairness.num_inflections, kZigzags - 10);
  EXPECT_EQ(fairness.inflections.size(), 1000U);
  EXPECT_EQ(fairness.curvature_extrema.size(), 1000U);
  EXPECT_TRUE(std::is_sorted(fairness.inflections.begin(), fairness.inflections.end()));
}

TEST(CurveFairness, OfAStraightLineIsNothing) {
  const BsplineBasis basis = BasisOf(2, false, {0, 0, 0, 1, 3, 3, 3});
  ExpectNoShape(BsplineCurve(basis, PointsOf({{0, 0}, {1, 0}, {4, 0}, {6, 0}})));
}

TEST(CurveFairness, OfTiltedLinesFarFromTheOriginIsNothing) {
  constexpr int kPoints = 20;
  Points line = Points::Zero(kPoints, 2);
  for (int degree : {2, 3, 5, 9}) {
    for (int i = 1; i < kPoints; ++i) line(i, 0) = line(i - 1, 0) + 0.1 * (1 + i % 3);
    std::vector<double> knots(static_cast<std::size_t>(degree) + 1, 0.0);
    for (int i = degree + 1; i < kPoints; ++i) knots.push_back(knots.back() + 0.1 * (1 + i % 4));
    knots.insert(knots.end(), static_cast<std::size_t>(degree) + 1, knots.back() + 0.3);
    const BsplineBasis basis = BasisOf(degree, false, std::move(knots));
    for (double angle : {0.3, 1.1, 2.5}) {
      for (double offset : {0.0, 1e3, 1e9}) {
        SCOPED_TRACE(testing::Message() << degree << ' ' << angle << ' ' << offset);
        const Points points = Moved(line, angle, offset, -0.3 * offset);
        ExpectNoShape(BsplineCurve(basis, points));
        Points space = Points::Constant(kPoints, 3, offset);
        space.leftCols(2) = points;
        EXPECT_EQ(MeasureFairness(BsplineCurve(basis, space)).curvature_variation, 0.0);
      }
    }
  }
}

TEST(CurveFairness, OfFittedLinesIsNothing) {
  constexpr int kData = 300;
  Points line = Points::Zero(kData, 2);
  for (int i = 1; i < kData; ++i) line(i, 0) = line(i - 1, 0) + 1.0 + (i * i) % 7;
  for (const char* solver : {"banded_qr", "banded_cholesky", "dense_qr"}) {
    for (int n : {6, 20, 100}) {
      for (double offset : {0.0, 1e6}) {
        SCOPED_TRACE(testing::Message() << solver << ' ' << n << ' ' << offset);
        ExpectNoShape(FittedQuintic(Moved(line, 0.7, offset, offset), false, n, solver));
      }
    }
  }
}

TEST(CurveFairness, OfASinglePointIsNothing) {
  const BsplineBasis basis = BasisOf(3, false, {0, 0, 0, 0, 1, 2, 3, 3, 3, 3});
  for (double place : {0.0, 1.0 / 3.0, 1e9 / 3.0}) {
    Points points = Points::Constant(6, 2, place);
    ExpectNoShape(BsplineCurve(basis, points));
    // Each is off by a rounding or two.
    for (int i = 0; i < 6; ++i) points.row(i) *= 1.0 + kEpsilon * ((i * i) % 3 - 1);
    points.col(1).reverseInPlace();
    ExpectNoShape(BsplineCurve(basis, points));
  }
}

TEST(CurveFairness, CountsSmallWigglesOfALine) {
  const BsplineBasis basis = BasisOf(5, false, {0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1});
  for (double angle : {0.0, 0.4, 2.0}) {
    for (double offset : {0.0, 1e3}) {
      SCOPED_TRACE(testing::Message() << angle << ' ' << offset);
      const double size = 1e-6;
      const CurveFairness fairness =
          MeasureFairness(BsplineCurve(basis, Moved(Wiggle(size), angle, offset, offset)));
      ASSERT_EQ(fairness.num_inflections, 3);
      EXPECT_NEAR(fairness.inflections[0], 0.2, 0.01);
      EXPECT_NEAR(fairness.inflections[1], 0.5, 0.01);
      EXPECT_NEAR(fairness.inflections[2], 0.8, 0.01);
      ASSERT_EQ(fairness.num_curvature_extrema, 2);
      // The cubic's, 0.3 / sqrt(3) beside the middle.
      const double highest = size * 2.0 * std::pow(0.3, 3) / std::sqrt(27.0);
      EXPECT_NEAR(fairness.curvature_extrema[0].t, 0.5 - 0.3 / std::sqrt(3.0), 1.0 / 32.0);
      EXPECT_NEAR(fairness.curvature_extrema[0].kappa, highest, 0.02 * highest);
      EXPECT_NEAR(fairness.curvature_extrema[1].kappa, -highest, 0.02 * highest);
    }
  }
}

TEST(CurveFairness, CountsSmallWigglesBesideASharpBend) {
  // Behind the wiggle a half-turn to the left of a thousandth: a curvature of some 1e3.
  const BsplineBasis basis = BasisOf(5, false, {0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 2, 2, 2, 2, 2, 2});
  const double size = 1e-6;
  Points points(11, 2);
  points.topRows(6) = Wiggle(size);
  const double x = points(5, 0), y = points(5, 1), r = 1e-3;
  points.bottomRows(5) << x + r, y + r * size, x + 2 * r, y + 0.5 * r, x + 2 * r, y + r, x + r,
      y + 1.5 * r, x, y + 1.5 * r;
  const CurveFairness fairness = MeasureFairness(BsplineCurve(basis, points));
  EXPECT_GT(fairness.max_curvature, 100.0);
  EXPECT_EQ(fairness.num_inflections, 3);
  EXPECT_GE(fairness.num_curvature_extrema, 3);
}

TEST(CurveFairness, OfAParabolaIsThatOfItsVertex) {
  // C(t) = (t, t^2): kappa = 2 / (1 + 4 t^2)^1.5.
  const BsplineBasis basis = BasisOf(2, false, {-1, -1, -1, 1, 1, 1});
  const Points points = PointsOf({{-1, 1}, {0, -1}, {1, 1}});
  for (double offset : {0.0, 1e3}) {
    const CurveFairness fairness =
        MeasureFairness(BsplineCurve(basis, Moved(points, 0.6, offset, offset)));
    EXPECT_EQ(fairness.num_inflections, 0);
    ASSERT_EQ(fairness.num_curvature_extrema, 1);
    const double tolerance = 1e-9;  // roundings of coordinates of 1e3, times second differences
    EXPECT_NEAR(fairness.curvature_extrema[0].t, 0.0, 1e-12);
    EXPECT_NEAR(fairness.curvature_extrema[0].kappa, 2.0, tolerance);
    EXPECT_NEAR(fairness.curvature_variation, 2.0 * (2.0 - 2.0 / std::pow(5.0, 1.5)), tolerance);
  }
}

TEST(CurveFairness, OfClosedCurvesCountsAcrossTheSeam) {
  // All spans of a cubic round a regular octagon are alike: kappa turns at knots and between.
  std::vector<double> knots;
  for (int i = 0; i < 15; ++i) knots.push_back(i - 3.0);
  Points octagon(8, 2);
  for (int i = 0; i < 8; ++i) {
    octagon.row(i) << std::cos(M_PI * i / 4.0), std::sin(M_PI * i / 4.0);
  }
  const BsplineBasis basis = BasisOf(3, true, std::move(knots));
  for (double offset : {0.0, 1e6}) {
    const CurveFairness fairness =
        MeasureFairness(BsplineCurve(basis, Moved(octagon, 0.2, offset, offset)));
    EXPECT_EQ(fairness.num_curvature_extrema, 16);
    EXPECT_EQ(fairness.num_inflections, 0);
  }
  // That of a quintic round 60 points is a circle's to 1e-6 of it.
  EXPECT_EQ(MeasureFairness(Ellipse(2.5, 2.5, 60)).num_curvature_extrema, 0);
  // An eight, (cos t, sin 2t), is straight where it crosses itself, at t = pi / 2 and 3 pi / 2.
  const CurveFairness eight = MeasureFairness(Ellipse(1.0, 1.0, 60, 2));
  ASSERT_EQ(eight.num_inflections, 2);
  EXPECT_NEAR(eight.inflections[0], 0.25, 1e-3);
  EXPECT_NEAR(eight.inflections[1], 0.75, 1e-3);
}

// C(t) = (t, k t^2) on [-0.3, 1]: kappa = 2 k / (1 + x^2)^(3/2) with x = 2 k t, and the integral of
// kappa^2 ds = 2 k times that of (1 + x^2)^(-5/2), whose integral is x / r - x^3 / (3 r^3), r =
// |(1, x)|. The bend at the vertex is as narrow as 1 / k.
TEST(CurveFairness, SeesBendsHoweverSharp) {
  std::string error;
  const auto basis =
      BsplineBasis::Make(3, false, {-0.3, -0.3, -0.3, -0.3, 1.0, 1.0, 1.0, 1.0}, &error);
  ASSERT_TRUE(basis.has_value()) << error;
  for (const double k : {1.0, 1e2, 1e4, 1e6}) {
    SCOPED_TRACE(k);
    // Blossoms: of t the mean, of t^2 the mean of the products of two.
    Points points(4, 2);
    for (int j = 0; j < 4; ++j) {
      const double a = j > 0 ? 1.0 : -0.3, b = j > 1 ? 1.0 : -0.3, c = j > 2 ? 1.0 : -0.3;
      points.row(j) << (a + b + c) / 3.0, k * (a * b + b * c + c * a) / 3.0;
    }
    const CurveFairness fairness = MeasureFairness(BsplineCurve(*basis, points));
    const auto integral = [](double x) {
      const double r = std::hypot(1.0, x);
      return x / r - std::pow(x / r, 3) / 3.0;
    };
    const double energy = 2.0 * k * (integral(2.0 * k) - integral(-0.6 * k));
    EXPECT_NEAR(fairness.bending_energy, energy, 1e-6 * energy);
    EXPECT_NEAR(fairness.max_curvature, 2.0 * k, 2e-6 * k);
    EXPECT_NEAR(fairness.max_curvature_at, 0.0, 1e-3 / k);
    const auto kappa = [k](double t) { return 2.0 * k / std::pow(std::hypot(1.0, 2 * k * t), 3); };
    const double variation = 4.0 * k - kappa(-0.3) - kappa(1.0);
    EXPECT_NEAR(fairness.curvature_variation, variation, 0.01 * variation);
    EXPECT_EQ(fairness.num_curvature_extrema, 1);
  }
}

TEST(CurvatureSamples, KnowArcLengthPlaceAndNormal) {
  const double radius = 2.0;
  const std::vector<CurvatureSample> samples = SampleCurvature(Ellipse(radius, radius, 40), 8);
  EXPECT_EQ(samples.size(), 40U * 9U);
  EXPECT_NEAR(samples.back().s, 2.0 * M_PI * radius, 1e-5);
  for (const CurvatureSample& sample : samples) {
    EXPECT_NEAR(std::hypot(sample.point[0], sample.point[1]), radius, 1e-5);
    // The circle bends towards its centre, to the left.
    EXPECT_NEAR(sample.normal[0], -sample.point[0] / radius, 1e-4);
    EXPECT_NEAR(sample.kappa, 1.0 / radius, 1e-4);
  }
}

}  // namespace
}  // namespace batten
