// Closest points against a search in long double that shares no code with splines/: de Boor's
// recursion, many samples, and golden-section search around the lowest of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "splines/closest_point.h"
#include "tests/roundoff.h"
#include "tests/splines/example_splines.h"

namespace batten {
namespace {

using Real = long double;

/// Squared distance of one point from a curve in long double.
class ExtendedDistance {
 public:
  ExtendedDistance(const BsplineCurve& curve, const double* point)
      : curve_(curve), point_(point), p_(curve.basis().degree()) {}

  Real At(int span, Real t) const {
    const BsplineBasis& basis = curve_.basis();
    const double* u = &basis.knots()[span - p_];
    Real sum = 0;
    for (int c = 0; c < curve_.dimension(); ++c) {
      Real level[kMaxOrder];
      for (int j = 0; j <= p_; ++j) {
        level[j] = curve_.control_points()(basis.ControlPointIndex(span - p_ + j), c);
      }
      for (int r = 1; r <= p_; ++r) {
        for (int j = p_; j >= r; --j) {
          const Real a = (t - u[j]) / (static_cast<Real>(u[j + p_ - r + 1]) - u[j]);
          level[j] = (1 - a) * level[j - 1] + a * level[j];
        }
      }
      sum += (level[p_] - point_[c]) * (level[p_] - point_[c]);
    }
    return sum;
  }

  /// The least distance found.
  Real Search() const {
    constexpr int kSamples = 48;
    Real least = At(curve_.basis().first_span(), curve_.basis().domain_begin());
    std::vector<Real> f(kSamples + 1);
    for (const int span : NonEmptySpans(curve_.basis())) {
      const Real low = curve_.basis().knots()[span];
      const Real step = (curve_.basis().knots()[span + 1] - low) / kSamples;
      for (int i = 0; i <= kSamples; ++i) f[i] = At(span, low + i * step);
      for (int i = 0; i <= kSamples; ++i) {
        least = std::min(least, f[i]);
        const bool is_low = f[i] <= f[std::max(i - 1, 0)] && f[i] <= f[std::min(i + 1, kSamples)];
        // Between samples f does not fall by more than this of what it differs from the next ones.
        constexpr Real kFall = 1.0L;
        const Real around = std::max(f[std::max(i - 1, 0)], f[std::min(i + 1, kSamples)]) - f[i];
        if (!is_low || f[i] - kFall * around > least) continue;
        least = std::min(least, Golden(span, low + std::max(i - 1, 0) * step,
                                       low + std::min(i + 1, kSamples) * step));
      }
    }
    return std::sqrt(least);
  }

 private:
  Real Golden(int span, Real a, Real b) const {
    const Real ratio = (std::sqrt(static_cast<Real>(5)) - 1) / 2;
    Real x = b - ratio * (b - a), y = a + ratio * (b - a);
    Real fx = At(span, x), fy = At(span, y);
    // 60 steps shorten the bracket by 3e-13: f is flat to its square there.
    for (int k = 0; k < 60; ++k) {
      if (fx <= fy) {
        b = y, y = x, fy = fx;
        x = b - ratio * (b - a), fx = At(span, x);
      } else {
        a = x, x = y, fx = fy;
        y = a + ratio * (b - a), fy = At(span, y);
      }
    }
    return std::min(fx, fy);
  }

  const BsplineCurve& curve_;
  const double* point_;
  int p_;
};

/// A point of the kind `kind`: anywhere around `middle`, far off, on the curve, or at a centre of
/// curvature.
void PlacePoint(const BsplineCurve& curve, const Eigen::RowVectorXd& middle, int kind,
                std::mt19937* random, double* point) {
  const int d = curve.dimension();
  std::normal_distribution<double> normal(0.0, 1.0);
  double values[3 * kMaxDimension];
  curve.EvaluateUpTo(RandomParameter(curve.basis(), random), 2, values);
  const double* first = values + d;
  const double* second = values + 2 * d;
  double squared_speed = 0.0, along = 0.0, squared_bend = 0.0;
  for (int c = 0; c < d; ++c) squared_speed += first[c] * first[c], along += first[c] * second[c];
  double bend[kMaxDimension] = {};
  for (int c = 0; c < d && squared_speed > 0.0; ++c) {
    bend[c] = (second[c] - along / squared_speed * first[c]) / squared_speed;
    squared_bend += bend[c] * bend[c];
  }
  for (int c = 0; c < d; ++c) {
    if (kind == 0 || (kind == 3 && !(squared_bend > 1e-6))) point[c] = middle[c] + normal(*random);
    if (kind == 1) point[c] = middle[c] + 1000.0 * normal(*random);
    if (kind == 2) point[c] = values[c];
    if (kind == 3 && squared_bend > 1e-6) point[c] = values[c] + bend[c] / squared_bend;
  }
}

// Of squares, their sum and a root, here and in the test itself, in parts of the number.
constexpr double kRoundings = 1e-15;

/// Where the curve of a case lies: at the origin, or some sizes or many from it.
Eigen::RowVectorXd RandomMiddle(int dimension, std::mt19937* random) {
  const double distances[] = {0.0, 3.0, 1e3, 1e6};
  const double distance = distances[(*random)() % 4];
  Eigen::RowVectorXd middle(dimension);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (double& coordinate : middle) coordinate = distance * uniform(*random);
  return middle;
}

/// What may be open: 1e-12 of the larger of size and distance; where a rounding of the coordinates
/// is more, what the coordinates of the curve's points are off (order products and as many sums)
/// does to a distance, on either side of the certificate and in either of its bounds.
double AllowedGap(const BsplineBasis& basis, int dimension, double size,
                  const Eigen::RowVectorXd& middle, double distance) {
  const double coordinate = middle.cwiseAbs().maxCoeff() + 1.0;
  const double off = 2.0 * basis.order() * kEpsilon * coordinate;
  return std::max(1e-12 * std::max(size, distance), 4.0 * std::sqrt(dimension) * off) +
         kRoundings * distance;
}

TEST(ClosestPointCertificate, NoPointIsNearerThanTheBoundInAHundredThousandCases) {
  constexpr int kCases = 100'000;
  constexpr int kPointsPerCurve = 25;
  std::mt19937 random(20261128);
  const std::vector<SplineKind> kinds = AllSplineKinds();
  int cases = 0, uncertified = 0;
  for (int round = 0; cases < kCases; ++round) {
    for (const SplineKind& kind : kinds) {
      for (const BsplineBasis& basis : MakeBases(kind, &random)) {
        const int d = 1 + round % kMaxDimension;
        const Eigen::RowVectorXd middle = RandomMiddle(d, &random);
        Points control_points = RandomPoints(basis.num_control_points(), d, &random);
        const double size =
            (control_points.colwise().maxCoeff() - control_points.colwise().minCoeff()).maxCoeff();
        control_points.rowwise() += middle;
        const BsplineCurve curve(basis, control_points);
        const ClosestPoint closest(curve);
        for (int k = 0; k < kPointsPerCurve && cases < kCases; ++k, ++cases) {
          double point[kMaxDimension];
          PlacePoint(curve, middle, k % 4, &random, point);
          const FootPoint foot = closest.Find(point, RandomParameter(basis, &random));
          const double distance = std::sqrt(foot.squared_distance);
          const double allowed = AllowedGap(basis, d, size, middle, distance);
          uncertified += distance - foot.lower_bound > allowed;
          const ExtendedDistance extended(curve, point);
          const auto least = static_cast<double>(extended.Search());
          ASSERT_GE(least, foot.lower_bound - kRoundings * distance) << "case " << cases;
          ASSERT_LE(distance - least, allowed) << "case " << cases;
          const auto there =
              static_cast<double>(extended.At(basis.FindSpan(foot.parameter), foot.parameter));
          ASSERT_NEAR(std::sqrt(there), distance, allowed);
        }
      }
    }
  }
  EXPECT_EQ(uncertified, 0);
}

TEST(ClosestPointCertificate, ReportsTies) {
  // Two straight legs from a corner, and a point on their bisector: C(t) = (|t|, t) on [-1, 1].
  const BsplineCurve legs(BasisOf(1, false, {-1, -1, 0, 1, 1}),
                          PointsOf({{1, -1}, {0, 0}, {1, 1}}));
  const ClosestPoint closest(legs);
  const double between[] = {1.0, 0.0};
  const FootPoint foot = closest.Find(between, 0.51, true);
  EXPECT_TRUE(foot.tie);
  EXPECT_NEAR(foot.parameter, 0.5, 1e-15);  // the start's side
  EXPECT_NEAR(foot.other, -0.5, 1e-15);
  EXPECT_NEAR(closest.Find(between, -0.51, true).parameter, -0.5, 1e-15);
  EXPECT_NEAR(foot.squared_distance, 0.5, 1e-15);
  // Nearer to the upper leg by 1e-9 than to the lower one: 1000 tolerances.
  const double above[] = {1.0, 1e-9};
  EXPECT_FALSE(closest.Find(above, -0.9, true).tie);
  EXPECT_NEAR(closest.Find(above, -0.9).parameter, 0.5, 1e-8);
  // At the corner both legs meet in one parameter: no tie.
  const double corner[] = {-1.0, 0.0};
  EXPECT_FALSE(closest.Find(corner, 0.9, true).tie);
  EXPECT_EQ(closest.Find(corner, 0.9).parameter, 0.0);
}

TEST(ClosestPointCertificate, ReportsTiesOfManyPointsEachIfAsked) {
  // The same legs: on their bisector both are as near, off it one is nearer, at the corner one.
  const BsplineCurve legs(BasisOf(1, false, {-1, -1, 0, 1, 1}),
                          PointsOf({{1, -1}, {0, 0}, {1, 1}}));
  const ClosestPoint closest(legs);
  const Points points = PointsOf({{1, 0}, {1, 0.25}, {0.5, 0}, {-1, 0}});
  const Eigen::VectorXd starts = Eigen::VectorXd::Constant(4, 0.9);
  const bool ties[] = {true, false, true, false};
  const double squared_distances[] = {0.5, 0.5 * 0.75 * 0.75, 0.125, 1.0};
  for (const int threads : {1, 2}) {
    const std::vector<FootPoint> feet = closest.FindAll(points, threads, starts, true);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(feet[i].tie, ties[i]) << i;
      EXPECT_NEAR(feet[i].squared_distance, squared_distances[i], 1e-15);
      EXPECT_NEAR(feet[i].lower_bound, std::sqrt(squared_distances[i]), 3e-12);
      EXPECT_LE(feet[i].lower_bound, std::sqrt(squared_distances[i]));
      EXPECT_FALSE(closest.FindAll(points, threads, starts, false)[i].tie);
    }
  }
}

TEST(ClosestPointCertificate, ReportsSelfCrossingsAsTies) {
  // (t^2 - 1, t (t^2 - 1)) on [-1.5, 1.5] passes through the origin at t = -1 and 1; Bezier points
  // by the blossom of t, t^2 and t^3.
  const double a = -1.5, b = 1.5;
  const auto point = [](double u, double v, double w) {
    const double mean = (u + v + w) / 3.0;
    return std::vector<double>{(u * v + v * w + w * u) / 3.0 - 1.0, u * v * w - mean};
  };
  const BsplineCurve loop(
      BasisOf(3, false, {a, a, a, a, b, b, b, b}),
      PointsOf({point(a, a, a), point(a, a, b), point(a, b, b), point(b, b, b)}));
  const double origin[] = {0.0, 0.0};
  const FootPoint foot = ClosestPoint(loop).Find(origin, 0.3, true);
  EXPECT_TRUE(foot.tie);
  EXPECT_NEAR(std::abs(foot.parameter), 1.0, 1e-12);
  EXPECT_NEAR(foot.parameter + foot.other, 0.0, 1e-12);
}

TEST(ClosestPointCertificate, TheCentreOfASquareRoundIsATieOfFour) {
  // Four control points at the corners of a square: the curve has its symmetries.
  const BsplineCurve round(BasisOf(3, true, UniformKnots(3, 4, EndKnots::kPeriodic, 0.0, 1.0)),
                           PointsOf({{1, 1}, {-1, 1}, {-1, -1}, {1, -1}}));
  const double centre[] = {0.0, 0.0};
  const FootPoint foot = ClosestPoint(round).Find(centre, 0.1, true);
  EXPECT_TRUE(foot.tie);
  const double turns = 4.0 * std::abs(foot.parameter - foot.other);
  EXPECT_NEAR(turns, std::round(turns), 1e-7);
}

TEST(ClosestPointCertificate, CentresOfCurvatureAreCertified) {
  // y = x^2 at its vertex bends with radius 1/2: f = t^2 + (t^2 - 1/2)^2 = 1/4 + t^4.
  const BsplineCurve parabola(BasisOf(2, false, {-1, -1, -1, 1, 1, 1}),
                              PointsOf({{-1, 1}, {0, -1}, {1, 1}}));
  const double centre[] = {0.0, 0.5};
  for (const double start : {-0.9, -1e-3, 0.0, 0.7}) {
    const FootPoint foot = ClosestPoint(parabola).Find(centre, start);
    EXPECT_NEAR(std::sqrt(foot.squared_distance), 0.5, 2e-12) << start;
    EXPECT_LE(std::sqrt(foot.squared_distance) - foot.lower_bound, 4e-12);
    EXPECT_LT(foot.num_pieces, 200);
  }
}

TEST(ClosestPointCertificate, CuspsAndStoppedCurvesAreCertified) {
  // (t^2, t^3) stops at its cusp; all points to its left have their foot there.
  const BsplineCurve cusp(BasisOf(3, false, {-1, -1, -1, -1, 1, 1, 1, 1}),
                          PointsOf({{1, -1}, {-1.0 / 3, 1}, {-1.0 / 3, -1}, {1, 1}}));
  for (const double left : {1e-3, 0.1, 2.0}) {
    const double point[] = {-left, 0.0};
    const FootPoint foot = ClosestPoint(cusp).Find(point, 0.6);
    EXPECT_NEAR(std::sqrt(foot.squared_distance), left, 2e-12);
    EXPECT_LE(std::sqrt(foot.squared_distance) - foot.lower_bound, 8e-12);
  }
}

TEST(ClosestPointCertificate, ThreadsDoNotChangeABit) {
  std::mt19937 random(5);
  const BsplineBasis basis = BasisOf(3, true, UniformKnots(3, 40, EndKnots::kPeriodic, 0.0, 1.0));
  const BsplineCurve curve(basis, RandomPoints(40, 2, &random));
  const ClosestPoint closest(curve);
  const Points points = RandomPoints(1001, 2, &random);
  Eigen::VectorXd one = Eigen::VectorXd::Constant(1001, 0.25);
  Eigen::VectorXd distances;
  closest.FindAll(points, 1, &one, &distances);
  for (const int threads : {2, 3, 7}) {
    Eigen::VectorXd many = Eigen::VectorXd::Constant(1001, 0.25);
    closest.FindAll(points, threads, &many, nullptr);
    EXPECT_TRUE((one.array() == many.array()).all());
  }
  // With all that Find says of each.
  for (const int threads : {1, 3}) {
    const Eigen::VectorXd starts = Eigen::VectorXd::Constant(1001, 0.25);
    const std::vector<FootPoint> feet = closest.FindAll(points, threads, starts, true);
    ASSERT_EQ(feet.size(), 1001U);
    for (std::size_t i = 0; i < feet.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      const FootPoint foot = closest.Find(&points(row, 0), 0.25, true);
      EXPECT_EQ(feet[i].parameter, one[row]);
      EXPECT_EQ(feet[i].squared_distance, distances[row]);
      EXPECT_EQ(feet[i].lower_bound, foot.lower_bound);
      EXPECT_EQ(feet[i].tie, foot.tie);
    }
  }
  // Started from their feet, points find them again.
  Eigen::VectorXd again = one;
  closest.FindAll(points, 1, &again, nullptr);
  EXPECT_LT((again - one).cwiseAbs().maxCoeff(), 1e-7);
}

}  // namespace
}  // namespace batten
