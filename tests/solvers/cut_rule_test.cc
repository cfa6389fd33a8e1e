#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "solvers/cut_rule_registry.h"
#include "splines/bezier_distance.h"
#include "splines/bezier_measures.h"
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

double TrueError(const BezierCurve& curve, const Subdivision& result) {
  return BoundHausdorffDistance(
             curve,
             Eigen::Map<const Eigen::VectorXd>(result.parameters.data(),
                                               static_cast<Eigen::Index>(result.parameters.size())),
             result.vertices)
      .upper;
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
        if (!RuleNamed(GetParam())->WhyUnsupported(curve, options).empty()) continue;
        const Subdivision result = SubdividedBy(GetParam(), curve, options);
        EXPECT_EQ(result.end, SubdivisionEnd::kAllPass) << stop << ": " << result.message;
        EXPECT_EQ(result.num_failing, 0);
        EXPECT_EQ(result.parameters.front(), 0.0);
        EXPECT_EQ(result.parameters.back(), 1.0);
        EXPECT_TRUE(std::is_sorted(result.parameters.begin(), result.parameters.end()));
        if (options.stop != StopMeasure::kSegment && options.stop != StopMeasure::kPolygon) {
          continue;
        }
        const double* p = curve.control_points().data();
        EXPECT_LE(TrueError(curve, result),
                  1e-4 * BoxSide(degree, 2, p) + 2 * BezierRounding(degree, 2, p));
      }
    }
  }
}

TEST_P(EveryCutRule, DegenerateCurvesEndTooAndAreNamedWhereRefused) {
  const std::vector<Points> cases = {
      PointsOf({{3, 4}}),
      PointsOf({{3, 4}, {5, 6}}),
      PointsOf({{3, 4}, {3, 4}, {3, 4}}),
      PointsOf({{0, 0}, {3, 1}, {-2, 4}, {0, 0}}),
      PointsOf({{0, 0}, {1, 1}, {0, 0}}),
      PointsOf({{0, 0}, {9, 9}, {-5, -5}, {4, 4}}),
      PointsOf({{0, 0}, {1, 1}, {0, 1}, {1, 0}}),
      PointsOf({{0, 0}, {0, 0}, {0, 0}, {1, 2}, {3, 1}, {3, 1}}),
      PointsOf({{0, 0}, {1e300, 1e300}, {1e300, -1e300}, {-1e300, 5e299}}),
      PointsOf({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 1}}),
  };
  for (const Points& points : cases) {
    for (const std::string& stop : StopMeasureNames()) {
      for (const double tolerance : {1e-3, 0.0}) {
        SubdivisionOptions options;
        FromString(stop, &options.stop);
        if (points.cols() != 2 && options.stop == StopMeasure::kHullArea) continue;
        options.relative_tolerance = tolerance;
        options.max_pieces = 2000;
        const BezierCurve curve = CurveOf(points);
        if (!RuleNamed(GetParam())->WhyUnsupported(curve, options).empty()) continue;
        const Subdivision result = SubdividedBy(GetParam(), curve, options);
        EXPECT_NE(result.end, SubdivisionEnd::kNotRun);
        EXPECT_LE(result.num_pieces(), 2000);
        EXPECT_TRUE(result.vertices.allFinite());
      }
    }
  }
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
  for (const int degree : {3, 12}) {
    const BezierCurve curve = CurveOf(RandomPoints(degree + 1, 2, &random));
    const int fewest =
        SubdividedBy("longest/least=0.9999/aim=0.99995/trials=60", curve, SubdivisionOptions())
            .num_pieces();
    const int found = SubdividedBy("longest", curve, SubdivisionOptions()).num_pieces();
    EXPECT_GE(found, fewest);
    EXPECT_LE(found, 1.05 * fewest);
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
