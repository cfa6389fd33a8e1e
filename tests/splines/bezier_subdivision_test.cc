#include "splines/bezier_subdivision.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/splines/bezier_pieces.h"
#include "tests/splines/example_splines.h"

namespace batten {
namespace {

Subdivision Subdivided(const BezierCurve& curve, const CutChoice& rule,
                       const SubdivisionOptions& options) {
  Subdivision result;
  std::string error;
  EXPECT_TRUE(Subdivide(curve, rule, options, &result, &error)) << error;
  return result;
}

using PlainRule = double (*)(CutTrial*);

double CutAtThird(CutTrial* /*trial*/) { return 1.0 / 3.0; }

/// Takes short first parts off one after the other: the longest chain of cuts there is.
double TakeShortFirst(CutTrial* trial) {
  const double u = 0.003 / (trial->end() - trial->begin());
  if (u >= 0.5) return 0.5;
  trial->Try(u);
  return u;
}

TEST(BezierSubdivision, PiecesOfDegree25AreTheCurveToSixteenRoundings) {
  std::mt19937 random(25);
  SubdivisionOptions options;
  options.keep_pieces = true;
  options.relative_tolerance = 1e-4;
  for (const SubdivisionMode mode : {SubdivisionMode::kAdaptive, SubdivisionMode::kUniform}) {
    options.mode = mode;
    for (PlainRule rule : {&CutAtHalf, &CutAtThird, &TakeShortFirst}) {
      if (mode == SubdivisionMode::kUniform && rule == &TakeShortFirst) continue;
      for (const int dimension : {2, 3}) {
        const BezierCurve curve = CurveOf(RandomPoints(26, dimension, &random));
        const Subdivision result = Subdivided(curve, rule, options);
        EXPECT_EQ(result.end, SubdivisionEnd::kAllPass);
        // Ten levels and more, 25 steps each: errors are averaged as points are. Chains, which are
        // computed afresh after 32 cuts, came to 12, halvings to 5.
        constexpr double kRoundings = 16;
        ExpectPiecesAreTheCurve(curve, result, kRoundings);
      }
    }
  }
}

TEST(BezierSubdivision, PiecesCoverTheIntervalWithoutGap) {
  std::mt19937 random(26);
  SubdivisionOptions options;
  options.keep_pieces = true;
  for (PlainRule rule : {&CutAtHalf, &CutAtThird, &TakeShortFirst}) {
    const BezierCurve curve = CurveOf(RandomPoints(8, 2, &random));
    const Subdivision result = Subdivided(curve, rule, options);
    ExpectCovers(result, 7);
  }
}

TEST(BezierSubdivision, AParabolaIsHalvedAsOftenAsItsSecondDifferenceSays) {
  // The inner control point of each of 2^r equal parts is at 2 / 4^r from its chord, or nearer, and
  // L = 2: rounds until 1 / 4^r <= 1e-3, r = 5.
  const BezierCurve curve = CurveOf(PointsOf({{0, 0}, {1, 2}, {2, 0}}));
  SubdivisionOptions options;
  options.relative_tolerance = 1e-3;
  options.mode = SubdivisionMode::kUniform;
  const Subdivision result = Subdivided(curve, &CutAtHalf, options);
  EXPECT_EQ(result.rounds, 5);
  EXPECT_EQ(result.num_pieces(), 32);
  EXPECT_EQ(result.cuts, 31);
  // Five rounds have a piece that fails, the first one, and then all pass.
  EXPECT_EQ(result.evaluations, 5 + 32);
}

TEST(BezierSubdivision, AdaptivePiecesAreThoseThatFailedHalved) {
  std::mt19937 random(27);
  const BezierCurve curve = CurveOf(RandomPoints(10, 2, &random));
  SubdivisionOptions options;
  const Subdivision adaptive = Subdivided(curve, &CutAtHalf, options);
  options.mode = SubdivisionMode::kUniform;
  const Subdivision uniform = Subdivided(curve, &CutAtHalf, options);
  EXPECT_LT(adaptive.num_pieces(), uniform.num_pieces());
  EXPECT_EQ(adaptive.rounds, uniform.rounds);
  EXPECT_EQ(uniform.num_pieces(), 1 << uniform.rounds);
  EXPECT_EQ(adaptive.cuts, adaptive.num_pieces() - 1);
}

class EveryStop : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(BezierSubdivision, EveryStop, ::testing::ValuesIn(StopMeasureNames()));

TEST_P(EveryStop, EveryPieceOfTheResultPasses) {
  SubdivisionOptions options;
  ASSERT_TRUE(FromString(GetParam(), &options.stop));
  EXPECT_EQ(ToString(options.stop), GetParam());
  options.relative_tolerance = options.stop == StopMeasure::kAngle ? 0.02 : 1e-4;
  std::mt19937 random(28);
  for (PlainRule rule : {&CutAtHalf, &TakeShortFirst}) {
    const BezierCurve curve = CurveOf(RandomPoints(7, 2, &random));
    const Subdivision result = Subdivided(curve, rule, options);
    EXPECT_EQ(result.end, SubdivisionEnd::kAllPass);
    EXPECT_EQ(result.num_failing, 0);
    ExpectPiecesPass(curve, options, result);
  }
}

TEST(BezierSubdivision, TheTrueErrorStaysBelowTheToleranceOfTheSegmentRules) {
  std::mt19937 random(29);
  SubdivisionOptions options;
  for (const StopMeasure stop : {StopMeasure::kSegment, StopMeasure::kPolygon}) {
    options.stop = stop;
    for (const int degree : {2, 5, 16}) {
      const BezierCurve curve = CurveOf(RandomPoints(degree + 1, 2, &random));
      const Subdivision result = Subdivided(curve, &CutAtHalf, options);
      ExpectErrorWithin(1e-5, curve, result);
    }
  }
}

TEST(BezierSubdivision, OnlyTheSegmentRulesSeeOvershootOnALine) {
  const BezierCurve curve = CurveOf(PointsOf({{0, 0}, {4, 0}, {-3, 0}, {1, 0}}));
  SubdivisionOptions options;
  options.stop = StopMeasure::kControlPoints;
  EXPECT_EQ(Subdivided(curve, &CutAtHalf, options).num_pieces(), 1);
  for (const StopMeasure stop : {StopMeasure::kSegment, StopMeasure::kPolygon}) {
    options.stop = stop;
    const Subdivision result = Subdivided(curve, &CutAtHalf, options);
    EXPECT_GT(result.num_pieces(), 2);
    ExpectErrorWithin(1e-5, curve, result);
  }
}

TEST(BezierSubdivision, TheDefaultStopKeepsItsTolerance) {
  std::mt19937 random(33);
  const SubdivisionOptions options;
  std::vector<Points> cases = {PointsOf({{0, 0}, {4, 0}, {-3, 0}, {1, 0}}),
                               PointsOf({{0, 0}, {4, 1e-7}, {-3, 0}, {1, 0}})};
  for (const int degree : {3, 9, 20}) cases.push_back(RandomPoints(degree + 1, 2, &random));
  for (const Points& points : cases) {
    const BezierCurve curve = CurveOf(points);
    ExpectErrorWithin(options.relative_tolerance, curve, Subdivided(curve, &CutAtHalf, options));
  }
}

TEST(BezierSubdivision, NoRuleIsTheRuleThatHalves) {
  std::mt19937 random(34);
  for (const int degree : {1, 2, 3, 7, 25}) {
    for (const int dimension : {1, 2, 3, 4}) {
      for (const SubdivisionMode mode : {SubdivisionMode::kAdaptive, SubdivisionMode::kUniform}) {
        const BezierCurve curve = CurveOf(RandomPoints(degree + 1, dimension, &random));
        SubdivisionOptions options;
        options.mode = mode;
        options.keep_pieces = true;
        options.relative_tolerance = 1e-3;
        const Subdivision by_rule = Subdivided(curve, &CutAtHalf, options);
        const Subdivision without = Subdivided(curve, CutChoice(), options);
        EXPECT_EQ(without.parameters, by_rule.parameters);
        EXPECT_EQ(without.vertices, by_rule.vertices);
        EXPECT_EQ(without.pieces, by_rule.pieces);
        EXPECT_EQ(without.cuts, by_rule.cuts);
        EXPECT_EQ(without.evaluations, by_rule.evaluations);
        EXPECT_EQ(without.rounds, by_rule.rounds);
      }
    }
  }
}

TEST(BezierSubdivision, ScalingByAPowerOfTwoChangesNoParameter) {
  std::mt19937 random(30);
  const Points points = RandomPoints(12, 2, &random);
  const SubdivisionOptions options;
  const Subdivision result = Subdivided(CurveOf(points), &CutAtHalf, options);
  for (const int exponent : {-990, -40, 7, 1000}) {
    const Subdivision scaled =
        Subdivided(CurveOf(points * std::ldexp(1.0, exponent)), &CutAtHalf, options);
    EXPECT_EQ(scaled.parameters, result.parameters);
    EXPECT_EQ(scaled.vertices, result.vertices * std::ldexp(1.0, exponent));
  }
}

TEST(BezierSubdivision, APartIsJudgedByTheSizeOfTheWhole) {
  const BezierCurve curve = CurveOf(PointsOf({{0, 0}, {1, 2}, {2, 0}}));
  SubdivisionOptions options;
  options.reference_size = 200.0;
  const Subdivision part = Subdivided(curve, &CutAtHalf, options);
  options.reference_size = 0.0;
  options.relative_tolerance = 1e-3;
  EXPECT_EQ(part.parameters, Subdivided(curve, &CutAtHalf, options).parameters);
}

TEST(BezierSubdivision, ARuleOutsideItsIntervalIsOurBug) {
  const BezierCurve curve = CurveOf(PointsOf({{0, 0}, {1, 2}, {2, 0}}));
  Subdivision result;
  for (const double u : {0.0, 1.0, -0.5, std::nan("")}) {
    EXPECT_THROW(Subdivide(
                     curve, [u](CutTrial*) { return u; }, SubdivisionOptions(), &result, nullptr),
                 std::logic_error);
  }
}

TEST(BezierSubdivision, RefusesOptionsOutsideTheirRanges) {
  const auto refusal = [](SubdivisionOptions options) {
    std::string error;
    EXPECT_FALSE(options.IsValid(&error));
    return error;
  };
  SubdivisionOptions options;
  options.relative_tolerance = -1.0;
  EXPECT_EQ(refusal(options), "relative_tolerance is -1.000000, must be >= 0 and finite");
  options.relative_tolerance = std::nan("");
  EXPECT_EQ(refusal(options), "relative_tolerance is nan, must be >= 0 and finite");
  options.relative_tolerance = 1.6;
  options.stop = StopMeasure::kAngle;
  EXPECT_EQ(refusal(options), "relative_tolerance is 1.600000, must be in [0, pi / 2)");
  options = SubdivisionOptions();
  options.max_depth = 51;
  EXPECT_EQ(refusal(options), "max_depth is 51.000000, must be in [1, 50]");
  options = SubdivisionOptions();
  options.max_pieces = 0;
  EXPECT_EQ(refusal(options), "max_pieces is 0.000000, must be in [1, 16777216]");
}

TEST(BezierSubdivision, RefusesHullAreaInSpace) {
  const BezierCurve curve = CurveOf(PointsOf({{0, 0, 0}, {1, 2, 0}, {2, 0, 1}}));
  SubdivisionOptions options;
  options.stop = StopMeasure::kHullArea;
  Subdivision result;
  std::string error;
  EXPECT_FALSE(Subdivide(curve, &CutAtHalf, options, &result, &error));
  EXPECT_EQ(error, "a stop by hull area needs a planar curve; found 3 coordinates, use polygon");
}

}  // namespace
}  // namespace batten
