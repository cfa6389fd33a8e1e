#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "solvers/cut_rule_registry.h"
#include "tests/splines/bezier_pieces.h"
#include "tests/splines/example_splines.h"

namespace batten {
namespace {

BezierCurve CurveOf(const Points& points) { return BezierCurve::Make(points, nullptr).value(); }

std::unique_ptr<CutRule> RuleNamed(const std::string& name) {
  NameSpec spec;
  std::string error;
  EXPECT_TRUE(ParseNameSpec(name, &spec, &error)) << error;
  std::unique_ptr<CutRule> rule = CutRuleRegistry::Global().Make(spec, nullptr, &error);
  EXPECT_NE(rule, nullptr) << error;
  return rule;
}

std::string RefusalOf(const std::string& name) {
  NameSpec spec;
  std::string error;
  EXPECT_TRUE(ParseNameSpec(name, &spec, &error)) << error;
  EXPECT_EQ(CutRuleRegistry::Global().Make(spec, nullptr, &error), nullptr);
  return error;
}

Subdivision SubdividedBy(const std::string& name, const BezierCurve& curve,
                         const SubdivisionOptions& options) {
  Subdivision result;
  std::string error;
  EXPECT_TRUE(SubdivideBy(RuleNamed(name).get(), curve, options, &result, &error)) << error;
  return result;
}

class EveryCutRule : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Registry, EveryCutRule,
                         ::testing::ValuesIn(CutRuleRegistry::Global().Names()));

TEST_P(EveryCutRule, SaysWhatItIs) {
  const CutRuleInfo info = RuleNamed(GetParam())->Info();
  EXPECT_EQ(info.name, GetParam());
  EXPECT_FALSE(info.summary.empty());
  EXPECT_FALSE(info.source.empty());
}

TEST_P(EveryCutRule, EveryPieceOfItsResultPassesAndTheTrueErrorIsCertified) {
  std::mt19937 random(41);
  for (const std::string& stop : StopMeasureNames()) {
    for (const SubdivisionMode mode : {SubdivisionMode::kAdaptive, SubdivisionMode::kUniform}) {
      for (const int degree : {2, 3, 8, 17}) {
        const BezierCurve curve = CurveOf(RandomPoints(degree + 1, 2, &random));
        SubdivisionOptions options;
        ASSERT_TRUE(FromString(stop, &options.stop));
        options.mode = mode;
        options.relative_tolerance = options.stop == StopMeasure::kAngle ? 0.3 : 1e-4;
        options.max_pieces = 1 << 16;
        options.keep_pieces = true;
        if (!RuleNamed(GetParam())->WhyUnsupported(curve, options).empty()) continue;
        const Subdivision result = SubdividedBy(GetParam(), curve, options);
        EXPECT_EQ(result.end, SubdivisionEnd::kAllPass) << stop << ": " << result.message;
        EXPECT_EQ(result.num_failing, 0);
        ExpectCovers(result, degree);
        ExpectPiecesPass(curve, options, result);
        if (options.stop != StopMeasure::kSegment && options.stop != StopMeasure::kPolygon) {
          continue;
        }
        ExpectErrorWithin(1e-4, curve, result);
      }
    }
  }
}

// Chains of cuts, which are computed afresh after 32, came to 12 roundings, halvings to 5.
TEST_P(EveryCutRule, ItsPiecesOfDegree25AreTheCurveToSixteenRoundings) {
  std::mt19937 random(49);
  SubdivisionOptions options;
  options.keep_pieces = true;
  options.relative_tolerance = 1e-4;
  for (const SubdivisionMode mode : {SubdivisionMode::kAdaptive, SubdivisionMode::kUniform}) {
    options.mode = mode;
    for (const int dimension : {2, 3}) {
      const BezierCurve curve = CurveOf(RandomPoints(26, dimension, &random));
      if (!RuleNamed(GetParam())->WhyUnsupported(curve, options).empty()) continue;
      constexpr double kRoundings = 16;
      ExpectPiecesAreTheCurve(curve, SubdividedBy(GetParam(), curve, options), kRoundings);
    }
  }
}

TEST_P(EveryCutRule, DegenerateCurvesEndTooAndAreNamedWhereRefused) {
  for (const DegenerateCurve& degenerate : kDegenerateCurves) {
    const BezierCurve curve = CurveOf(PointsOf(degenerate.points));
    for (const std::string& stop : StopMeasureNames()) {
      for (const double tolerance : {1e-3, 0.0}) {
        SCOPED_TRACE(std::string(degenerate.name) + ", " + stop);
        SubdivisionOptions options;
        FromString(stop, &options.stop);
        options.relative_tolerance = tolerance;
        options.max_pieces = 2000;
        const bool is_planar = curve.dimension() == 2;
        if (!is_planar && (GetParam() == "hull" || options.stop == StopMeasure::kHullArea)) {
          Subdivision result;
          std::string error;
          EXPECT_FALSE(SubdivideBy(RuleNamed(GetParam()).get(), curve, options, &result, &error));
          EXPECT_NE(error.find("needs a planar curve; found 3 coordinates, use "),
                    std::string::npos)
              << error;
          continue;
        }
        const Subdivision result = SubdividedBy(GetParam(), curve, options);
        EXPECT_NE(result.end, SubdivisionEnd::kNotRun);
        EXPECT_LE(result.num_pieces(), 2000);
        EXPECT_TRUE(result.vertices.allFinite());
        ExpectCovers(result, curve.degree());
        EXPECT_EQ(result.end == SubdivisionEnd::kAllPass, result.num_failing == 0);
        if (result.num_failing > 0) {
          EXPECT_NE(result.message, "");
        } else if (options.stop == StopMeasure::kPolygon) {
          ExpectErrorWithin(tolerance, curve, result);
        }
      }
    }
  }
}

TEST_P(EveryCutRule, ABoundOnPiecesLeavesNoStretchCoarse) {
  // A parabola bends evenly, so that equal pieces are best.
  SubdivisionOptions options;
  options.relative_tolerance = 1e-9;
  options.max_pieces = 64;
  const Subdivision result =
      SubdividedBy(GetParam(), CurveOf(PointsOf({{0, 0}, {1, 2}, {2, 0}})), options);
  ASSERT_EQ(result.num_pieces(), 64);
  for (int i = 0; i <= 64; ++i) EXPECT_EQ(result.parameters[i], i / 64.0);
  EXPECT_EQ(result.message, "64 of 64 pieces do not pass: the bound of 64 pieces was hit");
}

TEST_P(EveryCutRule, ScalingByAPowerOfTwoChangesNoCut) {
  std::mt19937 random(42);
  const Points points = RandomPoints(9, 2, &random);
  const SubdivisionOptions options;
  EXPECT_EQ(SubdividedBy(GetParam(), CurveOf(points), options).parameters,
            SubdividedBy(GetParam(), CurveOf(points * 0x1p-50), options).parameters);
}

TEST_P(EveryCutRule, TheSameCurveTwiceGivesTheSameCuts) {
  std::mt19937 random(43);
  const BezierCurve curve = CurveOf(RandomPoints(9, 2, &random));
  const std::unique_ptr<CutRule> rule = RuleNamed(GetParam());
  Subdivision first, second;
  std::string error;
  ASSERT_TRUE(SubdivideBy(rule.get(), curve, SubdivisionOptions(), &first, &error));
  ASSERT_TRUE(SubdivideBy(rule.get(), CurveOf(RandomPoints(5, 2, &random)), SubdivisionOptions(),
                          &second, &error));
  ASSERT_TRUE(SubdivideBy(rule.get(), curve, SubdivisionOptions(), &second, &error));
  EXPECT_EQ(first.parameters, second.parameters);
}

// Ratio of pieces to those of halving, the median of some curves.
double MedianRatio(const std::string& rule, int degree, std::mt19937* random) {
  std::vector<double> ratios;
  for (int k = 0; k < 21; ++k) {
    const BezierCurve curve = CurveOf(RandomPoints(degree + 1, 2, random));
    ratios.push_back(SubdividedBy(rule, curve, SubdivisionOptions()).num_pieces() * 1.0 /
                     SubdividedBy("half", curve, SubdivisionOptions()).num_pieces());
  }
  std::nth_element(ratios.begin(), ratios.begin() + 10, ratios.end());
  return ratios[10];
}

TEST(LongestCutRule, NeedsAQuarterFewerPiecesThanHalving) {
  std::mt19937 random(44);
  for (const int degree : {2, 3, 5, 12, 25}) {
    EXPECT_LT(MedianRatio("longest", degree, &random), 0.75) << degree;
  }
}

TEST(LongestCutRule, ComesWithinThreePercentOfTheFewestPieces) {
  // With every first part at 0.9999 of the longest or more, a piece is one that cannot be longer.
  std::mt19937 random(45);
  for (const int degree : {3, 12, 25}) {
    int fewest = 0, found = 0;
    for (int k = 0; k < 10; ++k) {
      const BezierCurve curve = CurveOf(RandomPoints(degree + 1, 2, &random));
      fewest +=
          SubdividedBy("longest/least=0.9999/aim=0.99995/trials=60", curve, SubdivisionOptions())
              .num_pieces();
      found += SubdividedBy("longest", curve, SubdivisionOptions()).num_pieces();
    }
    EXPECT_GE(found, fewest);
    EXPECT_LE(found, 1.03 * fewest) << degree;
  }
}

TEST(LongestCutRule, RefusesUniformRounds) {
  SubdivisionOptions options;
  options.mode = SubdivisionMode::kUniform;
  Subdivision result;
  std::string error;
  EXPECT_FALSE(SubdivideBy(RuleNamed("longest").get(), CurveOf(PointsOf({{0, 0}, {1, 2}, {2, 0}})),
                           options, &result, &error));
  EXPECT_EQ(error,
            "longest takes one piece after the other; in uniform rounds use half, flatness or "
            "share");
}

TEST(HullCutRule, RefusesCurvesInSpace) {
  Subdivision result;
  std::string error;
  EXPECT_FALSE(SubdivideBy(RuleNamed("hull").get(), CurveOf(PointsOf({{0, 0, 0}, {1, 2, 1}})),
                           SubdivisionOptions(), &result, &error));
  EXPECT_EQ(error, "hull needs a planar curve; found 3 coordinates, use flatness");
}

TEST(BestCutRule, WithoutRoundsItHalves) {
  std::mt19937 random(46);
  const BezierCurve curve = CurveOf(RandomPoints(9, 2, &random));
  for (const char* rule : {"flatness/rounds=0", "hull/rounds=0"}) {
    EXPECT_EQ(SubdividedBy(rule, curve, SubdivisionOptions()).parameters,
              SubdividedBy("half", curve, SubdivisionOptions()).parameters);
  }
}

TEST(BestCutRule, CountsTheCutsOfItsSearch) {
  // One round of 13 values; the rest is halving: pieces - 1 cuts.
  std::mt19937 random(47);
  const BezierCurve curve = CurveOf(RandomPoints(9, 2, &random));
  const Subdivision result = SubdividedBy("flatness/rounds=1", curve, SubdivisionOptions());
  EXPECT_EQ(result.cuts, result.num_pieces() - 1 + 13);
}

TEST(ShareCutRule, NeedsAboutARoundLessThanHalvingAtDegree12) {
  std::mt19937 random(48);
  SubdivisionOptions options;
  options.mode = SubdivisionMode::kUniform;
  constexpr int kCurves = 20;
  int rounds = 0, rounds_of_half = 0;
  for (int k = 0; k < kCurves; ++k) {
    const BezierCurve curve = CurveOf(RandomPoints(13, 2, &random));
    rounds += SubdividedBy("share", curve, options).rounds;
    rounds_of_half += SubdividedBy("half", curve, options).rounds;
  }
  EXPECT_LE(rounds + kCurves / 2, rounds_of_half);
}

TEST(CutRuleRegistry, AnswersUnknownNamesAndOptionsWithKnownOnes) {
  EXPECT_EQ(RefusalOf("flatnes"),
            "unknown cut rule \"flatnes\"; did you mean flatness? known: flatness, half, hull, "
            "longest, share");
  EXPECT_NE(RefusalOf("flatness/round=2").find("rounds"), std::string::npos);
  EXPECT_EQ(RefusalOf("half:hull"), "half wraps nothing; found :hull");
}

}  // namespace
}  // namespace batten
