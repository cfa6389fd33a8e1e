#include "splines/bezier_measures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "splines/bezier_hull.h"
#include "tests/splines/example_splines.h"

namespace batten {
namespace {

double Value(const Quotient& quotient) { return quotient.numerator / quotient.denominator; }

TEST(BezierMeasures, DistancesFromTheChordAreThoseOfTheInnerPoints) {
  // Distances 3 and 1 from the x axis; the second lies beyond the chord's end.
  const Points points = PointsOf({{0, 0}, {1, 3}, {9, -1}, {4, 0}});
  EXPECT_EQ(Value(SquaredChordDistance(3, 2, points.data())), 9.0);
  EXPECT_EQ(Value(Flatness(3, 2, points.data())), 10.0);
  EXPECT_TRUE(IsNearChord(3, 2, points.data(), 9.0));
  EXPECT_FALSE(IsNearChord(3, 2, points.data(), 8.99));
}

TEST(BezierMeasures, BeyondTheChordsEndsThePolygonIsFartherThanFromItsLine) {
  // (9, -1) is 5 beside and 1 below the end (4, 0); (-2, 0) is 2 before the begin.
  const Points points = PointsOf({{0, 0}, {1, 3}, {9, -1}, {-2, 0}, {4, 0}});
  EXPECT_EQ(Value(SquaredPolygonDistance(4, 2, points.data())), 26.0);
  EXPECT_TRUE(IsNearSegment(4, 2, points.data(), 26.0));
  EXPECT_FALSE(IsNearSegment(4, 2, points.data(), 25.9));
  const Points before = PointsOf({{0, 0}, {-2, 0}, {1, 0}, {4, 0}});
  EXPECT_EQ(Value(SquaredPolygonDistance(3, 2, before.data())), 4.0);
  const Points closed = PointsOf({{1, 1}, {4, 5}, {1, 1}});
  EXPECT_EQ(Value(SquaredPolygonDistance(2, 2, closed.data())), 25.0);
  EXPECT_FALSE(IsNearSegment(3, 2, before.data(), 3.9));
  EXPECT_TRUE(IsNearChord(3, 2, before.data(), 0.0));
}

TEST(BezierMeasures, DistancesInSpaceAreThoseFromTheLine) {
  const Points points = PointsOf({{0, 0, 0}, {1, 3, 4}, {2, 0, 0}});
  EXPECT_EQ(Value(SquaredChordDistance(2, 3, points.data())), 25.0);
  EXPECT_EQ(Value(Flatness(2, 3, points.data())), 25.0);
}

TEST(BezierMeasures, WhereTheChordIsZeroDistancesAreThoseFromThePoint) {
  const Points points = PointsOf({{1, 1}, {4, 5}, {1, 3}, {1, 1}});
  EXPECT_EQ(Value(SquaredChordDistance(3, 2, points.data())), 25.0);
  EXPECT_EQ(Value(Flatness(3, 2, points.data())), 29.0);
  EXPECT_FALSE(IsNearChord(3, 2, points.data(), 24.0));
  EXPECT_TRUE(IsNearChord(3, 2, points.data(), 25.0));
}

TEST(BezierMeasures, DegreesZeroAndOneHaveNoInnerPoint) {
  const Points points = PointsOf({{0, 0}, {1, 3}});
  EXPECT_EQ(Flatness(1, 2, points.data()).numerator, 0.0);
  EXPECT_EQ(Flatness(0, 2, points.data()).numerator, 0.0);
  EXPECT_EQ(HullArea(1, points.data()), 0.0);
  EXPECT_EQ(HullArea(0, points.data()), 0.0);
  EXPECT_EQ(SquaredLegSlope(0, 2, points.data(), 0.0), 0.0);
}

// from scipy.spatial import ConvexHull
// ConvexHull([((i * 37) % 101, (i * 53) % 97) for i in range(26)]).volume, and for range(9)
TEST(BezierMeasures, HullAreaAgreesWithSciPy) {
  Points points(26, 2);
  for (int i = 0; i < 26; ++i) points.row(i) << (i * 37) % 101, (i * 53) % 97;
  EXPECT_EQ(HullArea(25, points.data()), 6206.5);  // sums of integers: exact
  EXPECT_EQ(HullArea(8, points.data()), 5437.5);
}

TEST(BezierMeasures, HullAreaIgnoresRepeatedCollinearAndInnerPoints) {
  const Points square = PointsOf({{0, 0}, {2, 0}, {2, 2}, {0, 2}, {1, 1}, {1, 0}, {2, 2}, {0, 0}});
  EXPECT_EQ(HullArea(7, square.data()), 4.0);
  const Points line = PointsOf({{0, 0}, {3, 6}, {1, 2}, {2, 4}});
  EXPECT_EQ(HullArea(3, line.data()), 0.0);
  const Points point = PointsOf({{5, 5}, {5, 5}, {5, 5}});
  EXPECT_EQ(HullArea(2, point.data()), 0.0);
}

TEST(BezierMeasures, LegsAreComparedWithTheChord) {
  // Legs (1, 1), (1, 0), (1, -1) along (3, 0): 45 degrees at most.
  const Points points = PointsOf({{0, 0}, {1, 1}, {2, 1}, {3, 0}});
  EXPECT_EQ(SquaredLegSlope(3, 2, points.data(), 0.0), 1.0);
  const Points repeated = PointsOf({{0, 0}, {0, 0}, {1, 1}, {2, 2}});
  EXPECT_EQ(SquaredLegSlope(3, 2, repeated.data(), 0.0), 0.0);
  const Points back = PointsOf({{0, 0}, {2, 0}, {1, 0}});
  EXPECT_TRUE(std::isinf(SquaredLegSlope(2, 2, back.data(), 0.0)));
  const Points closed = PointsOf({{0, 0}, {1, 0}, {0, 0}});
  EXPECT_TRUE(std::isinf(SquaredLegSlope(2, 2, closed.data(), 0.0)));
  // What is no longer than rounding has no direction, and no offset.
  const Points nearly = PointsOf({{0, 0}, {1, 1e-9}, {1 - 1e-9, 1e-9}, {2, 0}});
  EXPECT_TRUE(std::isinf(SquaredLegSlope(3, 2, nearly.data(), 0.0)));
  EXPECT_EQ(SquaredLegSlope(3, 2, nearly.data(), 2e-9), 0.0);
}

TEST(BezierMeasures, DistanceFromASegmentEndsAtItsEnds) {
  const double a[] = {0, 0}, b[] = {4, 0};
  const double beside[] = {1, 2}, before[] = {-3, 4}, beyond[] = {7, 4};
  EXPECT_EQ(SquaredSegmentDistance(2, beside, a, b), 4.0);
  EXPECT_EQ(SquaredSegmentDistance(2, before, a, b), 25.0);
  EXPECT_EQ(SquaredSegmentDistance(2, beyond, a, b), 25.0);
  EXPECT_EQ(SquaredSegmentDistance(2, beside, a, a), 5.0);
}

TEST(BezierMeasures, TurningAndScalingChangesThemAccordingly) {
  std::mt19937 random(4);
  const Points points = RandomPoints(9, 2, &random);
  Eigen::Matrix2d turn;
  turn << 0.6, -0.8, 0.8, 0.6;
  const Points turned = 4.0 * points * turn.transpose();
  // Some ten roundings of numbers up to 8, squared.
  const double tolerance = 10 * 64 * kEpsilon;
  EXPECT_NEAR(Value(Flatness(8, 2, turned.data())), 16 * Value(Flatness(8, 2, points.data())),
              8 * tolerance);
  EXPECT_NEAR(HullArea(8, turned.data()), 16 * HullArea(8, points.data()), tolerance);
}

}  // namespace
}  // namespace batten
