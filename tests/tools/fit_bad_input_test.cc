// The command `fit` on input that is bad, or poor and still answered.
#include <gmock/gmock.h>

#include "tests/tools/program.h"

namespace batten {
namespace {

using ::testing::HasSubstr;

Ended FitText(const std::string& points, std::vector<std::string> flags = {}) {
  std::vector<std::string> arguments = {"fit", "-", "--control_points=4"};
  arguments.insert(arguments.end(), flags.begin(), flags.end());
  return RunBatten(arguments, points);
}

struct BadData {
  const char* name;
  const char* points;
  const char* where;
  const char* found;
};

void PrintTo(const BadData& bad, std::ostream* stream) { *stream << bad.name; }

class BadDataFile : public ::testing::TestWithParam<BadData> {};

TEST_P(BadDataFile, IsRefusedWithFileLineAndColumn) {
  const TemporaryFolder folder;
  const std::string path = folder.Write("points.csv", GetParam().points);
  const std::string out = folder / "fit.json";
  const Ended ended = RunBatten({"fit", path, "--control_points=4", "--out=" + out});
  ExpectRefused(ended, {path + GetParam().where, GetParam().found, "allowed: "});
  EXPECT_THAT(folder.Names(), ::testing::ElementsAre("points.csv"));
}

INSTANTIATE_TEST_SUITE_P(
    FitCommand, BadDataFile,
    ::testing::Values(BadData{"EmptyFile", "", ":1:", "no data point"},
                      BadData{"OnlyAHeader", "x,y\n", ":", "no data point"},
                      BadData{"NotANumber", "x,y\n0,0\n1,nan\n2,0\n", ":3:2:", "\"nan\""},
                      BadData{"Infinity", "x,y\n0,0\n-inf,1\n2,0\n", ":3:1:", "\"-inf\""},
                      BadData{"MissingColumn", "x,y\n0,0\n1\n2,0\n", ":3:", "row length 1"},
                      BadData{"UnknownColumn", "x,q\n0,0\n1,1\n", ":1:2:", "\"q\""},
                      BadData{"TextInANumber", "x,y\n0,0\n1,2\n3,4m\n", ":4:2:", "\"4m\""},
                      BadData{"TooLargeANumber", "x,y\n0,0\n1e308,1\n2,0\n", ":3:1:", "1e308"},
                      BadData{"Binary", "\x89PNG\r\n\x1a\n\x01\x02", ":1:", "\\x89PNG"}),
    [](const auto& bad) { return std::string(bad.param.name); });

TEST(FitCommand, RefusesOnePoint) {
  ExpectRefused(FitText("x,y\n1,2\n"), {"found 1 data point", "at least 2"});
}

TEST(FitCommand, RefusesEqualPointsOnlyWhereLengthsAreNeeded) {
  const std::string two = "x,y\n1,2\n1,2\n";
  const std::string five = "1 2\n1 2\n1 2\n1 2\n1 2\n";
  for (const std::string& points : {two, five}) {
    for (const std::string solver : {"lbfgs", "banded_qr", "banded_cholesky", "cg", "lspia"}) {
      const Ended ended = FitText(points, {"--parameters=uniform", "--solver=" + solver});
      EXPECT_EQ(ended.status, 0) << solver << ": " << ended.err;
    }
    ExpectRefused(FitText(points, {"--parameters=chord_length"}), {"equal"});
    ExpectRefused(FitText(points, {"--parameters=centripetal"}), {"equal"});
  }
}

TEST(FitCommand, AnswersFewerPointsThanDegreePlusOneWithTheSolutionNearestToTheStart) {
  for (const std::string solver : {"banded_qr", "banded_cholesky"}) {
    const Ended ended = FitText("x,y\n0,0\n3,4\n", {"--solver=" + solver});
    EXPECT_EQ(ended.status, 0) << solver << ": " << ended.err;
    EXPECT_THAT(ended.out, HasSubstr("nearest to the start")) << solver;
    EXPECT_THAT(ended.out, HasSubstr("verified")) << solver;
  }
  EXPECT_EQ(FitText("x,y\n0,0\n3,4\n", {"--solver=lbfgs"}).status, 0);
}

TEST(FitCommand, AnswersARepeatedPointUnderChordLength) {
  const Ended ended = FitText("x,y\n0,0\n1,1\n1,1\n2,0\n3,3\n4,1\n", {"--parameters=chord_length"});
  EXPECT_EQ(ended.status, 0) << ended.err;
}

TEST(FitCommand, RefusesParametersThatAreNotThere) {
  ExpectRefused(FitText("x,y\n0,0\n1,1\n2,0\n", {"--parameters=given"}), {"column t"});
}

TEST(FitCommand, RefusesPathsThatCannotBeRead) {
  const TemporaryFolder folder;
  const std::string file = folder.Write("points.csv", "x,y\n0,0\n1,1\n");
  // Below a regular file: not even root can read that.
  ExpectRefused(RunBatten({"fit", file + "/points.csv", "--control_points=4"}),
                {file + "/points.csv", "Not a directory"});
  ExpectRefused(RunBatten({"fit", folder / "none.csv", "--control_points=4"}),
                {"none.csv", "No such file"});
  ExpectRefused(RunBatten({"fit", folder / "", "--control_points=4"}), {"directory"});
  ExpectRefused(RunBatten({"fit", file, "--knots=" + (folder / "none.txt")}),
                {"--knots: ", "No such file"});
}

TEST(FitCommand, WantsExactlyOneInput) {
  ExpectRefused(RunBatten({"fit", "--control_points=4"}), {"found 0 files", "one FILE"});
  ExpectRefused(RunBatten({"fit", "a.csv", "b.csv"}), {"found 2 files"});
  ExpectRefused(RunBatten({"fit", "a.csv", "--problem=rhino"}), {"and --problem"});
}

TEST(FitCommand, KeepsAMessageOnOneLineWhateverTheFileIsCalled) {
  ExpectRefused(RunBatten({"fit", "no\nsuch\tfile", "--control_points=4"}),
                {"no\\x0asuch\\x09file"});
}

}  // namespace
}  // namespace batten
