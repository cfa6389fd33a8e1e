#include "splines/bezier_subdivision.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "splines/bezier_distance.h"
#include "splines/bezier_measures.h"
#include "tests/splines/example_splines.h"

namespace batten {
namespace {

BezierCurve CurveOf(const Points& points) { return BezierCurve::Make(points, nullptr).value(); }

Subdivision Subdivided(const BezierCurve& curve, const CutChoice& rule,
                       const SubdivisionOptions& options) {
  Subdivision result;
  std::string error;
  EXPECT_TRUE(Subdivide(curve, rule, options, &result, &error)) << error;
  return result;
}

DistanceBounds TrueError(const BezierCurve& curve, const Subdivision& result) {
  return BoundHausdorffDistance(
      curve,
      Eigen::Map<const Eigen::VectorXd>(result.parameters.data(),
                                        static_cast<Eigen::Index>(result.parameters.size())),
      result.vertices);
}

// de Casteljau's algorithm in long double.
std::array<long double, kMaxDimension> Exactly(const Points& points, long double t) {
  std::vector<long double> b(points.data(), points.data() + points.size());
  const auto d = static_cast<std::size_t>(points.cols());
  for (std::size_t size = b.size() - d; size > 0; size -= d) {
    for (std::size_t k = 0; k < size; ++k) b[k] = (1.0L - t) * b[k] + t * b[k + d];
  }
  std::array<long double, kMaxDimension> point{};
  std::copy(b.begin(), b.begin() + static_cast<std::ptrdiff_t>(d), point.begin());
  return point;
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

// Some 200 pieces are compared with the curve at 5 parameters each. A rounding of the largest
// coordinate is half an eps; the parameters of pieces are rounded once, which moves the point by
// |C'| eps / 2.
void ExpectPiecesAreTheCurve(const BezierCurve& curve, const Subdivision& result,
                             double roundings) {
  const int size = curve.degree() + 1, d = curve.dimension();
  double worst = 0.0;
  for (int i = 0; i < result.num_pieces(); i += 1 + result.num_pieces() / 200) {
    const long double begin = result.parameters[i], end = result.parameters[i + 1];
    for (const double s : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      double point[kMaxDimension];
      EvaluateBezier(curve.degree(), d, result.pieces.data() + i * size * d, s, point);
      const auto exact = Exactly(curve.control_points(), begin + (end - begin) * s);
      for (int c = 0; c < d; ++c) {
        worst = std::max(worst, static_cast<double>(std::abs(point[c] - exact[c])));
      }
    }
  }
  EXPECT_LE(worst, roundings * kEpsilon / 2 * curve.control_points().cwiseAbs().maxCoeff());
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
    const int k = result.num_pieces();
    ASSERT_EQ(result.vertices.rows(), k + 1);
    ASSERT_EQ(result.pieces.rows(), k * 8);
    EXPECT_EQ(result.parameters.front(), 0.0);
    EXPECT_EQ(result.parameters.back(), 1.0);
    for (int i = 0; i < k; ++i) {
      EXPECT_LT(result.parameters[i], result.parameters[i + 1]);
      EXPECT_EQ(result.pieces.row(8 * i), result.vertices.row(i));
      EXPECT_EQ(result.pieces.row(8 * i + 7), result.vertices.row(i + 1));
    }
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
  EXPECT_EQ(result.evaluations, 63);
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
  options.keep_pieces = true;
  std::mt19937 random(28);
  for (PlainRule rule : {&CutAtHalf, &TakeShortFirst}) {
    const BezierCurve curve = CurveOf(RandomPoints(7, 2, &random));
    const Subdivision result = Subdivided(curve, rule, options);
    EXPECT_EQ(result.end, SubdivisionEnd::kAllPass);
    EXPECT_EQ(result.num_failing, 0);
    const double side = BoxSide(6, 2, curve.control_points().data());
    for (int i = 0; i < result.num_pieces(); ++i) {
      const double* piece = result.pieces.data() + i * 7 * 2;
      const Quotient farthest = SquaredChordDistance(6, 2, piece);
      const Quotient flatness = Flatness(6, 2, piece);
      const Quotient polygon = SquaredPolygonDistance(6, 2, piece);
      const double tolerance = options.relative_tolerance;
      const double area = tolerance * side * side;
      // The test of a piece and this one round a few times each.
      constexpr double kSlack = 1.0 + 1e-12;
      switch (options.stop) {
        case StopMeasure::kControlPoints:
          EXPECT_LE(std::sqrt(farthest.numerator / farthest.denominator),
                    tolerance * side * kSlack);
          break;
        case StopMeasure::kPolygon:
          EXPECT_LE(std::sqrt(polygon.numerator / polygon.denominator), tolerance * side * kSlack);
          break;
        case StopMeasure::kHullArea:
          EXPECT_LE(HullArea(6, piece), area * kSlack);
          break;
        case StopMeasure::kFlatness:
          EXPECT_LE(flatness.numerator / flatness.denominator, area * kSlack);
          break;
        case StopMeasure::kSegment:
          EXPECT_LE(BoundSegmentDistance(6, 2, piece, piece, piece + 12, 0.02, 0.0).upper,
                    tolerance * side * kSlack);
          break;
        case StopMeasure::kAngle:
          EXPECT_LE(std::atan(std::sqrt(SquaredLegSlope(6, 2, piece))), tolerance * kSlack);
          break;
      }
    }
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
      const double side = BoxSide(degree, 2, curve.control_points().data());
      // Certified, including what the certificate adds for rounding.
      EXPECT_LE(TrueError(curve, result).upper,
                1e-5 * side + 2 * BezierRounding(degree, 2, curve.control_points().data()));
    }
  }
}

TEST(BezierSubdivision, OnlyTheSegmentRulesSeeOvershootOnALine) {
  const BezierCurve curve = CurveOf(PointsOf({{0, 0}, {4, 0}, {-3, 0}, {1, 0}}));
  SubdivisionOptions options;
  EXPECT_EQ(Subdivided(curve, &CutAtHalf, options).num_pieces(), 1);
  for (const StopMeasure stop : {StopMeasure::kSegment, StopMeasure::kPolygon}) {
    options.stop = stop;
    const Subdivision result = Subdivided(curve, &CutAtHalf, options);
    EXPECT_GT(result.num_pieces(), 2);
    EXPECT_LE(TrueError(curve, result).upper, 1e-5 * 7.0 * (1.0 + 1e-6));
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
  EXPECT_EQ(error,
            "a stop by hull area needs a planar curve; found 3 coordinates, use control_points");
}

}  // namespace
}  // namespace batten
