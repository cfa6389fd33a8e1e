#include "problems/svg_path.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/problems/bezier_path_points.h"
#include "tests/splines/example_splines.h"

namespace batten {
namespace {

std::vector<BezierPath> Parsed(const std::string& text) {
  std::vector<BezierPath> paths;
  std::size_t offset = 0;
  std::string error;
  EXPECT_TRUE(ParseSvgPath(text, &paths, &offset, &error)) << error;
  return paths;
}

void ExpectRefused(const std::string& text, std::size_t place, const std::string& message) {
  std::vector<BezierPath> paths;
  std::size_t offset = 0;
  std::string error;
  EXPECT_FALSE(ParseSvgPath(text, &paths, &offset, &error)) << text;
  EXPECT_EQ(offset, place) << text;
  EXPECT_EQ(error.rfind(message, 0), 0) << error;
}

TEST(SvgPath, ReadsEveryCommandInBothCases) {
  const auto absolute =
      Parsed("M 1 2 L 3 4 H 5 V 6 C 7 8 9 10 11 12 S 15 16 17 18 Q 19 20 21 22 T 25 26 Z");
  const auto relative = Parsed("m1,2l2 2h2v2c2 2 4 4 6 6s4 4 6 6q2 2 4 4t4 4z");
  ASSERT_EQ(absolute.size(), 1);
  ASSERT_EQ(absolute[0].spans.size(), 8);
  ASSERT_EQ(relative[0].spans.size(), 8);
  const std::vector<Points> expected = {
      PointsOf({{1, 2}, {3, 4}}),
      PointsOf({{3, 4}, {5, 4}}),
      PointsOf({{5, 4}, {5, 6}}),
      PointsOf({{5, 6}, {7, 8}, {9, 10}, {11, 12}}),
      PointsOf({{11, 12}, {13, 14}, {15, 16}, {17, 18}}),  // (9, 10) mirrored
      PointsOf({{17, 18}, {19, 20}, {21, 22}}),
      PointsOf({{21, 22}, {23, 24}, {25, 26}}),  // (19, 20) mirrored
      PointsOf({{25, 26}, {1, 2}}),
  };
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(PointsAt(absolute, 0, i), expected[i]) << i;
    EXPECT_EQ(PointsAt(relative, 0, i), expected[i]) << i;
    EXPECT_EQ(absolute[0].spans[i].begin, static_cast<double>(i));
    EXPECT_EQ(absolute[0].spans[i].end, static_cast<double>(i + 1));
  }
}

TEST(SvgPath, NumbersMayTouch) {
  const auto paths = Parsed("M0-1.5.5.5l.5.5-1e1+2E-1");
  EXPECT_EQ(PointsAt(paths, 0, 0), PointsOf({{0, -1.5}, {0.5, 0.5}}));  // a pair after M is a line
  EXPECT_EQ(PointsAt(paths, 0, 1), PointsOf({{0.5, 0.5}, {1.0, 1.0}}));
  EXPECT_EQ(PointsAt(paths, 0, 2), PointsOf({{1.0, 1.0}, {-9.0, 1.2}}));
}

TEST(SvgPath, ASmoothCurveAfterALineStartsInThePoint) {
  EXPECT_EQ(PointsAt(Parsed("M0 0L1 0S3 1 4 0"), 0, 1), PointsOf({{1, 0}, {1, 0}, {3, 1}, {4, 0}}));
  EXPECT_EQ(PointsAt(Parsed("M0 0C1 1 2 1 3 0T5 0"), 0, 1), PointsOf({{3, 0}, {3, 0}, {5, 0}}));
}

TEST(SvgPath, EveryMoveBeginsAPathAndEmptyOnesAreLeftOut) {
  const auto paths = Parsed("M0 0 L1 0 L0 0 Z M5 5 M6 6 l1 1 z l2 0");
  ASSERT_EQ(paths.size(), 3);
  EXPECT_EQ(paths[0].spans.size(), 2);  // it ends where it began: Z adds nothing
  EXPECT_EQ(paths[1].spans.size(), 2);
  EXPECT_EQ(PointsAt(paths, 2, 0), PointsOf({{6, 6}, {8, 6}}));  // goes on from the path's start
}

TEST(SvgPath, SaysWhatItFoundAndWhere) {
  ExpectRefused("L 1 1", 0, "found \"L 1 1\"; allowed: M or m first");
  ExpectRefused("M 0 0 A 1 1 0 0 0 5 5", 6, "found \"A 1 1 0 0 0 5 5\"; allowed: one of M");
  ExpectRefused("M 0 0 L 1 x", 10, "found \"x\"; allowed: a number up to 1e150 in size");
  ExpectRefused("M 0", 3, "found the end of the path; allowed: a number");
  ExpectRefused("M 0 0 L 1e999 0", 8, "found \"1e999 0\"; allowed: a number");
  ExpectRefused("M 0 0 L nan 0", 8, "found \"nan 0\"; allowed: a number");
  ExpectRefused("M 0 0 C 1 1 2 2", 15, "found the end of the path");
}

TEST(SvgPath, OneCommaMayStandBetweenTwoNumbersAndNowhereElse) {
  EXPECT_EQ(PointsAt(Parsed("M0 , 0L1,1\n,\t2,2"), 0, 1), PointsOf({{1, 1}, {2, 2}}));
  ExpectRefused("M0,,0", 3, "found \",0\"; allowed: a number");
  ExpectRefused("M,0 0", 1, "found \",0 0\"; allowed: a number");
  ExpectRefused("M0 0,L1 1", 5, "found \"L1 1\"; allowed: a number");
  ExpectRefused("M0 0L1 1,", 9, "found the end of the path; allowed: a number");
  ExpectRefused("M0 0L1 1z,", 9, "found \",\"; allowed: one of M");
  ExpectRefused(",M0 0", 0, "found \",M0 0\"; allowed: M or m first");
}

}  // namespace
}  // namespace batten
