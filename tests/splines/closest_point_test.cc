#include "splines/closest_point.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "tests/splines/example_splines.h"

namespace batten {
namespace {

// Two roundings of the slope move the foot by about eps * |C| / |C'|, the parameter is of size 1:
// a few dozen of both.
constexpr double kFootTolerance = 64 * kEpsilon;

double SquaredDistance(const BsplineCurve& curve, const double* point, double t) {
  double value[kMaxDimension];
  curve.Evaluate(t, 0, value);
  double sum = 0.0;
  for (int c = 0; c < curve.dimension(); ++c) sum += std::pow(value[c] - point[c], 2);
  return sum;
}

// C(t) = (t, 2 t) on [0, 1].
BsplineCurve StraightLine(int degree) {
  const BsplineBasis basis = BasisOf(
      degree, false, UniformKnots(degree, degree + 4, EndKnots::kEndInterpolating, 0.0, 1.0));
  Points points(degree + 4, 2);
  for (int j = 0; j < degree + 4; ++j) points.row(j) << basis.Greville(j), 2 * basis.Greville(j);
  return BsplineCurve(basis, points);
}

// Control points at the corners of a regular polygon. The curve has the polygon's symmetries, with
// control point j as the mirror's axis at its Greville abscissa j / n.
BsplineCurve Roundish(int degree, int n) {
  // Greville(0) is the middle of p + 1 spans from u_0 on: shifted so that it falls on 0.
  const double shift = (degree - 1) / (2.0 * n);
  const BsplineBasis basis =
      BasisOf(degree, true, UniformKnots(degree, n, EndKnots::kPeriodic, shift, shift + 1.0));
  Points points(n, 2);
  const double turn = 2.0 * std::acos(-1.0);
  for (int j = 0; j < n; ++j) points.row(j) << std::cos(turn * j / n), std::sin(turn * j / n);
  return BsplineCurve(basis, points);
}

TEST(ClosestPoint, ProjectsOntoAStraightLine) {
  for (int p = 1; p <= kMaxDegree; ++p) {
    const BsplineCurve line = StraightLine(p);
    const ClosestPoint closest(line);
    for (const double t : {0.0, 1e-8, 0.123, 0.5, 0.77, 1.0}) {
      for (const double side : {0.0, 1e-8, -0.7}) {
        const double point[] = {t - 2 * side, 2 * t + side};
        const FootPoint foot = closest.Find(point, 0.4);
        EXPECT_NEAR(foot.parameter, t, kFootTolerance);
        EXPECT_NEAR(foot.squared_distance, 5 * side * side, kFootTolerance * (1e-8 + side * side));
      }
    }
  }
}

TEST(ClosestPoint, EndsAreTheFeetOfPointsBeyondThem) {
  for (int p = 1; p <= kMaxDegree; ++p) {
    const BsplineCurve line = StraightLine(p);
    const ClosestPoint closest(line);
    const double before[] = {-3.0, -2.0};
    const double behind[] = {4.0, 1.8};
    EXPECT_EQ(closest.Find(before, 0.4).parameter, 0.0);
    EXPECT_EQ(closest.Find(before, 0.4).squared_distance, 13.0);
    EXPECT_EQ(closest.Find(behind, 0.4).parameter, 1.0);
  }
}

TEST(ClosestPoint, FindsTheSymmetricFeetOfARoundCurve) {
  for (int p = 2; p <= kMaxDegree; ++p) {
    const int n = 2 * p + 3;
    const BsplineCurve round = Roundish(p, n);
    const ClosestPoint closest(round);
    for (int j = 0; j < n; ++j) {
      const double greville = round.basis().Greville(j);
      double top[2];
      round.Evaluate(greville, 0, top);
      const double radius = std::hypot(top[0], top[1]);
      for (const double scale : {0.8, 1.0, 1.5}) {
        const double point[] = {scale * round.control_points()(j, 0) * radius,
                                scale * round.control_points()(j, 1) * radius};
        const FootPoint foot = closest.Find(point, 0.3);
        // The seam is one of the feet, from both sides.
        const double off = std::abs(foot.parameter - greville);
        EXPECT_LE(std::min(off, 1.0 - off), kFootTolerance) << "degree " << p << ", axis " << j;
        EXPECT_NEAR(std::sqrt(foot.squared_distance), std::abs(scale - 1.0) * radius,
                    kFootTolerance);
      }
    }
  }
}

TEST(ClosestPoint, FindsACorner) {
  // A double knot of a quadratic: the corner (1, 1) at 1/2, nearest to all points above it.
  const BsplineCurve roof(BasisOf(2, false, {0, 0, 0, 0.5, 0.5, 1, 1, 1}),
                          PointsOf({{0, 0}, {0.5, 0.6}, {1, 1}, {1.5, 0.6}, {2, 0}}));
  const ClosestPoint closest(roof);
  const double above[] = {1.1, 2.0};
  const FootPoint foot = closest.Find(above, 0.0);
  EXPECT_NEAR(foot.parameter, 0.5, kFootTolerance);
  EXPECT_NEAR(foot.squared_distance, 1.01, kFootTolerance);
}

TEST(ClosestPoint, AStartBetterThanAllSamplesWins) {
  // C(t) = t on one span; the samples of degree 1 stand at i / 8, the start within one of them.
  const BsplineCurve line(BasisOf(1, false, {0, 0, 1, 1}), PointsOf({{0}, {1}}));
  const double point[] = {0.3};
  EXPECT_NEAR(ClosestPoint(line).Find(point, 0.3 + 1e-3).parameter, 0.3, kFootTolerance);
  EXPECT_EQ(ClosestPoint(line).Find(point, 0.3).parameter, 0.3);
}

TEST(ClosestPoint, CurvesThatArePointsAreAtOneDistanceEverywhere) {
  const BsplineCurve dot(BasisOf(3, true, {-3, -2, -1, 0, 1, 2, 3, 4}), PointsOf({{1, 2, 3}}));
  const double point[] = {1, 2, 5};
  const FootPoint foot = ClosestPoint(dot).Find(point, 0.5);
  EXPECT_NEAR(foot.squared_distance, 4.0, kFootTolerance);
  EXPECT_GE(foot.parameter, 0.0);
  EXPECT_LT(foot.parameter, 1.0);
}

TEST(ClosestPoint, InputThatIsNotFiniteGivesNoFiniteDistance) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const BsplineCurve round = Roundish(3, 7);
  const ClosestPoint closest(round);
  for (const double bad : {nan, infinity, -infinity}) {
    const double point[] = {bad, 1.0};
    const FootPoint foot = closest.Find(point, 0.3);
    EXPECT_FALSE(std::isfinite(foot.squared_distance));
    EXPECT_GE(foot.parameter, round.basis().domain_begin());
    EXPECT_LT(foot.parameter, round.basis().domain_end());
    const double good[] = {2.0, 0.0};
    EXPECT_TRUE(std::isfinite(closest.Find(good, bad).squared_distance));
  }
  const BsplineCurve broken(round.basis(), Points::Constant(7, 2, nan));
  const double good[] = {2.0, 0.0};
  EXPECT_FALSE(std::isfinite(ClosestPoint(broken).Find(good, 0.3).squared_distance));
}

class EveryClosestPoint : public ::testing::TestWithParam<SplineKind> {
 protected:
  std::mt19937 random_{20240507};
  const int p_ = GetParam().degree;
};

TEST_P(EveryClosestPoint, IsNoFartherThanBruteForceAndAtARightAngle) {
  constexpr int kPerSpan = 400;
  for (const BsplineBasis& basis : MakeBases(GetParam(), &random_)) {
    for (int d = 1; d <= kMaxDimension; ++d) {
      SCOPED_TRACE(::testing::Message()
                   << basis.num_control_points() << " points, dimension " << d);
      const BsplineCurve curve(basis, RandomPoints(basis.num_control_points(), d, &random_));
      const ClosestPoint closest(curve);
      const std::vector<int> spans = NonEmptySpans(basis);
      Eigen::VectorXd dense(kPerSpan * spans.size() + 1);
      for (Eigen::Index i = 0; i + 1 < dense.size(); ++i) {
        dense[i] = InSpan(basis, spans[i / kPerSpan], i % kPerSpan / double{kPerSpan});
      }
      dense[dense.size() - 1] = basis.domain_end();
      const Points samples = curve.Sample(dense);
      for (int trial = 0; trial < 5; ++trial) {
        const Points point = RandomPoints(1, d, &random_);
        const double start = RandomParameter(basis, &random_);
        const FootPoint foot = closest.Find(point.data(), start);
        // Coordinates are below 1, each within some p + 4 roundings.
        const double rounding = 8 * d * (p_ + 4) * kEpsilon;
        const double brute = (samples.rowwise() - point.row(0)).rowwise().squaredNorm().minCoeff();
        EXPECT_LE(foot.squared_distance, brute + rounding);
        EXPECT_LE(foot.squared_distance, SquaredDistance(curve, point.data(), start) + rounding);
        EXPECT_NEAR(foot.squared_distance, SquaredDistance(curve, point.data(), foot.parameter),
                    rounding);

        const bool at_end = !basis.periodic() && (foot.parameter == basis.domain_begin() ||
                                                  foot.parameter == basis.domain_end());
        // Feet at corners and ends stand at any angle; random quadratics have a double knot.
        if (at_end || p_ == 1 || (p_ == 2 && !GetParam().uniform)) continue;
        double values[2 * kMaxDimension];
        curve.EvaluateUpTo(foot.parameter, 1, values);
        double slope = 0.0;
        double speed = 0.0;
        for (int c = 0; c < d; ++c) {
          slope += (values[c] - point(0, c)) * values[d + c];
          speed = std::max(speed, std::abs(values[d + c]));
        }
        // Random spans are longer than 0.3, uniform ones than 2.1 / 27: curvatures stay below
        // (2 p / span)^2 times a few, and the parameter is good to a few roundings of it.
        const double span = GetParam().uniform ? 2.1 / basis.num_domain_spans() : 0.3;
        const double bend = std::pow(2 * p_ / span, 2);
        const double size = std::abs(basis.knots().front()) + std::abs(basis.knots().back());
        EXPECT_LE(std::abs(slope), 16 * d * kEpsilon * (bend * size + p_ * speed));
      }
    }
  }
}

TEST_P(EveryClosestPoint, FindsItsOwnPointsAgain) {
  for (const BsplineBasis& basis : MakeBases(GetParam(), &random_)) {
    const BsplineCurve curve(basis, RandomPoints(basis.num_control_points(), 3, &random_));
    const ClosestPoint closest(curve);
    for (int trial = 0; trial < 10; ++trial) {
      double point[3];
      curve.Evaluate(RandomParameter(basis, &random_), 0, point);
      const double distance = std::sqrt(closest.Find(point, basis.domain_begin()).squared_distance);
      // The parameter is good to roundings of its size, the curve moves by |C'| times that.
      const double size = std::abs(basis.knots().front()) + std::abs(basis.knots().back());
      const double span = GetParam().uniform ? 2.1 / basis.num_domain_spans() : 0.3;
      EXPECT_LE(distance, 16 * kEpsilon * (p_ + size * 2 * p_ / span));
    }
  }
}

TEST(ClosestPoint, SearchesLongCurvesByTheirBoxes) {
  // A zigzag of 3001 segments with the tooth j at x = j; feet of points at the tips are the tips.
  const int n = 3002;
  Points points(n, 2);
  for (int j = 0; j < n; ++j) points.row(j) << j, j % 2;
  const BsplineCurve zigzag(
      BasisOf(1, false, UniformKnots(1, n, EndKnots::kEndInterpolating, 0.0, n - 1.0)), points);
  const ClosestPoint closest(zigzag);
  for (int j = 0; j < n; j += 7) {
    const double point[] = {static_cast<double>(j), j % 2 == 0 ? -0.5 : 1.5};
    const FootPoint foot = closest.Find(point, 0.0);
    EXPECT_NEAR(foot.parameter, j, 4 * kEpsilon * n);
    EXPECT_NEAR(foot.squared_distance, 0.25, 16 * kEpsilon * n);
  }
}

// Everywhere at one distance from the point, to rounding: no box excludes another one.
TEST(ClosestPoint, LooksIntoFewPiecesOfALongFlatCurve) {
  const int n = 2000;
  const BsplineBasis basis =
      BasisOf(3, false, UniformKnots(3, n, EndKnots::kEndInterpolating, 0.0, 1.0));
  std::mt19937 random(20240509);
  std::uniform_real_distribution<double> noise(-kEpsilon, kEpsilon);
  for (const double height : {0.0, 5.0}) {
    Points points(n, 1);
    for (int j = 0; j < n; ++j) points(j, 0) = height + std::max(1.0, height) * noise(random);
    points(n / 2, 0) = 10.0;
    const BsplineCurve flat(basis, points);
    const ClosestPoint closest(flat);
    for (const double distance : {0.0, kEpsilon, 1e-11, 1e-3, 1.0}) {
      const double point[] = {height - distance};
      const FootPoint foot = closest.Find(point, 0.3);
      EXPECT_NEAR(std::sqrt(foot.squared_distance), distance, 64 * 10 * kEpsilon);
      // Two runs of eight pieces; all together there are 48,000 pieces.
      EXPECT_LE(foot.num_pieces, 16) << "height " << height << ", distance " << distance;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Splines, EveryClosestPoint, ::testing::ValuesIn(AllSplineKinds()), NameOf);

}  // namespace
}  // namespace batten
