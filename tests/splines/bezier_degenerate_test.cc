#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "tests/splines/bezier_pieces.h"
#include "tests/splines/example_splines.h"

namespace batten {
namespace {

using Rows = std::vector<std::vector<double>>;

Subdivision Halved(const Points& points, const SubdivisionOptions& options) {
  Subdivision result;
  std::string error;
  EXPECT_TRUE(
      Subdivide(BezierCurve::Make(points, nullptr).value(), &CutAtHalf, options, &result, &error))
      << error;
  return result;
}

class EveryDegenerateCurve : public ::testing::TestWithParam<DegenerateCurve> {};
INSTANTIATE_TEST_SUITE_P(BezierSubdivision, EveryDegenerateCurve,
                         ::testing::ValuesIn(kDegenerateCurves),
                         [](const auto& given) { return std::string(given.param.name); });

TEST_P(EveryDegenerateCurve, HalvingEndsWithinItsBoundsByEveryStopAndMode) {
  const Points points = PointsOf(GetParam().points);
  for (const std::string& name : StopMeasureNames()) {
    for (const double tolerance : {1e-4, 1e-20, 0.0}) {
      for (const SubdivisionMode mode : {SubdivisionMode::kAdaptive, SubdivisionMode::kUniform}) {
        SubdivisionOptions options;
        FromString(name, &options.stop);
        if (options.stop == StopMeasure::kHullArea && points.cols() != 2) continue;
        options.relative_tolerance = tolerance;
        options.mode = mode;
        options.max_pieces = 4096;
        const Subdivision result = Halved(points, options);
        EXPECT_NE(result.end, SubdivisionEnd::kNotRun);
        EXPECT_LE(result.num_pieces(), options.max_pieces);
        EXPECT_EQ(result.num_failing == 0, result.end == SubdivisionEnd::kAllPass);
        if (result.end != SubdivisionEnd::kAllPass) {
          EXPECT_NE(result.message, "") << name << " " << tolerance;
        }
        EXPECT_TRUE(result.vertices.allFinite());
      }
    }
  }
}

TEST_P(EveryDegenerateCurve, TheTrueErrorIsKnown) {
  const BezierCurve curve = BezierCurve::Make(PointsOf(GetParam().points), nullptr).value();
  SubdivisionOptions options;
  options.stop = StopMeasure::kSegment;
  options.relative_tolerance = 1e-4;
  const Subdivision result = Halved(curve.control_points(), options);
  EXPECT_EQ(result.end, SubdivisionEnd::kAllPass);
  ExpectErrorWithin(1e-4, curve, result);
}

TEST(BezierDegenerate, PointsAndStraightLinesNeedOnePieceByEveryStop) {
  SubdivisionOptions options;
  options.relative_tolerance = 0.0;
  for (const std::string& stop : StopMeasureNames()) {
    FromString(stop, &options.stop);
    // The last line's numbers are rounded, so that its points are not quite on one line.
    for (const Rows& rows :
         {Rows{{3, 4}}, Rows{{3, 4}, {5, 6}}, Rows{{3, 4}, {3, 4}, {3, 4}},
          Rows{{0, 0}, {1, 1}, {3, 3}}, Rows{{0.1, 0.3}, {0.2, 0.6}, {0.4, 1.2}, {0.7, 2.1}}}) {
      const Subdivision result = Halved(PointsOf(rows), options);
      EXPECT_EQ(result.num_pieces(), 1) << stop;
      EXPECT_EQ(result.end, SubdivisionEnd::kAllPass);
    }
  }
}

TEST(BezierDegenerate, AnAngleBelowRoundingIsRaisedAndSaid) {
  SubdivisionOptions options;
  options.stop = StopMeasure::kAngle;
  options.relative_tolerance = 0.0;
  const Subdivision result = Halved(PointsOf({{0, 0}, {1, 1}, {3, 3}}), options);
  EXPECT_EQ(result.message, "the tolerance is below rounding and was raised to it");
}

TEST(BezierDegenerate, ATurningThatNeverEndsIsCutShortAndSaidSo) {
  // There and back on one line: at the turn every piece holds an angle of 180 degrees.
  SubdivisionOptions options;
  options.stop = StopMeasure::kAngle;
  options.relative_tolerance = 0.1;
  options.max_depth = 10;
  const Subdivision result = Halved(PointsOf({{0, 0}, {1, 1}, {0.25, 0.25}}), options);
  EXPECT_EQ(result.end, SubdivisionEnd::kDepthLimit);
  EXPECT_EQ(result.num_failing, 1);
  EXPECT_EQ(result.message.rfind("1 of ", 0), 0);
  EXPECT_NE(result.message.find("pieces do not pass: the bound on depth, 2^-10 of the curve's "
                                "interval, was hit"),
            std::string::npos)
      << result.message;
}

TEST(BezierDegenerate, TheBoundOnPiecesIsKeptAndSaid) {
  SubdivisionOptions options;
  options.relative_tolerance = 0.0;
  options.max_pieces = 100;
  for (const SubdivisionMode mode : {SubdivisionMode::kAdaptive, SubdivisionMode::kUniform}) {
    options.mode = mode;
    const Subdivision result = Halved(PointsOf({{0, 0}, {1, 2}, {2, 0}}), options);
    EXPECT_EQ(result.end, SubdivisionEnd::kPieceLimit);
    EXPECT_LE(result.num_pieces(), 100);
    EXPECT_NE(result.message.find("the bound of 100 pieces was hit"), std::string::npos);
  }
}

TEST(BezierDegenerate, ABoundOnPiecesIsSpentWhereTheCurveIsFarthest) {
  // A parabola bends evenly: 64 pieces are best spent on equal ones.
  SubdivisionOptions options;
  options.relative_tolerance = 1e-9;
  options.max_pieces = 64;
  options.keep_pieces = true;
  const BezierCurve parabola =
      BezierCurve::Make(PointsOf({{0, 0}, {1, 2}, {2, 0}}), nullptr).value();
  Subdivision result = Halved(parabola.control_points(), options);
  ASSERT_EQ(result.num_pieces(), 64);
  for (int i = 0; i <= 64; ++i) EXPECT_EQ(result.parameters[i], i / 64.0);
  EXPECT_EQ(result.num_failing, 64);
  EXPECT_EQ(result.rounds, 6);
  EXPECT_EQ(result.message, "64 of 64 pieces do not pass: the bound of 64 pieces was hit");
  ExpectCovers(result, 2);
  constexpr double kRoundings = 8;
  ExpectPiecesAreTheCurve(parabola, result, kRoundings);
  // Elsewhere: a piece may be halved or not, which for inner points is a factor of 4, and parts of
  // a piece differ.
  std::mt19937 random(35);
  const BezierCurve curve = BezierCurve::Make(RandomPoints(9, 2, &random), nullptr).value();
  options.max_pieces = 500;
  result = Halved(curve.control_points(), options);
  ASSERT_EQ(result.num_pieces(), 500);
  std::vector<double> errors;
  for (int i = 0; i < 500; ++i) {
    errors.push_back(
        std::sqrt(SquaredPolygonDistance(8, 2, result.pieces.data() + 18 * i).numerator /
                  SquaredPolygonDistance(8, 2, result.pieces.data() + 18 * i).denominator));
  }
  std::sort(errors.begin(), errors.end());
  EXPECT_LE(errors.back(), 8.0 * errors[250]);
}

TEST(BezierDegenerate, AHitBoundAndARaisedToleranceAreBothSaid) {
  SubdivisionOptions options;
  options.relative_tolerance = 0.0;
  options.max_pieces = 100;
  EXPECT_EQ(
      Halved(PointsOf({{0, 0}, {1, 2}, {2, 0}}), options).message,
      "100 of 100 pieces do not pass: the bound of 100 pieces was hit; the tolerance is below "
      "rounding and was raised to it");
}

}  // namespace
}  // namespace batten
