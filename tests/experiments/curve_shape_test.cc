#include "experiments/curve_shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "splines/closest_point.h"
#include "splines/knot_rules.h"
#include "tests/roundoff.h"

namespace batten {
namespace {

constexpr double kPi = 3.14159265358979323846;
// Lengths are integrated to 1e-9 of each panel and mostly far better.
constexpr double kLengthTolerance = 1e-9;
// Sums of angles between tangents, each good to a few roundings.
constexpr double kAngleTolerance = 1e-10;
// Where a tangent turns to and fro, or in space, the angles between its samples are too small.
constexpr double kSampledAngles = 1e-3;

Points Rows(std::vector<std::vector<double>> rows) {
  Points points(static_cast<Eigen::Index>(rows.size()),
                static_cast<Eigen::Index>(rows.front().size()));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t c = 0; c < rows[i].size(); ++c) points(i, c) = rows[i][c];
  }
  return points;
}

BsplineCurve Curve(int degree, bool closed, const Points& control_points) {
  const auto knots = UniformKnots(degree, static_cast<int>(control_points.rows()),
                                  closed ? EndKnots::kPeriodic : EndKnots::kEndInterpolating, 0, 1);
  std::string error;
  const auto basis = BsplineBasis::Make(degree, closed, knots, &error);
  EXPECT_TRUE(basis.has_value()) << error;
  return BsplineCurve(*basis, control_points);
}

/// Corners of a regular polygon, anticlockwise, on a circle of radius 1.
Points RegularPolygon(int n) {
  Points points(n, 2);
  for (int j = 0; j < n; ++j) {
    points.row(j) << std::cos(2 * kPi * j / n), std::sin(2 * kPi * j / n);
  }
  return points;
}

/// With data at the parameters, which are their feet.
CurveShape ShapeWithDataAt(const BsplineCurve& curve, const std::vector<double>& parameters) {
  const Eigen::VectorXd feet = Eigen::Map<const Eigen::VectorXd>(
      parameters.data(), static_cast<Eigen::Index>(parameters.size()));
  return MeasureShape(curve, curve.Sample(feet), feet);
}

CurveShape ShapeBeside(const BsplineCurve& curve, const Points& data) {
  Eigen::VectorXd feet = Eigen::VectorXd::Constant(data.rows(), curve.basis().domain_begin());
  ClosestPoint(curve).FindAll(data, 1, &feet, nullptr);
  return MeasureShape(curve, data, feet);
}

TEST(CurveShape, KnowsAStraightLine) {
  for (const int degree : {1, 3, 5}) {
    Points points(7, 3);
    for (int j = 0; j < 7; ++j) points.row(j) << 1 + 0.5 * j, -2 + j, j;  // 3, 6, 6: length 9
    const CurveShape shape = ShapeWithDataAt(Curve(degree, false, points), {0.0, 1.0});
    EXPECT_NEAR(shape.length, 9.0, 9 * kLengthTolerance);
    EXPECT_NEAR(shape.turning, 0.0, kAngleTolerance);
    EXPECT_TRUE(std::isnan(shape.rotation));
    EXPECT_NEAR(shape.max_distance_to_data, 4.5, 4.5e-3);
    EXPECT_LE(shape.max_distance_to_data, 4.5 + 9 * 64 * kEpsilon);
    EXPECT_EQ(shape.num_free_loops, 0);
    EXPECT_NEAR(shape.longest_free_arc, 9.0, 9 * kLengthTolerance);
  }
}

TEST(CurveShape, KnowsAPolygonByItsSidesAndCorners) {
  for (const int n : {3, 4, 11}) {
    const Points corners = RegularPolygon(n);
    const BsplineCurve curve = Curve(1, true, corners);
    const CurveShape shape = ShapeBeside(curve, corners);
    const double side = 2 * std::sin(kPi / n);
    EXPECT_NEAR(shape.length, n * side, 64 * kEpsilon * n);
    EXPECT_NEAR(shape.turning, 2 * kPi, kAngleTolerance);
    EXPECT_NEAR(shape.rotation, 1.0, kAngleTolerance);
    EXPECT_NEAR(shape.max_distance_to_data, side / 2, 1e-3 * side);
    EXPECT_EQ(shape.num_free_loops, 0);
    EXPECT_NEAR(shape.longest_free_arc, side, 64 * kEpsilon);
  }
}

TEST(CurveShape, KnowsThatAConvexCurveTurnsOnce) {
  for (const int degree : {2, 3, 6}) {
    const Points polygon = RegularPolygon(9);
    const CurveShape shape = ShapeBeside(Curve(degree, true, polygon), polygon);
    EXPECT_NEAR(shape.turning, 2 * kPi, kAngleTolerance) << degree;
    EXPECT_NEAR(shape.rotation, 1.0, kAngleTolerance) << degree;
    const CurveShape back = ShapeBeside(Curve(degree, true, polygon.colwise().reverse()), polygon);
    EXPECT_NEAR(back.rotation, -1.0, kAngleTolerance) << degree;
    EXPECT_EQ(shape.num_free_loops, 0) << degree;
  }
}

TEST(CurveShape, ComesToTheCircleAsControlPointsGrowInNumber) {
  // At its knots the uniform cubic has radius (4 + 2 cos h) / 6, h = 2 pi / n; its length is that
  // of the circle to fourth order.
  const auto error = [](int n) {
    const CurveShape shape = ShapeBeside(Curve(3, true, RegularPolygon(n)), RegularPolygon(n));
    return std::abs(shape.length - 2 * kPi * (2 + std::cos(2 * kPi / n)) / 3);
  };
  EXPECT_NEAR(std::log2(error(8) / error(16)), 4.0, 0.1);
  EXPECT_LT(error(32), 1e-4);
}

TEST(CurveShape, KnowsAParabola) {
  // y = x^2 from -1 to 1.
  const CurveShape shape =
      ShapeWithDataAt(Curve(2, false, Rows({{-1, 1}, {0, -1}, {1, 1}})), {0.0, 0.5, 1.0});
  const double length = std::sqrt(5.0) + std::asinh(2.0) / 2;
  EXPECT_NEAR(shape.length, length, kLengthTolerance * length);
  EXPECT_NEAR(shape.turning, 2 * std::atan(2.0), kAngleTolerance);
  EXPECT_NEAR(shape.rotation, std::atan(2.0) / kPi, kAngleTolerance);
}

TEST(CurveShape, CountsACuspByPi) {
  // C' = 3 (u^2, u), u = 1 - 2 t: from 45 degrees up to 90, back, and on to -45.
  const CurveShape shape =
      ShapeWithDataAt(Curve(3, false, Rows({{0, 0}, {1, 1}, {0, 1}, {1, 0}})), {0.0, 1.0});
  EXPECT_NEAR(shape.turning, 1.5 * kPi, 1e-6);  // the tangent is taken 1e-6 of a panel beside it
  const double length = 2 * std::sqrt(2.0) - 1;
  EXPECT_NEAR(shape.length, length, 1e-7 * length);  // panels end at 1e-6 of the polygon
}

TEST(CurveShape, CountsBendsToAndFro) {
  // An S: y' / x' = 1 at both ends and 1 - 6 t (1 - t) = -1/2 between: 45 + 26.565 degrees twice.
  const CurveShape shape =
      ShapeWithDataAt(Curve(3, false, Rows({{0, 0}, {1, 1}, {2, -1}, {3, 0}})), {0.0, 1.0});
  EXPECT_NEAR(shape.turning, 2 * (kPi / 4 + std::atan(0.5)), kSampledAngles);
  EXPECT_NEAR(shape.rotation, 0.0, kAngleTolerance);
}

TEST(CurveShape, TurnsInSpaceAsInItsPlane) {
  const Points flat = RegularPolygon(7);
  Points tilted(7, 3);
  for (int j = 0; j < 7; ++j) {
    tilted.row(j) << 0.6 * flat(j, 0) + 100, flat(j, 1) - 100, 0.8 * flat(j, 0);
  }
  const CurveShape shape = ShapeBeside(Curve(3, true, tilted), tilted);
  EXPECT_NEAR(shape.turning, 2 * kPi, 1e-9);
  EXPECT_TRUE(std::isnan(shape.rotation));
  const CurveShape in_plane = ShapeBeside(Curve(3, true, flat), flat);
  EXPECT_NEAR(shape.length, in_plane.length, kLengthTolerance);
}

TEST(CurveShape, IsNotLedAstrayByRoundingFarFromTheOrigin) {
  Points far = RegularPolygon(12);
  far.array() += 1e9;
  const CurveShape shape = ShapeBeside(Curve(3, true, far), far);
  EXPECT_NEAR(shape.rotation, 1.0, 1e-6);
  EXPECT_NEAR(shape.turning, 2 * kPi, 1e-4);
  EXPECT_EQ(shape.num_free_loops, 0);
}

TEST(CurveShape, GivesAPointNoLengthAndNoTurning) {
  Points points(5, 2);
  points.rowwise() = Eigen::RowVector2d(0.1, 0.3);
  for (const bool closed : {false, true}) {
    const CurveShape shape = ShapeBeside(Curve(3, closed, points), Rows({{0.1, 4.3}, {3.1, 4.3}}));
    EXPECT_LE(shape.length, 64 * kEpsilon);
    EXPECT_EQ(shape.turning, 0.0);
    EXPECT_NEAR(shape.max_distance_to_data, 4.0, 64 * kEpsilon);
  }
}

TEST(CurveShape, GivesAPointOfRoundingsNoTurningAndNoLoop) {
  Points points(7, 2);
  for (int j = 0; j < 7; ++j) {
    points.row(j) << 1e9 * (1.0 + kEpsilon * (j % 3 - 1)), 1e9 * (1.0 + kEpsilon * (j * j % 3 - 1));
  }
  for (const bool closed : {false, true}) {
    const CurveShape shape = ShapeBeside(Curve(3, closed, points), Rows({{0, 0}, {1e9, 0}}));
    EXPECT_EQ(shape.turning, 0.0);
    EXPECT_EQ(shape.num_free_loops, 0);
  }
}

/// A way along the x axis, from 0 to 9, with a detour of `height` between x = 4 and 4.5.
BsplineCurve WithDetour(double height) {
  return Curve(1, false, Rows({{0, 0}, {4, 0}, {4, height}, {4.5, height}, {4.5, 0}, {9, 0}}));
}
/// Data on the x axis, one apart, at the detour half as far.
const std::vector<double> kBesideDetour = {
    0.0, 0.05, 0.1, 0.15, 0.2, 0.8, 0.8 + 1 / 22.5, 0.8 + 2 / 22.5, 0.8 + 3 / 22.5, 1.0};

TEST(CurveShape, FlagsALoopWithoutData) {
  const CurveShape shape = ShapeWithDataAt(WithDetour(3), kBesideDetour);
  EXPECT_EQ(shape.num_free_loops, 1);
  EXPECT_NEAR(shape.longest_free_arc, 6.5, 64 * kEpsilon);
  const double farthest = std::sqrt(9 + 0.0625);
  EXPECT_NEAR(shape.max_distance_to_data, farthest, 1e-3 * farthest);
}

TEST(CurveShape, LetsADetourPassThatIsNotLongerThanUsual) {
  const CurveShape shape = ShapeWithDataAt(WithDetour(1.7), kBesideDetour);  // 3.9 < 4
  EXPECT_EQ(shape.num_free_loops, 0);
  EXPECT_NEAR(shape.longest_free_arc, 3.9, 64 * kEpsilon);
  EXPECT_EQ(ShapeWithDataAt(WithDetour(1.8), kBesideDetour).num_free_loops, 1);  // 4.1
}

TEST(CurveShape, LetsTheWayAcrossAGapPass) {
  const BsplineCurve line = Curve(1, false, Rows({{0, 0}, {100, 0}}));
  const CurveShape shape =
      ShapeWithDataAt(line, {0.0, 0.01, 0.02, 0.03, 0.04, 0.96, 0.97, 0.98, 0.99, 1.0});
  EXPECT_EQ(shape.num_free_loops, 0);
  EXPECT_NEAR(shape.longest_free_arc, 92.0, 100 * 64 * kEpsilon);
}

TEST(CurveShape, FlagsAnEndThatGoesOffAndComesBackButNotOneThatGoesOff) {
  const BsplineCurve back = Curve(1, false, Rows({{0, 0}, {5, 0}, {20, 0.1}, {5, 0.2}, {1, 0.3}}));
  const std::vector<double> data = {0.0, 0.05, 0.1, 0.15, 0.2, 0.25};
  EXPECT_EQ(ShapeWithDataAt(back, data).num_free_loops, 1);
  const BsplineCurve off = Curve(1, false, Rows({{0, 0}, {5, 0}, {10, 0}, {15, 0}, {20, 0}}));
  const CurveShape shape = ShapeWithDataAt(off, data);
  EXPECT_EQ(shape.num_free_loops, 0);
  EXPECT_NEAR(shape.longest_free_arc, 15.0, 20 * 64 * kEpsilon);
}

// Where every arc is long none is longer than usual, and an end may go off straight.
TEST(CurveShape, FlagsArcsThatAreFarLongerThanTheDataAreLarge) {
  const Points corners = Rows({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  const BsplineCurve hull = Curve(1, true, 100.0 * corners);
  Eigen::VectorXd feet(4);
  feet << 0.125, 0.375, 0.625, 0.875;
  EXPECT_EQ(MeasureShape(hull, corners, feet).num_free_loops, 4);
  EXPECT_EQ(MeasureShape(hull, 20.0 * corners, feet).num_free_loops, 0);
  const BsplineCurve off = Curve(1, false, Rows({{0, 0}, {5, 0}, {5 + 4.01 * 5, 0}}));
  const std::vector<double> data = {0.0, 0.1, 0.2, 0.3, 0.4, 0.5};
  EXPECT_EQ(ShapeWithDataAt(off, data).num_free_loops, 1);
}

TEST(CurveShape, FlagsAClosedCurveWhoseDataAreInOnePlace) {
  const BsplineCurve circle = Curve(3, true, RegularPolygon(8));
  const CurveShape shape = ShapeWithDataAt(circle, {0.3, 0.3, 0.3});
  EXPECT_EQ(shape.num_free_loops, 1);
  EXPECT_NEAR(shape.longest_free_arc, shape.length, kLengthTolerance * shape.length);
  EXPECT_EQ(ShapeWithDataAt(circle, {0.3, 0.3001}).num_free_loops, 1);
  // The seam is a place like any other.
  EXPECT_EQ(ShapeWithDataAt(circle, {0.0, 0.25, 0.5, 0.75}).num_free_loops, 0);
  EXPECT_EQ(ShapeWithDataAt(circle, {0.1, 0.35, 0.6, 0.85}).num_free_loops, 0);
}

/// Against dense sampling, on curves without symmetry.
TEST(CurveShape, FindsTheFarthestPointThatSamplingFinds) {
  std::mt19937 random(20260102);
  std::normal_distribution<double> normal;
  for (const int dimension : {2, 3}) {
    for (const bool closed : {false, true}) {
      Points control_points(15, dimension);
      Points data(40, dimension);
      for (double& value : control_points.reshaped()) value = normal(random);
      for (double& value : data.reshaped()) value = normal(random);
      const BsplineCurve curve = Curve(3, closed, control_points);
      const CurveShape shape = ShapeBeside(curve, data);
      const Points samples = curve.Sample(Eigen::VectorXd::LinSpaced(20001, 0.0, 1.0));
      double largest = 0.0;
      double length = 0.0;
      for (Eigen::Index k = 0; k < samples.rows(); ++k) {
        largest = std::max(largest, (data.rowwise() - samples.row(k)).rowwise().norm().minCoeff());
        if (k > 0) length += (samples.row(k) - samples.row(k - 1)).norm();
      }
      EXPECT_NEAR(shape.max_distance_to_data, largest, 1e-3 * largest + 1e-5 * length);
      EXPECT_NEAR(shape.length, length, 1e-6 * length);  // chords of 20000: second order
    }
  }
}

/// The graph of Chebyshev's T9 on [-1, 1] as one span of floating knots. By its blossom, which of
/// x^k is the mean product of k of the knots, control points are up to 8e9 away from the curve.
BsplineCurve ChebyshevGraph() {
  constexpr int kDegree = 9;
  std::vector<double> knots;
  for (int k = -9; k <= 10; ++k) knots.push_back(2 * k - 1);
  const double coefficients[] = {0, 9, 0, -120, 0, 432, 0, -576, 0, 256};  // of x^k
  Points control_points(kDegree + 1, 2);
  for (int j = 0; j <= kDegree; ++j) {
    double symmetric[kDegree + 1] = {1.0};  // sums of products of k of the knots j + 1 .. j + 9
    for (int i = j + 1; i <= j + kDegree; ++i) {
      for (int k = kDegree; k >= 1; --k) symmetric[k] += knots[i] * symmetric[k - 1];
    }
    double choose = kDegree;
    control_points.row(j) << symmetric[1] / choose, 0.0;
    for (int k = 1; k <= kDegree; ++k) {
      control_points(j, 1) += coefficients[k] * symmetric[k] / choose;
      choose = choose * (kDegree - k) / (k + 1);
    }
  }
  std::string error;
  const auto basis = BsplineBasis::Make(kDegree, false, knots, &error);
  EXPECT_TRUE(basis.has_value()) << error;
  return BsplineCurve(*basis, control_points);
}

TEST(CurveShape, EndsWhereControlPointsAreFarFromTheCurve) {
  const BsplineCurve curve = ChebyshevGraph();
  const double far = curve.control_points().cwiseAbs().maxCoeff();
  EXPECT_GT(far, 1e9);
  const CurveShape shape = ShapeBeside(curve, Rows({{0, 10}, {0, 11}}));
  // scipy.integrate.quad of sqrt(1 + T9'(x)^2) between the zeros of T9'. Panels may be as short as
  // 64 roundings of the control points, and no digit of such a one is sure.
  EXPECT_NEAR(shape.length, 18.237311384671056, 64 * kEpsilon * far);
  // In (-1, -1).
  EXPECT_NEAR(shape.max_distance_to_data, std::sqrt(122.0), 1e-3 * std::sqrt(122.0));
}

}  // namespace
}  // namespace batten
