#include "splines/bezier_conversion.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <string>
#include <vector>

#include "tests/splines/example_splines.h"

namespace batten {
namespace {

// Blossoms and the curve's own evaluation round some 4 (p + 1) times each, of numbers up to 1.
double BlossomTolerance(int degree) { return 4 * 8 * (degree + 1) * kEpsilon; }

class EverySpline : public ::testing::TestWithParam<SplineKind> {};
INSTANTIATE_TEST_SUITE_P(BezierConversion, EverySpline, ::testing::ValuesIn(AllSplineKinds()),
                         &NameOf);

TEST_P(EverySpline, ItsBezierSpansAreTheCurve) {
  std::mt19937 random(31);
  for (const BsplineBasis& basis : MakeBases(GetParam(), &random)) {
    const BsplineCurve curve(basis, RandomPoints(basis.num_control_points(), 2, &random));
    const std::vector<BezierSpan> spans = BezierSpansOf(curve);
    ASSERT_FALSE(spans.empty());
    EXPECT_EQ(spans.front().begin, basis.domain_begin());
    EXPECT_EQ(spans.back().end, basis.domain_end());
    const auto begin_of = [&spans](std::size_t i) {
      return spans[i].curve.control_points().row(0).eval();
    };
    const auto end_of = [&spans](std::size_t i) {
      return spans[i].curve.control_points().bottomRows(1).eval();
    };
    for (std::size_t i = 1; i < spans.size(); ++i) EXPECT_EQ(end_of(i - 1), begin_of(i));
    if (basis.periodic()) {
      EXPECT_EQ(end_of(spans.size() - 1), begin_of(0));
    }
    for (std::size_t i = 0; i < spans.size(); ++i) {
      EXPECT_TRUE(i == 0 || spans[i].begin == spans[i - 1].end);
      for (const double s : {0.0, 0.25, 0.5}) {
        double point[2], expected[2];
        spans[i].curve.Evaluate(s, point);
        curve.Evaluate(spans[i].begin + s * (spans[i].end - spans[i].begin), 0, expected);
        for (int c = 0; c < 2; ++c) {
          EXPECT_NEAR(point[c], expected[c], 8 * BlossomTolerance(basis.degree()));
        }
      }
    }
  }
}

TEST_P(EverySpline, ItComesBackFromItsBezierSpans) {
  std::mt19937 random(32);
  for (const BsplineBasis& basis : MakeBases(GetParam(), &random)) {
    const BsplineCurve curve(basis, RandomPoints(basis.num_control_points(), 2, &random));
    std::string error;
    const std::optional<BsplineCurve> back =
        BsplineThrough(BezierSpansOf(curve), basis.periodic(), &error);
    ASSERT_TRUE(back) << error;
    EXPECT_EQ(back->basis().periodic(), basis.periodic());
    EXPECT_EQ(back->basis().domain_begin(), basis.domain_begin());
    EXPECT_EQ(back->basis().domain_end(), basis.domain_end());
    for (int k = 0; k < 20; ++k) {
      const double t = RandomParameter(basis, &random);
      double point[2], expected[2];
      back->Evaluate(t, 0, point);
      curve.Evaluate(t, 0, expected);
      for (int c = 0; c < 2; ++c)
        EXPECT_NEAR(point[c], expected[c], 16 * BlossomTolerance(basis.degree()));
    }
  }
}

BezierSpan SpanOf(const std::vector<std::vector<double>>& rows, double begin, double end) {
  return {BezierCurve::Make(PointsOf(rows), nullptr).value(), begin, end};
}

TEST(BezierConversion, OneCurveBecomesTheSameControlPoints) {
  const BezierSpan span = SpanOf({{0, 0}, {1, 2}, {3, 1}}, 0, 1);
  const std::optional<BsplineCurve> curve = BsplineThrough({span}, false, nullptr);
  ASSERT_TRUE(curve);
  EXPECT_EQ(curve->control_points(), span.curve.control_points());
  EXPECT_EQ(curve->basis().knots(), std::vector<double>({0, 0, 0, 1, 1, 1}));
}

TEST(BezierConversion, LowerDegreesAreRaised) {
  const std::optional<BsplineCurve> curve = BsplineThrough(
      {SpanOf({{0, 0}, {2, 0}}, 0, 1), SpanOf({{2, 0}, {3, 0}, {3, 1}}, 1, 3)}, false, nullptr);
  ASSERT_TRUE(curve);
  EXPECT_EQ(curve->basis().degree(), 2);
  EXPECT_EQ(curve->control_points(), PointsOf({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 1}}));
}

TEST(BezierConversion, RefusesWhatDoesNotJoin) {
  std::string error;
  const BezierSpan line = SpanOf({{0, 0}, {1, 0}}, 0, 1);
  EXPECT_FALSE(BsplineThrough({}, false, &error));
  EXPECT_EQ(error, "found no Bezier curve; allowed: one or more");
  EXPECT_FALSE(BsplineThrough({line, SpanOf({{1.5, 0}, {2, 0}}, 1, 2)}, false, &error));
  EXPECT_EQ(error, "curve 0 does not end where the next begins");
  EXPECT_FALSE(BsplineThrough({line, SpanOf({{1, 0}, {2, 0}}, 1.5, 2)}, false, &error));
  EXPECT_EQ(error, "the interval of curve 0 does not lead to the next");
  EXPECT_FALSE(BsplineThrough({line}, true, &error));
  EXPECT_EQ(error, "curve 0 does not end where the next begins");
  EXPECT_FALSE(BsplineThrough({SpanOf({{1, 0}}, 0, 1)}, false, &error));
  EXPECT_EQ(error, "found degree 0; allowed in a B-spline curve: 1 to 9");
  EXPECT_FALSE(BsplineThrough({line, SpanOf({{1, 0, 0}, {2, 0, 0}}, 1, 2)}, false, &error));
  EXPECT_EQ(error, "curve 0 has another dimension than the next");
}

TEST(BezierConversion, TheLargestNumbersDoNotOverflow) {
  const double largest = std::numeric_limits<double>::max();
  for (int k = 1; k < 200; ++k) {
    const BsplineBasis basis =
        BsplineBasis::Make(2, false, {0, 0, 0, k / 201.0, k / 200.0, 1, 1, 1}, nullptr).value();
    const BsplineCurve curve(basis, PointsOf({{largest, 0},
                                              {largest, -largest},
                                              {largest, largest},
                                              {largest, -largest},
                                              {largest, 0}}));
    const std::vector<BezierSpan> spans = BezierSpansOf(curve);
    ASSERT_EQ(spans.size(), 3);
    for (const BezierSpan& span : spans) {
      EXPECT_LE((span.curve.control_points().col(0).array() / largest - 1.0).abs().maxCoeff(),
                4 * kEpsilon);
    }
  }
}

}  // namespace
}  // namespace batten
