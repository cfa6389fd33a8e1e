#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "splines/closest_point.h"
#include "tests/splines/example_splines.h"

namespace batten {
namespace {

/// Points around a curve, some of them far from it.
Points PointsAround(const BsplineCurve& curve, int count, double noise, std::mt19937* random) {
  const BsplineBasis& basis = curve.basis();
  std::uniform_real_distribution<double> place(basis.domain_begin(), basis.domain_end());
  std::normal_distribution<double> away(0.0, noise);
  Eigen::VectorXd t(count);
  for (double& entry : t) entry = place(*random);
  Points points = curve.Sample(t);
  for (int i = 0; i < count; ++i) {
    for (int c = 0; c < curve.dimension(); ++c) {
      points(i, c) += away(*random) * (i % 10 == 0 ? 20.0 : 1.0);
    }
  }
  return points;
}

class EveryFootWatch : public ::testing::TestWithParam<SplineKind> {};

TEST_P(EveryFootWatch, FindsWhatASearchFindsToTheBitOnCurvesThatMove) {
  std::mt19937 random(20261130);
  std::normal_distribution<double> normal;
  for (const BsplineBasis& basis : MakeBases(GetParam(), &random)) {
    for (int dimension = 1; dimension <= kMaxDimension; ++dimension) {
      SCOPED_TRACE(::testing::Message()
                   << basis.num_control_points() << " points, dimension " << dimension);
      Points control_points(basis.num_control_points(), dimension);
      for (int j = 0; j < control_points.rows(); ++j) {
        for (int c = 0; c < dimension; ++c) {
          control_points(j, c) = 3.0 * std::sin(1.3 * j + c) + 0.3 * normal(random);
        }
      }
      const Points points = PointsAround(BsplineCurve(basis, control_points), 60, 0.05, &random);
      FootWatch watch;
      Eigen::VectorXd t = Eigen::VectorXd::Constant(60, basis.domain_begin());
      // Far, ever nearer, not at all, and far again.
      for (const double step :
           {1.0, 0.5, 0.1, 0.02, 0.004, 1e-4, 1e-8, 0.0, 1e-3, 0.3, 0.01, 1e-5}) {
        for (double& entry : control_points.reshaped()) entry += step * normal(random);
        const BsplineCurve curve(basis, control_points);
        const ClosestPoint closest(curve);
        Eigen::VectorXd plain = t;
        closest.FindAll(points, 1, &plain, nullptr);
        closest.FindAll(points, 1 + dimension % 2, &watch, &t);
        ASSERT_EQ(t, plain) << step;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Splines, EveryFootWatch, ::testing::ValuesIn(AllSplineKinds()), NameOf);

/// Closed uniform cubic on a circle of radius 1, a wave of height `wave` on it.
BsplineCurve WavyCircle(const BsplineBasis& basis, double wave) {
  const int n = basis.num_control_points();
  Points points(n, 2);
  for (int j = 0; j < n; ++j) {
    const double a = 2.0 * M_PI * j / n, radius = 1.0 + wave * std::sin(5.0 * a);
    points.row(j) << radius * std::cos(a), radius * std::sin(a);
  }
  return BsplineCurve(basis, points);
}

TEST(FootWatch, LeavesMostPointsAloneOnceTheCurveHardlyMoves) {
  const BsplineBasis basis = BasisOf(3, true, UniformKnots(3, 40, EndKnots::kPeriodic, 0.0, 1.0));
  std::mt19937 random(5);
  const Points points = PointsAround(WavyCircle(basis, 0.0), 1000, 0.003, &random);
  FootWatch watch;
  Eigen::VectorXd t = Eigen::VectorXd::Zero(1000);
  for (const double wave : {0.0, 1e-3, 1.2e-3, 1.21e-3}) {
    const BsplineCurve curve = WavyCircle(basis, wave);
    ClosestPoint(curve).FindAll(points, 1, &watch, &t);
  }
  EXPECT_GT(watch.NumStayed(), 900);
  // Another curve altogether.
  const BsplineCurve other = WavyCircle(basis, 0.5);
  ClosestPoint(other).FindAll(points, 1, &watch, &t);
  EXPECT_LT(watch.NumStayed(), 100);
}

TEST(FootWatch, SeesAFootJumpAcross) {
  // Two sides of a flat loop, a point between them: the farther one comes nearer by little steps.
  const BsplineBasis basis = BasisOf(3, true, UniformKnots(3, 40, EndKnots::kPeriodic, 0.0, 1.0));
  Points points(1, 2);
  points << 0.013, 0.0;
  FootWatch watch;
  Eigen::VectorXd t(1);
  t << 0.25;
  int num_jumps = 0, num_stayed = 0;
  for (int step = 0; step <= 200; ++step) {
    Points control_points(40, 2);
    for (int j = 0; j < 40; ++j) {
      const double a = 2.0 * M_PI * j / 40;
      const double height = 0.2 * std::sin(a);
      control_points.row(j) << 2.0 * std::cos(a),
          (height > 0.0 ? height : (1.0 - 0.005 * step) * height) + 0.05;
    }
    const double before = t[0];
    const BsplineCurve curve(basis, control_points);
    Eigen::VectorXd plain = t;
    ClosestPoint(curve).FindAll(points, 1, &plain, nullptr);
    ClosestPoint(curve).FindAll(points, 1, &watch, &t);
    ASSERT_EQ(t, plain) << step;
    num_jumps += std::abs(t[0] - before) > 0.2 ? 1 : 0;
    num_stayed += static_cast<int>(watch.NumStayed());
  }
  EXPECT_GE(num_jumps, 1);
  EXPECT_GT(num_stayed, 50);
}

}  // namespace
}  // namespace batten
