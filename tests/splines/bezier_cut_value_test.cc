#include "splines/bezier_cut_value.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "splines/bezier_hull.h"
#include "splines/bezier_measures.h"
#include "tests/splines/example_splines.h"

namespace batten {
namespace {

constexpr double kPlaces[] = {0.1, 0.3, 0.5, 0.64, 0.95};

Points SymmetricPoints(int degree, std::mt19937* random) {
  Points points = RandomPoints(degree + 1, 2, random);
  for (int i = 0; 2 * i <= degree; ++i) {
    points(degree - i, 0) = -points(i, 0);
    points(degree - i, 1) = points(i, 1);
  }
  if (degree % 2 == 0) points(degree / 2, 0) = 0.0;
  return points;
}

double ValueAt(CutMeasure measure, const Points& points, double u) {
  return CutValue(measure, static_cast<int>(points.rows()) - 1, 2, points.data())(u);
}

TEST(CutValue, HullsOfAParabolasPartsShrinkWithTheCube) {
  // The triangle of the part [0, u] has u^3 of the area of the whole, 2.
  const Points points = PointsOf({{0, 0}, {1, 2}, {2, 0}});
  for (const double u : kPlaces) {
    EXPECT_NEAR(ValueAt(CutMeasure::kHullArea, points, u),
                2.0 * (std::pow(u, 3) + std::pow(1 - u, 3)), 16 * kEpsilon);
  }
}

TEST(CutValue, FlatnessOfAParabolasPartsIsKnown) {
  // C(u) = (2 u, 4 u (1 - u)): the inner points (u, 2 u) and (1 + u, 2 - 2 u) are 2 |area| /
  // |chord| from their chords, area as above.
  const Points points = PointsOf({{0, 0}, {1, 2}, {2, 0}});
  for (const double u : kPlaces) {
    const double x = 2 * u, y = 4 * u * (1 - u);
    const double first = std::pow(4 * std::pow(u, 3), 2) / (x * x + y * y);
    const double second = std::pow(4 * std::pow(1 - u, 3), 2) / ((2 - x) * (2 - x) + y * y);
    EXPECT_NEAR(ValueAt(CutMeasure::kFlatness, points, u), first + second, 32 * kEpsilon);
  }
}

TEST(CutValue, AtTheEndsItIsThatOfTheWhole) {
  std::mt19937 random(1);
  const Points points = RandomPoints(7, 2, &random);
  const Quotient whole = Flatness(6, 2, points.data());
  for (const double u : {0.0, 1.0}) {
    EXPECT_NEAR(ValueAt(CutMeasure::kFlatness, points, u), whole.numerator / whole.denominator,
                1e-13);
    EXPECT_EQ(ValueAt(CutMeasure::kHullArea, points, u), HullArea(6, points.data()));
  }
}

// The properties that the 2016 paper proves of its best cuts (2.1 to 2.3), as statements about the
// whole function, from which those about its minimum follow.

TEST(CutValue, MovingTurningAndScalingDoNotMoveTheBestCut) {
  std::mt19937 random(2);
  const Points points = RandomPoints(9, 2, &random);
  Eigen::Matrix2d turn;
  turn << 0.6, -0.8, 0.8, 0.6;
  const Points moved = (8.0 * points * turn.transpose()).rowwise() + Eigen::RowVector2d(3.0, -5.0);
  for (const CutMeasure measure : {CutMeasure::kFlatness, CutMeasure::kHullArea}) {
    for (const double u : kPlaces) {
      // Squares of numbers up to 20, some 30 roundings each.
      EXPECT_NEAR(ValueAt(measure, moved, u), 64.0 * ValueAt(measure, points, u),
                  30 * 400 * kEpsilon);
    }
  }
}

TEST(CutValue, AnyAffineMapKeepsTheBestCutOfTheHullsButNotTheFlattest) {
  std::mt19937 random(3);
  const Points points = RandomPoints(6, 2, &random);
  Eigen::Matrix2d map;
  map << 3.0, 1.0, 0.5, 0.25;  // determinant 1/4
  const Points mapped = points * map.transpose();
  double largest_change = 0.0;
  for (const double u : kPlaces) {
    EXPECT_NEAR(ValueAt(CutMeasure::kHullArea, mapped, u),
                0.25 * ValueAt(CutMeasure::kHullArea, points, u), 30 * 16 * kEpsilon);
    const double ratio =
        ValueAt(CutMeasure::kFlatness, mapped, u) / ValueAt(CutMeasure::kFlatness, points, u);
    const double at_half =
        ValueAt(CutMeasure::kFlatness, mapped, 0.5) / ValueAt(CutMeasure::kFlatness, points, 0.5);
    largest_change = std::max(largest_change, std::abs(ratio / at_half - 1.0));
  }
  EXPECT_GT(largest_change, 0.1);
}

TEST(CutValue, ReversingTheCurveMirrorsTheBestCut) {
  std::mt19937 random(4);
  const Points points = RandomPoints(8, 2, &random);
  const Points reversed = points.colwise().reverse();
  for (const CutMeasure measure : {CutMeasure::kFlatness, CutMeasure::kHullArea}) {
    for (const double u : kPlaces) {
      EXPECT_NEAR(ValueAt(measure, reversed, 1.0 - u), ValueAt(measure, points, u),
                  30 * 16 * kEpsilon);
    }
  }
}

double SumOfPlainDistances(const Points& points, double u) {
  const auto n = static_cast<int>(points.rows()) - 1;
  Points parts[2] = {points, points};
  CutBezier(n, 2, u, points.data(), parts[0].data(), parts[1].data());
  double sum = 0.0;
  for (const Points& part : parts) {
    const Eigen::RowVector2d chord = (part.row(n) - part.row(0)).normalized();
    for (int i = 1; i < n; ++i) {
      const Eigen::RowVector2d v = part.row(i) - part.row(0);
      sum += std::abs(v[0] * chord[1] - v[1] * chord[0]);
    }
  }
  return sum;
}

// The paper's definition takes squares and its proof plain distances: of symmetric polygons both
// are even about 1/2, which is therefore stationary, and of triangles with equal legs the minimum.
TEST(CutValue, OfASymmetricPolygonTheMiddleIsStationary) {
  std::mt19937 random(5);
  for (const int degree : {2, 3, 4, 7}) {
    const Points points = SymmetricPoints(degree, &random);
    for (const double h : {0.01, 0.1, 0.3}) {
      for (const CutMeasure measure : {CutMeasure::kFlatness, CutMeasure::kHullArea}) {
        EXPECT_NEAR(ValueAt(measure, points, 0.5 - h), ValueAt(measure, points, 0.5 + h),
                    30 * 16 * kEpsilon);
      }
      EXPECT_NEAR(SumOfPlainDistances(points, 0.5 - h), SumOfPlainDistances(points, 0.5 + h),
                  100 * 16 * kEpsilon);
    }
  }
}

TEST(CutValue, OfATriangleWithEqualLegsTheMiddleIsBestBySquaresAndByPlainDistances) {
  for (const double height : {0.2, 1.0, 5.0}) {
    const Points points = PointsOf({{-1, 0}, {0, height}, {1, 0}});
    for (int k = 1; k < 100; ++k) {
      if (k == 50) continue;
      const double u = k / 100.0;
      EXPECT_GT(ValueAt(CutMeasure::kFlatness, points, u),
                ValueAt(CutMeasure::kFlatness, points, 0.5));
      EXPECT_GT(ValueAt(CutMeasure::kHullArea, points, u),
                ValueAt(CutMeasure::kHullArea, points, 0.5));
      EXPECT_GT(SumOfPlainDistances(points, u), SumOfPlainDistances(points, 0.5));
    }
  }
}

}  // namespace
}  // namespace batten
