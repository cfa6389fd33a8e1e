#include "problems/svg_file.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/problems/bezier_path_points.h"
#include "tests/problems/scratch_folder.h"
#include "tests/splines/example_splines.h"

namespace batten {
namespace {

struct SvgContents {
  std::vector<BezierPath> paths;
  std::string left_out;
};
SvgContents ReadText(const std::string& text) {
  const ScratchFolder folder;
  SvgContents read;
  std::string error;
  EXPECT_TRUE(ReadSvgPaths(folder.Write("a.svg", text), &read.paths, &read.left_out, &error))
      << error;
  return read;
}

/// The message without the folder's name.
std::string RefusalOf(const std::string& text) {
  const ScratchFolder folder;
  SvgContents read;
  std::string error;
  EXPECT_FALSE(ReadSvgPaths(folder.Write("a.svg", text), &read.paths, &read.left_out, &error))
      << text;
  const std::string folder_name = folder.path().string() + "/";
  EXPECT_EQ(error.rfind(folder_name, 0), 0) << error;
  return error.substr(folder_name.size());
}
void ExpectRefused(const std::string& text, const std::string& begin) {
  const std::string refusal = RefusalOf(text);
  EXPECT_EQ(refusal.rfind(begin, 0), 0) << refusal;
}

TEST(SvgFile, ReadsThePathsOfElementsInEitherQuotes) {
  const SvgContents read = ReadText(
      "<?xml version='1.0'?><svg>\n<path id=\"d\" fill='red'\n d='M0 0L1 1'/>\n"
      "<g><a><path d=\"M2 2Q3 3 4 2\"></path></a></g></svg>");
  ASSERT_EQ(read.paths.size(), 2);
  EXPECT_EQ(PointsAt(read.paths, 1, 0), PointsOf({{2, 2}, {3, 3}, {4, 2}}));
  EXPECT_EQ(read.left_out, "");
}

TEST(SvgFile, ReadsAFileOfPathDataAlone) {
  EXPECT_EQ(ReadText("\n M0 0L1 1\n").paths.size(), 1);
  EXPECT_EQ(ReadText("\xEF\xBB\xBFM0 0L1 1").paths.size(), 1);
}

TEST(SvgFile, AttributesMayHoldWhatElsewhereHasAMeaning) {
  const SvgContents read = ReadText(
      "<svg><path id='a > b' d = \"M0 0L1 1\" data-d='M9 9L8 8'/>"
      "<path aria-label=\" d='M5 5L6 6' \" d='M2 2L3 3'/></svg>");
  ASSERT_EQ(read.paths.size(), 2);
  EXPECT_EQ(PointsAt(read.paths, 0, 0), PointsOf({{0, 0}, {1, 1}}));
  EXPECT_EQ(PointsAt(read.paths, 1, 0), PointsOf({{2, 2}, {3, 3}}));
}

TEST(SvgFile, ReadsEscapesAndNamespaces) {
  const SvgContents read = ReadText(
      "<svg:svg xmlns:svg='http://www.w3.org/2000/svg' xmlns:i='x'><i:g><i:path d='bad'/></i:g>"
      "<svg:path d='M0 0&#x20;L1&#32;1'/></svg:svg>");
  ASSERT_EQ(read.paths.size(), 1);
  EXPECT_EQ(PointsAt(read.paths, 0, 0), PointsOf({{0, 0}, {1, 1}}));
  EXPECT_EQ(read.left_out, "");
}

TEST(SvgFile, PassesOverWhatIsNotDrawn) {
  const std::string path = "<path d='M5 5L6 6'/>";
  const SvgContents read = ReadText(
      "<svg><!-- " + path + " --><desc>transform=\"x\" <g>" + path + "</g></desc><defs>" + path +
      "<g>" + path + "</g></defs><clipPath transform='scale(2)'>" + path + "</clipPath><symbol>" +
      path + "</symbol><g display='none'>" + path + "</g><g style='fill: red; display : none'>" +
      path + "</g><![CDATA[" + path + "]]><path d='M0 0L1 1'/></svg>");
  ASSERT_EQ(read.paths.size(), 1);
  EXPECT_EQ(PointsAt(read.paths, 0, 0), PointsOf({{0, 0}, {1, 1}}));
  EXPECT_EQ(read.left_out, "");
}

TEST(SvgFile, SaysWhichOtherElementsAreLeftOut) {
  const SvgContents read = ReadText(
      "<svg><circle r='1'/><g><circle r='2' transform='scale(2)'/><text>M0 0</text></g>"
      "<path d='M0 0L1 1'/><use href='#a'/></svg>");
  EXPECT_EQ(read.paths.size(), 1);
  EXPECT_EQ(read.left_out, "circle (2), text (1), use (1)");
  ExpectRefused("<svg><circle r=\"1\"/></svg>",
                "a.svg: found no path with a curve but circle (1); allowed: <path");
  ExpectRefused("<svg/>", "a.svg: found no path with a curve; allowed: <path");
}

TEST(SvgFile, RefusesTransformsOfWhatItReads) {
  const std::string message = "found a transform; allowed: paths without one";
  const std::string path = "<path d='M0 0L1 1'/>";
  EXPECT_EQ(RefusalOf("<svg><g transform=\"scale(2)\">" + path + "</g></svg>"),
            "a.svg:1:20: " + message);
  EXPECT_EQ(RefusalOf("<svg>\n<path transform = 'scale(2)' d='M0 0L1 1'/></svg>"),
            "a.svg:2:20: " + message);
  EXPECT_EQ(RefusalOf("<svg><g style='fill:red;transform: scale(2)'>" + path + "</g></svg>"),
            "a.svg:1:36: " + message);
  EXPECT_EQ(RefusalOf("<svg style=\"transform:scale(2)\"><g><g>" + path + "</g></g></svg>"),
            "a.svg:1:23: " + message);
  ExpectRefused("<svg><style>path{transform:scale(2)}</style>" + path + "</svg>",
                "a.svg:1:28: found a transform in a style sheet");
  ExpectRefused("<svg><svg x='5'>" + path + "</svg></svg>",
                "a.svg:1:7: found a path in an svg element inside another");
}

TEST(SvgFile, TransformsThatMoveNothingReadAreNoMatter) {
  EXPECT_EQ(ReadText("<svg><style>text{text-transform: none; transform:none}</style>"
                     "<linearGradient gradientTransform='scale(2)' transform='scale(2)'/>"
                     "<g transform=' '><path transform='none' style='text-transform:x' "
                     "d='M0 0L1 1'/></g><g transform='scale(2)'><path d=''/><path/></g></svg>")
                .paths.size(),
            1);
}

TEST(SvgFile, NamesLineAndColumn) {
  ExpectRefused("<svg>\n<path d=\"M0 0\n L1 oops\"/></svg>", "a.svg:3:5: found \"oops\"");
  ExpectRefused("<svg>\r\n<path d=\"M0 0\r\n\r\n L1 oops\"/></svg>", "a.svg:4:5: found \"oops\"");
  ExpectRefused("M0 0\nL1 x", "a.svg:2:4: found \"x\"");
}

TEST(SvgFile, RefusesWhatIsNotWellFormed) {
  const std::string message = "found XML that is not well-formed (";
  for (const char* text :
       {"<svg><path d=\"M0 0L1 1</svg>", "<svg><path d=\"M0 0L1 1/>\n<path d=\"M2 2\"/></svg>",
        "<svg><path d=M0/></svg>", "<svg><path d='M0 0L1 1'/>", "<svg><g></svg></g>",
        "<svg><!-- <path d='M0 0L1 1'/></svg>", "<"}) {
    EXPECT_NE(RefusalOf(text).find(message), std::string::npos) << text;
  }
  ExpectRefused("<html><path d='M0 0L1 1'/></html>",
                "a.svg:1:2: found the element \"html\"; allowed: svg");
  SvgContents read;
  std::string error;
  const ScratchFolder folder;
  EXPECT_FALSE(
      ReadSvgPaths((folder.path() / "missing.svg").string(), &read.paths, &read.left_out, &error));
}

TEST(SvgFile, DeepNestingIsNoMatter) {
  std::string text = "<svg>";
  constexpr int kDepth = 100000;
  for (int k = 0; k < kDepth; ++k) text += "<g>";
  text += "<path d='M0 0L1 1'/>";
  for (int k = 0; k < kDepth; ++k) text += "</g>";
  EXPECT_EQ(ReadText(text + "</svg>").paths.size(), 1);
}

}  // namespace
}  // namespace batten
