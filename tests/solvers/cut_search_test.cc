#include "solvers/cut_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/splines/example_splines.h"

namespace batten {
namespace {

// Where the value's second derivative is about one, a place is known to the root of its rounding.
constexpr double kPlaceTolerance = 1e-6;

TEST(CutSearch, FindsTheMiddleOfAParabola) {
  const Points points = PointsOf({{0, 0}, {1, 2}, {2, 0}});
  for (const CutMeasure measure : {CutMeasure::kFlatness, CutMeasure::kHullArea}) {
    CutValue value(measure, 2, 2, points.data());
    EXPECT_NEAR(ExactMinimum(&value).u, 0.5, kPlaceTolerance);
    EXPECT_NEAR(GridMinimum(&value).u, 0.5, kEpsilon);
  }
  // Hulls of u^3 and (1 - u)^3 of the area 2, so 2 / 4 at the middle.
  CutValue value(CutMeasure::kHullArea, 2, 2, points.data());
  EXPECT_NEAR(ExactMinimum(&value).value, 0.5, 16 * kEpsilon);
}

TEST(CutSearch, TheGridHas13ValuesFromAFifthToFourFifths) {
  // A parabola with one short leg: the best cut is where the curve bends, near an end.
  const Points points = PointsOf({{0, 0}, {0.1, 2}, {40, 0}});
  CutValue value(CutMeasure::kFlatness, 2, 2, points.data());
  const CutPlace best = GridMinimum(&value);
  EXPECT_EQ(value.num_evaluations(), 13);
  for (int k = 0; k <= 12; ++k) EXPECT_LE(best.value, value(0.2 + 0.05 * k) * (1.0 + 1e-12));
}

TEST(CutSearch, FindsEveryMinimumThatADenseScanSees) {
  std::mt19937 random(17);
  constexpr int kSteps = 20000;
  for (const CutMeasure measure : {CutMeasure::kFlatness, CutMeasure::kHullArea}) {
    for (const int degree : {3, 5, 9, 16, 25}) {
      const Points points = RandomPoints(degree + 1, 2, &random);
      CutValue value(measure, degree, 2, points.data());
      const std::vector<CutPlace> minima = AllMinima(&value);
      ASSERT_FALSE(minima.empty());
      double before = value(1.0 / 64), here = before, least = before;
      for (int k = 1; k <= kSteps; ++k) {
        const double u = 1.0 / 64 + (62.0 / 64) * k / kSteps;
        const double after = value(u);
        least = std::min(least, after);
        // Dips of less than 1e-9 are below what panels agree to.
        if (k > 1 && here < before - 1e-9 && here < after - 1e-9) {
          const double u_here = u - (62.0 / 64) / kSteps;
          const bool is_found =
              std::any_of(minima.begin(), minima.end(), [u_here](const CutPlace& place) {
                return std::abs(place.u - u_here) < 2.0 / kSteps;
              });
          EXPECT_TRUE(is_found) << ToString(measure) << " degree " << degree << " at " << u_here;
        }
        before = here;
        here = after;
      }
      EXPECT_LE(ExactMinimum(&value).value, least + 1e-9);
      EXPECT_LE(ExactMinimum(&value).value, GridMinimum(&value).value);
    }
  }
}

TEST(CutSearch, AConstantValueHasAMinimumToo) {
  const Points line = PointsOf({{0, 0}, {1, 1}, {2, 2}, {3, 3}});
  for (const CutMeasure measure : {CutMeasure::kFlatness, CutMeasure::kHullArea}) {
    CutValue value(measure, 3, 2, line.data());
    const CutPlace best = ExactMinimum(&value);
    EXPECT_GT(best.u, 0.0);
    EXPECT_LT(best.u, 1.0);
    EXPECT_NEAR(best.value, 0.0, kEpsilon);
  }
}

}  // namespace
}  // namespace batten
