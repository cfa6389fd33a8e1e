// The command `fit` on input that is bad, or poor and still answered.
#include <gmock/gmock.h>
#include <sys/socket.h>

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

TEST(FitCommand, RefusesWhatItMayNotReadOrWrite) {
  const TemporaryFolder folder;
  const std::string points = "x,y\n0,0\n1,1\n2,0\n3,1\n4,0\n";
  const std::string file = folder.Write("points.csv", points);
  const std::string old = folder.Write("fit.json", "precious");
  Program::Streams streams;
  streams.obeys_permissions = true;
  const auto fit = [&](const std::string& flag) {
    return Program({"fit", file, "--control_points=4", flag}, streams).Wait();
  };
  ASSERT_EQ(fit("--out=" + (folder / "new.json")).status, 0);
  chmod(file.c_str(), 0);
  ExpectRefused(fit("--quiet"), {file + ": cannot be read: Permission denied"});
  chmod(file.c_str(), 0400);
  chmod((folder / "").c_str(), 0500);
  for (const std::string flag : {"out", "trace", "iterates", "figure"}) {
    const std::string target = folder / (flag == "figure" ? "fit.svg" : "fit.txt");
    ExpectRefused(fit("--" + flag + "=" + target), {"--" + flag + ": ", "Permission denied"});
  }
  ExpectRefused(fit("--out=" + old), {"--out: ", "Permission denied"});
  chmod((folder / "").c_str(), 0700);
  EXPECT_EQ(ReadFile(old), "precious");
  EXPECT_THAT(folder.Names(), ::testing::ElementsAre("fit.json", "new.json", "points.csv"));
}

TEST(FitCommand, RefusesStandardInputThatCannotBeRead) {
  const TemporaryFolder folder;
  Program::Streams streams;
  streams.input_file = open((folder / "").c_str(), O_RDONLY);
  ExpectRefused(Program({"fit", "-", "--control_points=4"}, streams).Wait(),
                {"-: cannot be read: Is a directory"});
  close(streams.input_file);
}

TEST(FitCommand, DoesNotFitWhatAReadErrorHasCutOff) {
  // A socket whose peer goes away without having read everything hands out what it holds, and then
  // an error.
  int ends[2];
  ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends), 0);
  const std::string points = "x,y\n0,0\n1,1\n2,0\n3,1\n4,0\n";
  ASSERT_EQ(write(ends[0], points.data(), points.size()), static_cast<ssize_t>(points.size()));
  ASSERT_EQ(write(ends[1], "unread", 6), 6);
  close(ends[0]);
  Program::Streams streams;
  streams.input_file = ends[1];
  ExpectRefused(Program({"fit", "-", "--control_points=4"}, streams).Wait(),
                {"-: cannot be read: Connection reset by peer"});
  close(ends[1]);
}

TEST(FitCommand, NamesTheFileOfTheProblemThatCannotBeMade) {
  const TemporaryFolder folder;
  folder.Write("points.csv", "x,y\n0,0\n1,1\n2,0\n3,1\n");
  const std::string problem = folder.Write("p.json", R"({"name": "p", "data": "points.csv",
    "parameters": "given", "spline": {"control_points": 4}})");
  ExpectRefused(RunBatten({"fit", "--problem=" + problem}), {problem + ": ", "column t"});
}

TEST(FitCommand, NamesTheSourceOfBadKnots) {
  const TemporaryFolder folder;
  const std::string data = folder.Write("points.csv", "x,y\n0,0\n1,1\n2,0\n3,1\n");
  const auto fit = [&data](const std::string& knots) {
    return RunBatten({"fit", data, "--degree=1", "--knots=" + knots});
  };
  ExpectRefused(fit("0,0,0.5,0.2,1,1"), {"--knots: knot 3 is 0.2", "below knot 2, 0.5"});
  ExpectRefused(fit("0,0,0,0,1,1"), {"--knots: knot 0, 0, stands 4 times"});
  const std::string file = folder.Write("knots.txt", "# six\n0 0, 0.5\n\n0.2 1 1\n");
  ExpectRefused(fit(file), {file + ":4: found 0.2 after 0.5", "do not decrease"});
  folder.Write("knots.txt", "0 0\n1 one\n");
  ExpectRefused(fit(file), {file + ":2: found \"one\"", "allowed: numbers"});
  folder.Write("knots.txt", "0 0 0 0 1 1");
  ExpectRefused(fit(file), {file + ": knot 0, 0, stands 4 times"});
  folder.Write("knots.txt", "# none\n");
  ExpectRefused(fit(file), {file + ":2: found no knots"});
  ExpectRefused(fit(folder / ""), {"--knots: ", "Is a directory"});
}

TEST(FitCommand, GivesUpAFileOfKnotsWithoutAnEnd) {
  Program::Streams streams;
  if (kCanLimitMemory) streams.memory = rlim_t{1} << 30;
  ExpectRefused(
      Program({"fit", DataFile("animals/rhino_100.csv"), "--knots=/dev/zero"}, streams).Wait(),
      {"/dev/zero:1: found ", "allowed: numbers"});
}

TEST(FitCommand, RefusesMoreIteratesThanMemoryIsGoodFor) {
  const TemporaryFolder folder;
  const std::string file = folder / "iterates.jsonl";
  const auto fit = [&](const std::string& solver) {
    return RunBatten({"fit", "--problem=rhino", "--control_points=3000", "--solver=" + solver,
                      "--max_iterations=1000000", "--iterates=" + file});
  };
  // 8 bytes x 1,000,001 x 6,000 = 44.7 GiB.
  ExpectRefused(fit("lspia"), {"--iterates: ", "44.7 GiB", "at most 4", "--max_iterations"});
  EXPECT_THAT(folder.Names(), ::testing::IsEmpty());
  // It has two.
  EXPECT_EQ(fit("banded_qr").status, 0);
  EXPECT_THAT(folder.Names(), ::testing::ElementsAre("iterates.jsonl"));
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

constexpr char kSixPoints[] = "x,y\n0,0\n1,1\n2,0\n3,3\n4,1\n5,2\n";

TEST(FitCommand, RefusesConstraintsThatItCannotMeet) {
  const auto refuse = [](const std::string& constraints, const std::vector<std::string>& parts) {
    ExpectRefused(FitText(kSixPoints, {"--constraints=" + constraints}), parts);
  };
  refuse("pont/t=0/x=1", {"--constraints: unknown constraint \"pont\"", "did you mean point"});
  refuse("point/t=0/u=1", {"--constraints: point has no option \"u\"", "known: "});
  refuse("point/t=2/x=1", {"has t = 2", "allowed: 0 to 1"});
  refuse("point/t=0/x=1,ends", {"point/t=0/x=1 (x)", "ends at the begin (x)", "contradict"});
  // Of one span it leaves a point.
  refuse(
      "periodic,curvature/t=0.5/kappa=0",
      {"\"curvature/t=0.5/kappa=0\" holds a curvature where C' is 0", "periodic in derivative 0"});
}

TEST(FitCommand, RefusesFairingThatItCannotChoose) {
  const auto refuse = [](const std::vector<std::string>& flags,
                         const std::vector<std::string>& parts) {
    ExpectRefused(FitText(kSixPoints, flags), parts);
  };
  refuse({"--fairing=best"},
         {"--fairing: found \"best\"", "allowed: gcv, risk, discrepancy, lcurve"});
  refuse({"--fairing=discrepancy"}, {"--fairing: discrepancy needs --noise"});
  refuse({"--fairing=risk"}, {"--fairing: risk needs --noise"});
  refuse({"--noise=0.1"}, {"--noise: found 0.1", "allowed: nothing, without"});
  refuse({"--fairing=gcv", "--noise=0.1"}, {"--noise: found 0.1", "allowed: nothing, without"});
  refuse({"--fairing=risk", "--noise=1e-200"},
         {"--fairing=risk is told of noise 1e-200", "allowed: ", " or more"});
  refuse({"--fairing=gcv", "--terms=interpolation/loss=huber"},
         {"--fairing=gcv cannot judge a loss"});
  refuse({"--fairing=gcv", "--parameter_kind=free"}, {"--fairing=gcv cannot judge free"});
  refuse({"--fairing=gcv", "--parameter_kind=projected"}, {"--fairing=gcv cannot judge projected"});
  refuse({"--guard=none/weight=1"}, {"--guard: ", "weight"});
  refuse({"--fairing=gcv", "--guard=bending"}, {"--fairing=gcv", "the guard bending is another"});
  refuse({"--fairing=gcv", "--terms=interpolation,curve_fairing"},
         {"--fairing=gcv cannot judge the term curve_fairing"});
  refuse({"--fairing=gcv", "--constraints=curvature/t=0.5/kappa=1"},
         {"--fairing=gcv cannot judge the constraint curvature/t=0.5/kappa=1"});
  // Not about the rule.
  refuse({"--fairing=gcv", "--terms=foot_point"}, {": term foot_point needs projected"});
  refuse({"--fairing=gcv", "--span_weights=1,2"}, {": found 2 weights of spans"});
  refuse({"--terms=fairing/derivative=4"}, {"--terms: ", "derivative", "1 to 3"});
  refuse({"--terms=interpolation,fairing", "--span_weights=1,2"},
         {"found 2 weights of spans", "the curve has 1 spans"});
}

// On a curve that is one point every parameter is a foot, and E has no gradient to go by.
TEST(FitCommand, RefusesProjectedParametersFromAPoint) {
  ExpectRefused(FitText(kSixPoints, {"--parameter_kind=projected", "--start=centroid"}),
                {"the start is a single point", "data, circle or ellipse"});
  EXPECT_EQ(FitText("x,y\n2,1\n2,1\n2,1\n2,1\n",
                    {"--parameter_kind=projected", "--start=centroid", "--parameters=uniform"})
                .status,
            0);
}

TEST(FitCommand, RefusesFlagsOfFairingWithoutAnyToApplyThemTo) {
  const auto refuse = [](const std::vector<std::string>& flags,
                         const std::vector<std::string>& parts) {
    ExpectRefused(FitText(kSixPoints, flags), parts);
  };
  const auto accept = [](const std::vector<std::string>& flags) {
    const Ended ended = FitText(kSixPoints, flags);
    EXPECT_EQ(ended.status, 0) << ended.err;
  };
  for (const std::string units : {"source", "scale_free"}) {
    const std::string flag = "--fairing_units=" + units;
    const std::vector<std::string> parts = {"--fairing_units: found \"" + units + "\"",
                                            "allowed: nothing, without --fairing or a term"};
    refuse({flag}, parts);
    refuse({flag, "--terms=interpolation"}, parts);
    refuse({flag, "--guard=bending"}, parts);
    refuse({flag, "--terms=interpolation,curve_fairing/units=source"}, parts);
    refuse({flag, "--terms=interpolation,fairing/units=source"}, parts);
    accept({flag, "--terms=interpolation,fairing"});
    accept({flag, "--terms=interpolation,end_tangent"});
    accept({flag, "--terms=interpolation,curve_fairing/weight=1e-6"});
    accept({flag, "--fairing=discrepancy", "--noise=0.6", "--solver=banded_qr"});
  }
  const std::vector<std::string> parts = {"--span_weights: found ", "allowed: nothing, without"};
  refuse({"--span_weights=2"}, parts);
  refuse({"--span_weights=2", "--terms=interpolation,end_tangent"}, parts);
  refuse({"--span_weights=2", "--guard=none"}, parts);
  refuse({"--span_weights=no_such_file"}, parts);
  accept({"--span_weights=2", "--guard=bending"});
  accept({"--span_weights=2", "--terms=interpolation,fairing"});
  accept({"--span_weights=2", "--terms=interpolation,curve_fairing"});
  accept({"--span_weights=2", "--fairing=discrepancy", "--noise=0.6", "--solver=banded_qr"});
}

TEST(FitCommand, RefusesNumbersOfARuleThatTheModeDoesNotUse) {
  for (const std::string command : {"fit", "compare", "replay"}) {
    const auto refuse = [&](const std::vector<std::string>& flags,
                            const std::vector<std::string>& parts) {
      std::vector<std::string> arguments = {command};
      if (command != "compare") arguments.emplace_back("--problem=rhino");
      arguments.insert(arguments.end(), flags.begin(), flags.end());
      ExpectRefused(RunBatten(arguments), parts);
    };
    refuse({"--native_step=1e-3"},
           {"--native_step: found 0.001", "nothing, without --mode=native"});
    refuse({"--native_gradient=0.5"}, {"--native_gradient: found 0.5", "without --mode=native"});
  }
}

}  // namespace
}  // namespace batten
