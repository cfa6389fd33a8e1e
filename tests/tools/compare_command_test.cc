// The command `compare`, run as a process.
#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "tests/tools/program.h"

namespace batten {
namespace {

using nlohmann::json;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

std::vector<json> JsonLines(const std::string& path) {
  std::vector<json> rows;
  for (const std::string& line : Lines(ReadFile(path))) rows.push_back(json::parse(line));
  return rows;
}

class CompareCommand : public ::testing::Test {
 protected:
  Ended Compare(std::vector<std::string> flags) {
    flags.insert(flags.begin(), {"compare", "--repetitions=1", "--out=" + out_});
    return RunBatten(std::move(flags));
  }
  /// A problem file over `points`, in the folder of the test.
  std::string WriteProblem(const std::string& name, const std::string& points,
                           const std::string& spline) {
    return folder_.Write(name + ".json", R"({"name": ")" + name + R"(", "data": ")" + points +
                                             R"(", "spline": {)" + spline + "}}");
  }

  TemporaryFolder folder_;
  std::string out_ = folder_ / "new/out";  // created
};

TEST_F(CompareCommand, PrintsOneTableOfAllSolversAndWritesAllFiles) {
  const Ended ended = Compare({"--problems=rhino,dolphin"});
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(ended.err, "");
  EXPECT_THAT(ended.out, HasSubstr("gim needs 100 control points for 100 points"));
  EXPECT_THAT(ended.out, HasSubstr(out_ + "/table.csv"));
  for (const char* name :
       {"table.csv", "table.json", "table.md", "table.tex", "cells.jsonl", "rhino_convergence.svg",
        "rhino_convergence.gp", "rhino_convergence.dat", "rhino_fit.svg", "rhino_fit.gp",
        "rhino_fit.dat", "rhino_fit.plot.json", "dolphin_convergence.svg", "dolphin_fit.svg"}) {
    EXPECT_TRUE(std::filesystem::is_regular_file(out_ + "/" + name)) << name;
  }
  const auto solvers = RunBatten({"list", "solvers", "--json"}).Json()["solvers"];
  const auto table = json::parse(ReadFile(out_ + "/table.json"));
  const auto cells = JsonLines(out_ + "/cells.jsonl");
  ASSERT_EQ(table["rows"].size(), 2 * solvers.size());
  ASSERT_EQ(cells.size(), 2 * solvers.size());
  EXPECT_EQ(Lines(ReadFile(out_ + "/table.csv")).size(), 2 * solvers.size() + 1);
  std::set<std::string> with_own_limit;
  for (const json& solver : solvers) {
    if (!solver["limit"].is_null()) with_own_limit.insert(solver["name"]);
  }
  for (const json& row : table["rows"]) {
    if (row["stop"] == "skipped") continue;
    EXPECT_EQ(row["verified"], true) << row["solver"];
    if (with_own_limit.count(row["solver"]) > 0) continue;
    EXPECT_LT(row["distance_to_direct"].get<double>(), 1e-8) << row["solver"];
  }
}

TEST_F(CompareCommand, TakesSolversWithOptions) {
  const Ended ended =
      Compare({"--problems=rhino", "--solvers=lbfgs/memory=5,cg,lbfgs", "--nofigures"});
  ASSERT_EQ(ended.status, 0) << ended.err;
  const auto rows = JsonLines(out_ + "/cells.jsonl");
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0]["solver"], "lbfgs/memory=5");
  EXPECT_EQ(rows[0]["options"]["memory"], "5");
  EXPECT_EQ(rows[1]["solver"], "cg");
  EXPECT_FALSE(std::filesystem::exists(out_ + "/rhino_fit.svg"));
}

TEST_F(CompareCommand, OnlyPrintsWithoutAFolder) {
  const Ended ended = RunBatten({"compare", "--problems=rhino", "--solvers=cg", "--repetitions=1"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("gradient_small"));
  EXPECT_THAT(ended.out, Not(HasSubstr("Files:")));
}

TEST_F(CompareCommand, CountsAFailedSolverOnlyIfStrict) {
  const std::vector<std::string> flags = {"--problems=rhino", "--solvers=lspia,gim",
                                          "--max_iterations=5", "--nofigures"};
  EXPECT_EQ(Compare(flags).status, 0);
  std::vector<std::string> strict = flags;
  strict.push_back("--strict");
  const Ended ended = Compare(strict);
  EXPECT_EQ(ended.status, 1);
  EXPECT_EQ(Lines(ended.err).size(), 1u);
  EXPECT_THAT(ended.err, HasSubstr("lspia"));
  EXPECT_THAT(ended.out, HasSubstr("iteration_limit"));
}

TEST_F(CompareCommand, ResumesWithoutRunningAgainWhatIsTheSame) {
  const std::vector<std::string> flags = {"--problems=rhino,cat", "--solvers=lbfgs,banded_qr,gim"};
  ASSERT_EQ(Compare(flags).status, 0);
  // Times differ from run to run: equal tables are those of the first one.
  const std::string table = ReadFile(out_ + "/table.csv");
  const std::string report = ReadFile(out_ + "/table.md");
  std::vector<std::string> resumed = flags;
  resumed.push_back("--resume");
  const Ended ended = Compare(resumed);
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(ReadFile(out_ + "/table.csv"), table);
  EXPECT_EQ(ReadFile(out_ + "/table.md"), report);

  resumed.push_back("--gradient_tolerance=1e-6");
  ASSERT_EQ(Compare(resumed).status, 0);
  EXPECT_NE(ReadFile(out_ + "/table.csv"), table);
  ASSERT_EQ(Compare(flags).status, 0);
  EXPECT_NE(ReadFile(out_ + "/table.csv"), table) << "not resumed, but not run again";
}

TEST_F(CompareCommand, KeepsFinishedProblemsWhenInterruptedAndGoesOn) {
  const std::string slow = WriteProblem("slow", DataFile("coasts/great_britain_10m.csv"),
                                        R"("degree": 9, "closed": true, "control_points": 3697)");
  const std::vector<std::string> arguments = {"compare",
                                              "--problems=rhino," + slow,
                                              "--solvers=lspia",
                                              "--gradient_tolerance=0",
                                              "--max_iterations=1000000",
                                              "--repetitions=1",
                                              "--max_seconds=60",
                                              "--out=" + out_,
                                              "--quiet"};
  Program program(arguments);
  for (int i = 0; i < 3000 && !std::filesystem::exists(out_ + "/cells.jsonl"); ++i) usleep(20000);
  usleep(300000);
  program.Send(SIGINT);
  const Ended ended = program.Wait();
  EXPECT_EQ(ended.status, 130);
  EXPECT_EQ(Lines(ended.err).size(), 1u);
  EXPECT_THAT(ended.err, HasSubstr("interrupted"));
  const auto rows = JsonLines(out_ + "/cells.jsonl");
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0]["problem"], "rhino");
  EXPECT_EQ(Lines(ReadFile(out_ + "/table.csv")).size(), 2u);
  EXPECT_EQ(json::parse(ReadFile(out_ + "/table.json"))["interrupted"], true);
  for (const auto& entry : std::filesystem::directory_iterator(out_)) {
    EXPECT_NE(entry.path().extension(), ".tmp");
  }
  // Times differ from run to run: the same one is that of the finished problem.
  ASSERT_EQ(RunBatten({"compare", "--problems=rhino", "--solvers=lspia", "--gradient_tolerance=0",
                       "--max_iterations=1000000", "--repetitions=1", "--out=" + out_, "--resume"})
                .status,
            0);
  EXPECT_EQ(json::parse(ReadFile(out_ + "/table.json"))["rows"][0]["seconds"], rows[0]["seconds"]);
}

TEST_F(CompareCommand, TakesProblemFiles) {
  folder_.Write("points.csv", "x,y\n0,0\n1,3\n2,-1\n3,4\n5,2\n6,0\n");
  const std::string problem = WriteProblem("mine", "points.csv", R"("control_points": 5)");
  const Ended ended = Compare({"--problems=" + problem, "--solvers=banded_qr,lbfgs"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ReadFile(out_ + "/mine_fit.svg"), HasSubstr("</svg>"));
  const std::string bad = WriteProblem("bad", "points.csv", R"("control_points": 0)");
  ExpectRefused(Compare({"--problems=" + bad}), {"--problems: ", "control_points"});
}

TEST_F(CompareCommand, ShowsALimitThatIsNotTheMinimumAsOne) {
  const std::string problem =
      folder_.Write("faired.json", R"({"name": "faired", "data": ")" BATTEN_SOURCE_DIR
                                   R"(/data/animals/rhino_100.csv", "spline": {"closed": true,)"
                                   R"( "control_points": 100},)"
                                   R"( "terms": ["interpolation", "fairing/weight=1e-7"]})");
  const std::vector<std::string> flags = {
      "--problems=" + problem, "--solvers=gim,extended_pia,lspia,banded_qr", "--nofigures"};
  // No claim fails, and what does not claim the minimum disagrees with nothing.
  const Ended ended = Compare(flags);
  EXPECT_EQ(ended.status, 0) << ended.err;
  const auto table = json::parse(ReadFile(out_ + "/table.json"));
  EXPECT_TRUE(table["disagreements"].empty());
  const auto& rows = table["rows"];
  for (const std::size_t k : {0U, 1U}) {
    EXPECT_EQ(rows[k]["stop"], "native_stop");
    EXPECT_EQ(rows[k]["verified"], true);
    EXPECT_TRUE(rows[k]["observed_rate"].is_null());
    EXPECT_GT(rows[k]["energy"].get<double>(), 1.005 * rows[3]["energy"].get<double>());
    EXPECT_GT(rows[k]["distance_to_direct"].get<double>(), 1e-4);
  }
  EXPECT_LT(rows[2]["distance_to_direct"].get<double>(), 1e-8);
  std::vector<std::string> strict = flags;
  strict.push_back("--strict");
  EXPECT_EQ(Compare(strict).status, 1);
}

TEST_F(CompareCommand, RefusesBadDataBeforeItRunsAnything) {
  const auto refuse = [&](const std::string& points, const std::vector<std::string>& parts) {
    folder_.Write("bad.csv", points);
    const std::string bad = WriteProblem("bad", "bad.csv", R"("control_points": 5)");
    // The good one comes first.
    ExpectRefused(Compare({"--problems=rhino," + bad, "--solvers=cg"}), parts);
    EXPECT_FALSE(std::filesystem::exists(out_));
  };
  const std::string file = "bad.csv";
  refuse("", {file + ":1:", "no data point"});
  refuse("x,y\n1,2\n", {"found 1 data point", "at least 2"});
  refuse("x,y\n0,0\n1,nan\n2,0\n", {file + ":3:2:", "\"nan\""});
  refuse("x,y\n0,0\ninf,1\n2,0\n", {file + ":3:1:", "\"inf\""});
  refuse("x,y\n0,0\n1\n2,0\n", {file + ":3:", "row length 1"});
  refuse("x,y\n0,0\n1,2m\n2,0\n", {file + ":3:2:", "\"2m\""});
  refuse("x,y\n0,0\n1e308,1\n2,0\n", {file + ":3:1:", "1e308"});
  ExpectRefused(Compare({"--problems=rihno"}), {"--problems: ", "did you mean rhino"});
  ExpectRefused(Compare({"--problems=rhino", "--solvers=lbgfs"}),
                {"--solvers: ", "did you mean lbfgs"});
  ExpectRefused(Compare({"--problems=rhino", "--problem=cat"}), {"problem", "did you mean"});
}

TEST_F(CompareCommand, TellsAFullDiskAndKeepsWhatIsWhole) {
  Program::Streams streams;
  streams.file_size = 300;  // less than any table
  const Ended ended = Program({"compare", "--problems=rhino", "--solvers=banded_qr,cg",
                               "--repetitions=1", "--out=" + out_},
                              streams)
                          .Wait();
  EXPECT_EQ(ended.signal, 0);
  EXPECT_EQ(ended.status, 2) << ended.err;
  EXPECT_EQ(Lines(ended.err).size(), 1u) << ended.err;
  EXPECT_THAT(ended.err, HasSubstr("File too large"));
  for (const auto& entry : std::filesystem::recursive_directory_iterator(out_)) {
    // An empty one is made when it is tried, before the work, whether it can be written.
    if (!entry.is_regular_file() || entry.file_size() == 0) continue;
    ADD_FAILURE() << entry.path() << " is half written, or a file of a part of the work";
  }
  EXPECT_EQ(Compare({"--problems=rhino", "--solvers=banded_qr,cg", "--resume"}).status, 0);
  EXPECT_EQ(json::parse(ReadFile(out_ + "/table.json"))["rows"].size(), 2u);
}

TEST_F(CompareCommand, RefusesAFolderThatCannotBe) {
  const std::string file = folder_.Write("file", "");
  ExpectRefused(RunBatten({"compare", "--problems=rhino", "--out=" + file + "/out"}),
                {"--out: cannot create folder"});
  ExpectRefused(RunBatten({"compare", "--problems=rhino", "--out=" + file}), {"--out: "});
  ExpectRefused(RunBatten({"compare", "rhino"}), {"found rhino"});
}

}  // namespace
}  // namespace batten
