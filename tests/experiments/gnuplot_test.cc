#include "experiments/gnuplot.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace batten {
namespace {

TEST(GnuplotString, QuotesWhatEndsAString) {
  EXPECT_EQ(GnuplotString("it's \"x\" `y`"), "'it''s \"x\" `y`'");
  EXPECT_EQ(GnuplotString("a\nb"), "'a b'");
}

TEST(ShownText, KeepsCharactersOfXmlAndReplacesOtherBytes) {
  EXPECT_EQ(ShownText("caf\xC3\xA9 <&> 'x'", 40), "caf\xC3\xA9 <&> 'x'");
  const std::string none = "\xEF\xBF\xBD";
  EXPECT_EQ(ShownText("a\xFF", 40), "a" + none);
  EXPECT_EQ(ShownText("a\nb\x7F\x01", 40), "a" + none + "b" + none + none);
  EXPECT_EQ(ShownText("\xEF\xBF\xBE", 40), none) << "U+FFFE is in UTF-8, but not in XML";
}

TEST(ShownText, LeavesOutTheMiddleOfWhatIsTooLong) {
  EXPECT_EQ(ShownText("abcdefghij", 10), "abcdefghij");
  EXPECT_EQ(ShownText("abcdefghijk", 10), "abcde\xE2\x80\xA6hijk");
  // Characters, not bytes.
  EXPECT_EQ(ShownText("\xC3\xA9\xC3\xA9\xC3\xA9\xC3\xA9", 3), "\xC3\xA9\xE2\x80\xA6\xC3\xA9");
}

TEST(DrawFigure, RunsNothingThatStandsInAName) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "batten gnuplot";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  FileBatch batch;
  DrawFigure(folder / "x\nset print 'mark'\nprint 1\n#", "0 0\n", "plot DATA\n", 400, 300, &batch);
  EXPECT_FALSE(std::filesystem::exists("mark"));
}

}  // namespace
}  // namespace batten
