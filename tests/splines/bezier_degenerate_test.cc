#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "splines/bezier_distance.h"
#include "splines/bezier_measures.h"
#include "splines/bezier_subdivision.h"
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

struct DegenerateCase {
  const char* name;
  Rows points;
};

const DegenerateCase kCases[] = {
    {"one_point", {{3, 4}}},
    {"a_segment", {{3, 4}, {5, 6}}},
    {"all_equal", {{3, 4}, {3, 4}, {3, 4}, {3, 4}}},
    {"all_zero", {{0, 0}, {0, 0}, {0, 0}}},
    {"closed", {{0, 0}, {3, 1}, {-2, 4}, {0, 0}}},
    {"there_and_back", {{0, 0}, {1, 1}, {0, 0}}},
    {"straight", {{0, 0}, {1, 1}, {3, 3}, {4, 4}}},
    {"straight_with_overshoot", {{0, 0}, {9, 9}, {-5, -5}, {4, 4}}},
    {"cusp", {{0, 0}, {1, 1}, {0, 1}, {1, 0}}},
    {"repeated", {{0, 0}, {0, 0}, {0, 0}, {1, 2}, {3, 1}, {3, 1}, {3, 1}}},
    {"tiny_beside_huge", {{0, 0}, {1e-300, 1}, {1, 1e-300}, {1, 1}}},
    {"far_away", {{1e9, 1e9}, {1e9 + 1, 1e9 + 2}, {1e9 + 2, 1e9}}},
    {"huge", {{0, 0}, {1e300, 1e300}, {1e300, -1e300}, {-1e300, 5e299}}},
    {"largest", {{-1.7e308, 0}, {1.7e308, 1.7e308}, {1.7e308, -1.7e308}}},
    {"denormal", {{0, 0}, {5e-324, 1e-323}, {2e-320, 0}}},
    {"in_space", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 1}}},
};

class EveryDegenerateCase : public ::testing::TestWithParam<DegenerateCase> {};
INSTANTIATE_TEST_SUITE_P(BezierSubdivision, EveryDegenerateCase, ::testing::ValuesIn(kCases),
                         [](const auto& given) { return std::string(given.param.name); });

TEST_P(EveryDegenerateCase, EndsWithinItsBoundsByEveryRuleAndMode) {
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

TEST_P(EveryDegenerateCase, TheTrueErrorIsKnown) {
  const BezierCurve curve = BezierCurve::Make(PointsOf(GetParam().points), nullptr).value();
  SubdivisionOptions options;
  options.stop = StopMeasure::kSegment;
  options.relative_tolerance = 1e-4;
  const Subdivision result = Halved(curve.control_points(), options);
  EXPECT_EQ(result.end, SubdivisionEnd::kAllPass);
  const DistanceBounds bounds = BoundHausdorffDistance(
      curve,
      Eigen::Map<const Eigen::VectorXd>(result.parameters.data(),
                                        static_cast<Eigen::Index>(result.parameters.size())),
      result.vertices);
  // The tolerance, and what rounding adds in the rule and in the certificate.
  const int n = curve.degree(), d = curve.dimension();
  const double unit = UnitOf(curve.control_points());
  const Points scaled = curve.control_points() / unit;
  // Vertices that are denormal numbers are rounded to the smallest of these.
  const double denormal = 2 * std::numeric_limits<double>::denorm_min() / unit;
  EXPECT_LE(bounds.upper / unit, 1e-4 * BoxSide(n, d, scaled.data()) + denormal +
                                     4 * BezierRounding(n, d, scaled.data()));
  EXPECT_LE(bounds.lower, bounds.upper);
}

TEST(BezierDegenerate, PointsAndSegmentsNeedOnePiece) {
  SubdivisionOptions options;
  options.relative_tolerance = 0.0;
  for (const Rows& rows : {Rows{{3, 4}}, Rows{{3, 4}, {5, 6}}, Rows{{3, 4}, {3, 4}, {3, 4}},
                           Rows{{0, 0}, {1, 1}, {3, 3}}}) {
    EXPECT_EQ(Halved(PointsOf(rows), options).num_pieces(), 1);
  }
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

}  // namespace
}  // namespace batten
