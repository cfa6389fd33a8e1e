// `bench`, `merge` and `regress` as processes: bad suites, killed runs, a full disk, parts.
#include <gmock/gmock.h>

#include <cstdlib>
#include <functional>
#include <map>
#include <random>
#include <set>

#include "tests/tools/page_text.h"
#include "tests/tools/program.h"

namespace batten {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

json GoodSuite() {
  return {{"format", "batten.suite/1"},
          {"name", "good"},
          {"problems",
           {{{"synthetic", "star"}, {"name", "star"}, {"points", 60}, {"control_points", {8, 12}}},
            {{"synthetic", "wave"}, {"name", "wave"}, {"points", 40}, {"control_points", 9}}}},
          {"solvers",
           {"banded_cholesky",
            "cg",
            {{"solver", "lbfgs"}, {"options", {{"memory", {3, 10}}}}},
            "lspia"}},
          {"budgets", {{"seconds", 20}, {"iterations", 200}}},
          {"warm_up", 0},
          {"repetitions", 4}};
}

class Bench : public ::testing::Test {
 protected:
  std::string Suite(const json& suite) const { return folder_.Write("suite.json", suite.dump()); }
  std::vector<std::string> Arguments(const std::string& suite, const std::string& out) const {
    return {"bench", suite, "--out=" + (folder_ / out), "--nofigures", "--quiet"};
  }
  Ended RunIn(const std::string& suite, const std::string& out,
              const std::string& flag = "") const {
    std::vector<std::string> arguments = Arguments(suite, out);
    if (!flag.empty()) arguments.push_back(flag);
    return RunBatten(arguments);
  }
  /// The table without the columns of time, which stand last.
  std::vector<std::string> TimelessTable(const std::string& out) const {
    std::vector<std::string> lines = Lines(ReadFile(folder_ / (out + "/table.csv")));
    constexpr int kTimes = 4;
    EXPECT_THAT(lines.at(0), ::testing::EndsWith(",seconds,seconds_low,seconds_high,work_units"));
    for (std::string& line : lines) {
      for (int k = 0; k < kTimes; ++k) line.resize(line.rfind(','));
    }
    return lines;
  }
  /// Keys of the rows, each of which is whole.
  std::multiset<std::string> Keys(const std::string& out) const {
    std::multiset<std::string> keys;
    for (const std::string& line : Lines(ReadFile(folder_ / (out + "/cells.jsonl")))) {
      keys.insert(json::parse(line)["key"].get<std::string>());
    }
    return keys;
  }

  /// Iterates by run: first repetitions alone have some, whose number the row says.
  std::map<std::string, std::string> Iterates(const std::string& out) const {
    std::map<std::string, std::string> iterates;
    for (const std::string& line : Lines(ReadFile(folder_ / (out + "/cells.jsonl")))) {
      const json row = json::parse(line);
      const std::string key = row["key"].get<std::string>();
      const std::string path = folder_ / (out + "/iterates/" + key + ".jsonl");
      EXPECT_EQ(std::filesystem::exists(path), row["iterate_rows"] > 0);
      if (row["iterate_rows"] == 0) continue;
      iterates[key] = ReadFile(path);
      EXPECT_EQ(Lines(iterates[key]).size(), row["iterate_rows"].get<std::size_t>());
      EXPECT_TRUE(std::filesystem::exists(
          folder_ / (out + "/curves/" + row["instance"].get<std::string>() + ".json")));
    }
    return iterates;
  }

  TemporaryFolder folder_;
};

TEST_F(Bench, DryRunPrintsTheMatrixAndWritesNothing) {
  const Ended ended = RunBatten({"bench", Suite(GoodSuite()), "--dry_run"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  const std::vector<std::string> lines = Lines(ended.out);
  // 3 problems x 5 solvers x 4 repetitions, and the total.
  ASSERT_EQ(lines.size(), 61u);
  EXPECT_EQ(lines.back(), "60 cells: 3 instances, 5 solvers, 4 repetitions");
  EXPECT_THAT(lines, ::testing::Contains(
                         "star/control_points=12 | own | lbfgs/memory=3 | seed 1 | repetition 2"));
  EXPECT_EQ(RunBatten({"bench", Suite(GoodSuite()), "--dry_run"}).out, ended.out);
  EXPECT_EQ(folder_.Names(), std::vector<std::string>{"suite.json"});
}

TEST_F(Bench, KilledAtRandomTimesEndsWithTheSameTable) {
  const std::string suite = Suite(GoodSuite());
  ASSERT_EQ(RunIn(suite, "undisturbed").status, 0);
  std::mt19937 random(20261128);
  constexpr int kKills = 8;
  int killed = 0;
  for (int k = 0; k < kKills; ++k) {
    Program program(Arguments(suite, "killed"));
    constexpr int kLongest = 150'000;  // microseconds
    usleep(10'000 + random() % kLongest);
    program.Send(SIGKILL);
    killed += program.Wait().signal == SIGKILL ? 1 : 0;
  }
  EXPECT_GT(killed, 0);
  const Ended ended = RunIn(suite, "killed");
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(TimelessTable("killed"), TimelessTable("undisturbed"));
  EXPECT_EQ(Iterates("killed"), Iterates("undisturbed"));
  EXPECT_EQ(Keys("killed"), Keys("undisturbed"));
  const auto keys = Keys("killed");
  EXPECT_EQ(keys.size(), 60u);
  EXPECT_EQ(std::set<std::string>(keys.begin(), keys.end()).size(), 60u);
}

TEST_F(Bench, KeepsSomeIteratesOfTheFirstRepetition) {
  json suite = GoodSuite();
  suite["repetitions"] = 2;
  suite["keep_iterates"] = 7;
  ASSERT_EQ(RunIn(Suite(suite), "out").status, 0);
  for (const std::string& line : Lines(ReadFile(folder_ / "out/cells.jsonl"))) {
    const json row = json::parse(line);
    if (row["repetition"] == 2) {
      EXPECT_EQ(row["iterate_rows"], 0);
      continue;
    }
    // All of a short run, 7 of a longer one, from the start to the end of it.
    const int iterations = row["iterations"].get<int>();
    EXPECT_EQ(row["iterate_rows"], std::min(7, iterations + 1));
    const std::vector<std::string> lines = Lines(Iterates("out").at(row["key"].get<std::string>()));
    EXPECT_EQ(json::parse(lines.front())["iteration"], 0);
    EXPECT_EQ(json::parse(lines.back())["iteration"], iterations);
    const std::size_t n = row["problem"] == "wave"                     ? 9
                          : row["problem"] == "star/control_points=12" ? 12
                                                                       : 8;
    for (const std::string& iterate : lines) {
      EXPECT_EQ(json::parse(iterate)["control_points"].size(), n);
    }
  }
  suite["keep_iterates"] = 0;
  ASSERT_EQ(RunIn(Suite(suite), "none").status, 0);
  EXPECT_TRUE(Iterates("none").empty());
}

TEST_F(Bench, RunsAgainWhatHasLostItsIterates) {
  const std::string suite = Suite(GoodSuite());
  ASSERT_EQ(RunIn(suite, "out").status, 0);
  const auto iterates = Iterates("out");
  ASSERT_EQ(iterates.size(), 15u);  // 3 problems x 5 solvers
  const auto [lost, torn] = std::pair(iterates.begin()->first, std::next(iterates.begin())->first);
  const std::string lost_file = folder_ / ("out/iterates/" + lost + ".jsonl");
  const std::string torn_file = folder_ / ("out/iterates/" + torn + ".jsonl");
  std::filesystem::remove(lost_file);
  std::filesystem::resize_file(torn_file, std::filesystem::file_size(torn_file) - 3);
  ASSERT_EQ(RunIn(suite, "out").status, 0);
  EXPECT_EQ(ReadFile(lost_file), iterates.at(lost));
  EXPECT_EQ(ReadFile(torn_file), iterates.at(torn));
  // The two cells that ran again, and no other, have a second row.
  const auto keys = Keys("out");
  EXPECT_EQ(keys.size(), 62u);
  EXPECT_EQ(keys.count(lost), 2u);
  EXPECT_EQ(keys.count(torn), 2u);
}

TEST_F(Bench, ThePageHasAPlayerOfEachInstance) {
  json suite = GoodSuite();
  suite["repetitions"] = 2;
  suite["terms"] = {"distance", "distance,fairing/weight=1e-4"};
  ASSERT_EQ(RunIn(Suite(suite), "out").status, 0);
  ASSERT_EQ(RunBatten({"report", folder_ / "out"}).status, 0);
  const std::string page = ReadFile(folder_ / "out/report.html");
  const json curves = json::parse(ScriptText(page, "curves-data"));
  EXPECT_EQ(curves["runs"].size(), 30u);  // 3 problems x 2 terms x 5 solvers, once
  for (const json& run : curves["runs"]) {
    ASSERT_TRUE(curves["problems"].contains(run["curve"].get<std::string>()));
    EXPECT_LE(run["points"].size(), 20u);
  }
  // Terms do not change what curves are drawn by.
  EXPECT_EQ(curves["problems"].size(), 3u);
  const json summary = json::parse(ScriptText(page, "summary-data"));
  EXPECT_THAT(summary["bench_notes"][0].get<std::string>(),
              HasSubstr("60 of 60 cells are finished."));
}

TEST_F(Bench, DrawsEachKindOfParametersByItself) {
  json suite = GoodSuite();
  suite["problems"][0]["control_points"] = 8;
  suite["problems"][0]["parameter_kind"] = {"fixed", "free"};
  suite["solvers"] = {"banded_cholesky", "lbfgs", "foot_newton"};
  suite["repetitions"] = 1;
  ASSERT_EQ(RunBatten({"bench", Suite(suite), "--out=" + (folder_ / "out"), "--quiet"}).status, 0);
  for (const char* figure : {"performance_profiles", "data_profiles", "runtime_distributions"}) {
    const std::string stem = folder_ / ("out/" + std::string(figure));
    const std::string fixed = ReadFile(stem + "_fixed.gp"), free = ReadFile(stem + "_free.gp");
    EXPECT_THAT(fixed, HasSubstr("banded_cholesky"));
    EXPECT_THAT(fixed, ::testing::Not(HasSubstr("foot_newton")));
    EXPECT_THAT(fixed, ::testing::Not(HasSubstr("basin")));
    EXPECT_THAT(free, HasSubstr("foot_newton"));
    EXPECT_THAT(free, ::testing::Not(HasSubstr("banded_cholesky")));
    EXPECT_THAT(free, HasSubstr("own basin"));
    EXPECT_TRUE(std::filesystem::exists(stem + "_free.svg"));
    EXPECT_FALSE(std::filesystem::exists(stem + "_projected.svg"));
  }
}

TEST_F(Bench, CutsATornLastLine) {
  const std::string suite = Suite(GoodSuite());
  ASSERT_EQ(RunIn(suite, "out").status, 0);
  const auto table = TimelessTable("out");
  const std::string cells = folder_ / "out/cells.jsonl";
  std::filesystem::resize_file(cells, std::filesystem::file_size(cells) - 10);
  const Ended ended = RunIn(suite, "out");
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(Keys("out").size(), 60u);
  EXPECT_EQ(TimelessTable("out"), table);
}

TEST_F(Bench, OnAFullDiskLosesNothingThatIsFinished) {
  const std::string suite = Suite(GoodSuite());
  Program::Streams streams;
  streams.file_size = 40'000;  // of cells.jsonl some 20 rows
  const Ended full = Program(Arguments(suite, "out"), streams).Wait();
  EXPECT_EQ(full.status, 2);
  EXPECT_EQ(Lines(full.err).size(), 1u) << full.err;
  EXPECT_THAT(full.err, HasSubstr("cannot write"));
  const auto kept = Keys("out");
  EXPECT_GT(kept.size(), 5u);
  EXPECT_LT(kept.size(), 60u);
  const std::string before = ReadFile(folder_ / "out/cells.jsonl");
  ASSERT_EQ(RunIn(suite, "out").status, 0);
  EXPECT_EQ(ReadFile(folder_ / "out/cells.jsonl").substr(0, before.size()), before);
  EXPECT_EQ(Keys("out").size(), 60u);
}

TEST_F(Bench, ATraceThatIsTooLongForItsFileIsAnErrorOfWriting) {
  json suite = GoodSuite();
  suite["solvers"] = {"lspia"};
  suite["problems"].erase(0);
  suite["budgets"] = {{"iterations", 1000}};
  suite["rule"] = {{"gradient_tolerance", 0}};
  Program::Streams streams;
  streams.file_size = 20'000;  // a row of a trace has more than 50 bytes
  const Ended full = Program(Arguments(Suite(suite), "out"), streams).Wait();
  ExpectRefused(full, {"cannot write", "out/traces/", ".csv: File too large"});
  EXPECT_TRUE(Keys("out").empty());
  EXPECT_TRUE(std::filesystem::is_empty(folder_ / "out/traces"));
}

TEST_F(Bench, PartsMergeToTheWhole) {
  const std::string suite = Suite(GoodSuite());
  ASSERT_EQ(RunIn(suite, "whole").status, 0);
  for (const char* part : {"1", "2"}) {
    const std::string out = std::string("part_") + part;
    ASSERT_EQ(RunIn(suite, out, std::string("--shard=") + part + "/2").status, 0);
    EXPECT_THAT(ReadFile(folder_ / (out + "/notes.md")),
                HasSubstr(std::string("this is part ") + part + "/2 alone"));
  }
  for (int twice = 0; twice < 2; ++twice) {
    const Ended merged = RunBatten(
        {"merge", folder_ / "merged", folder_ / "part_1", folder_ / "part_2", "--nofigures"});
    ASSERT_EQ(merged.status, 0) << merged.err;
    EXPECT_THAT(merged.out, HasSubstr("60 cells, 0 missing"));
    EXPECT_THAT(ReadFile(folder_ / "merged/notes.md"), ::testing::Not(HasSubstr("alone")));
    EXPECT_EQ(TimelessTable("merged"), TimelessTable("whole"));
    EXPECT_EQ(Keys("merged"), Keys("whole"));
    const json manifest = json::parse(ReadFile(folder_ / "merged/manifest.json"));
    ASSERT_EQ(manifest["sessions"].size(), 2u);
    EXPECT_EQ(manifest["sessions"][0]["shard"], "1/2");
    EXPECT_EQ(manifest["sessions"][1]["shard"], "2/2");
    EXPECT_EQ(Iterates("merged"), Iterates("whole"));
  }
}

TEST_F(Bench, AChangedDataFileRunsItsOwnCellsAgain) {
  json suite = GoodSuite();
  suite["problems"] = json::array();
  std::string points = "x,y\n";
  for (int i = 0; i < 30; ++i) points += std::to_string(i) + "," + std::to_string(i * i % 7) + "\n";
  for (const std::string name : {"changes", "stays"}) {
    folder_.Write(name + ".csv", points);
    suite["problems"].push_back({{"data", name + ".csv"}, {"name", name}, {"control_points", 8}});
  }
  suite["solvers"] = {"cg", "lbfgs"};
  suite["repetitions"] = 1;
  const auto RowsOf = [this](const std::string& problem) {
    int count = 0;
    for (const std::string& line : Lines(ReadFile(folder_ / "out/cells.jsonl"))) {
      count += json::parse(line)["problem"] == problem ? 1 : 0;
    }
    return count;
  };
  ASSERT_EQ(RunIn(Suite(suite), "out").status, 0);
  folder_.Write("changes.csv", points + "30,5\n");
  ASSERT_EQ(RunIn(Suite(suite), "out").status, 0);
  EXPECT_EQ(RowsOf("changes"), 4);
  EXPECT_EQ(RowsOf("stays"), 2);
  // The table is of what is there now.
  EXPECT_EQ(TimelessTable("out").size(), 5u);
  ASSERT_EQ(RunIn(Suite(suite), "out").status, 0);
  EXPECT_EQ(RowsOf("changes"), 4);
}

TEST_F(Bench, AChangedProgramRunsAllCellsAgain) {
  json suite = GoodSuite();
  suite["solvers"] = {"cg"};
  suite["repetitions"] = 1;
  const std::string program = folder_ / "batten";
  std::filesystem::copy(BATTEN_BINARY, program);
  const std::string command = program + " bench " + Suite(suite) + " --out=" + (folder_ / "out") +
                              " --nofigures --quiet > /dev/null";
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_EQ(Keys("out").size(), 3u);
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_EQ(Keys("out").size(), 3u);
  std::ofstream(program, std::ios::app) << "what stands behind a program changes no run of it";
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_EQ(Keys("out").size(), 6u);
}

TEST_F(Bench, MergeRefusesAnotherSuite) {
  json other = GoodSuite();
  other["problems"].erase(0);
  ASSERT_EQ(RunIn(Suite(GoodSuite()), "one").status, 0);
  ASSERT_EQ(RunIn(Suite(other), "two").status, 0);
  ExpectRefused(RunBatten({"merge", folder_ / "out", folder_ / "one", folder_ / "two"}),
                {"another suite"});
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

TEST_F(Bench, MoreJobsAreMarkedAndLeftOutOfTime) {
  const std::string suite = Suite(GoodSuite());
  ASSERT_EQ(RunIn(suite, "alone").status, 0);
  ASSERT_EQ(RunIn(suite, "out", "--jobs=2").status, 0);
  for (const std::string& line : Lines(ReadFile(folder_ / "out/cells.jsonl"))) {
    EXPECT_EQ(json::parse(line)["overlapped"], true);
  }
  EXPECT_EQ(TimelessTable("out"), TimelessTable("alone"));
  for (const std::string& line : Lines(ReadFile(folder_ / "out/table.csv"))) {
    if (line.rfind("problem", 0) == 0) continue;
    EXPECT_THAT(line, ::testing::EndsWith(",,,,"));
  }
}

TEST_F(Bench, RegressFindsAWorseResult) {
  const std::string suite = Suite(GoodSuite());
  ASSERT_EQ(RunIn(suite, "before").status, 0);
  std::filesystem::copy(folder_ / "before", folder_ / "now",
                        std::filesystem::copy_options::recursive);
  const Ended same = RunBatten({"regress", folder_ / "before", folder_ / "now"});
  EXPECT_EQ(same.status, 0) << same.err;
  EXPECT_THAT(same.out, HasSubstr("15 runs in both"));
  std::string edited;
  for (const std::string& line : Lines(ReadFile(folder_ / "now/cells.jsonl"))) {
    json row = json::parse(line);
    if (row["solver"] == "cg" && row["problem"] == "wave") row["stop"] = "diverged";
    edited += row.dump() + "\n";
  }
  folder_.Write("now/cells.jsonl", edited);
  const Ended worse = RunBatten({"regress", folder_ / "before", folder_ / "now"});
  EXPECT_EQ(worse.status, 4);
  EXPECT_THAT(worse.err, HasSubstr("wave | own: cg: gradient_small before, diverged now"));
}

TEST_F(Bench, RegressDoesNotTakeABeliedClaimInAnyRepetition) {
  ASSERT_EQ(RunIn(Suite(GoodSuite()), "before").status, 0);
  std::filesystem::copy(folder_ / "before", folder_ / "now",
                        std::filesystem::copy_options::recursive);
  std::string edited;
  for (const std::string& line : Lines(ReadFile(folder_ / "now/cells.jsonl"))) {
    json row = json::parse(line);
    if (row["solver"] == "cg" && row["problem"] == "wave" && row["repetition"] == 3) {
      row["findings"] = {"claim_fails"};
    }
    edited += row.dump() + "\n";
  }
  folder_.Write("now/cells.jsonl", edited);
  EXPECT_EQ(RunBatten({"regress", folder_ / "before", folder_ / "now"}).status, 4);
}

TEST_F(Bench, PairsLeaveOutInstancesToWhichOneDoesNotApply) {
  json suite = GoodSuite();
  suite["solvers"] = {"banded_cholesky", "cg", "foot_newton"};  // the last: free parameters only
  ASSERT_EQ(RunIn(Suite(suite), "out").status, 0);
  const std::vector<std::string> lines = Lines(ReadFile(folder_ / "out/pairs.csv"));
  int with_cg = 0;
  for (const std::string& line : lines) {
    EXPECT_THAT(line, ::testing::Not(HasSubstr("foot_newton")));
    with_cg += line.find("banded_cholesky,cg,") != std::string::npos ? 1 : 0;
  }
  EXPECT_GT(with_cg, 0);
}

TEST_F(Bench, CountsExcludedCellsApart) {
  json suite = GoodSuite();
  suite["solvers"] = {"banded_cholesky", "cg"};
  suite["exclude"] = {{{"problems", {"wave"}}, {"solvers", {"cg"}}}};
  const Ended ended = RunIn(Suite(suite), "out");
  ASSERT_EQ(ended.status, 0) << ended.err;
  // Of three instances.
  EXPECT_THAT(ended.out, ::testing::ContainsRegex("cg +2/2 .* 1 not run\n"));
  EXPECT_THAT(ended.out, ::testing::ContainsRegex("banded_cholesky +3/3 "));
  const std::string solvers = ReadFile(folder_ / "out/solvers.csv");
  EXPECT_THAT(solvers, HasSubstr("gap 0.1,fixed,cg,3,1,2,"));
  EXPECT_THAT(solvers, HasSubstr("gap 0.1,fixed,banded_cholesky,3,0,3,"));
}

TEST_F(Bench, RegressTestsTimesOfAllCells) {
  const std::string suite = Suite(GoodSuite());
  ASSERT_EQ(RunIn(suite, "before").status, 0);
  std::filesystem::copy(folder_ / "before", folder_ / "now",
                        std::filesystem::copy_options::recursive);
  std::string edited;
  for (const std::string& line : Lines(ReadFile(folder_ / "now/cells.jsonl"))) {
    json row = json::parse(line);
    row["seconds"] = 1.2 * row["seconds"].get<double>();
    edited += row.dump() + "\n";
  }
  folder_.Write("now/cells.jsonl", edited);
  const Ended slower = RunBatten({"regress", folder_ / "before", folder_ / "now"});
  EXPECT_EQ(slower.status, 4) << slower.out;
  EXPECT_THAT(slower.err, HasSubstr("all solvers need 1.20 times the seconds"));
  EXPECT_EQ(RunBatten({"regress", folder_ / "before", folder_ / "now", "--slowdown=0.5"}).status,
            0);
}

struct BadSuite {
  const char* name;
  std::function<void(json*)> spoil;
  std::vector<std::string> parts;  // of the message
};
void PrintTo(const BadSuite& bad, std::ostream* stream) { *stream << bad.name; }

class BadSuites : public Bench, public ::testing::WithParamInterface<BadSuite> {};

TEST_P(BadSuites, GetOneLineWithThePath) {
  json suite = GoodSuite();
  GetParam().spoil(&suite);
  std::vector<std::string> parts = GetParam().parts;
  parts.push_back("suite.json: /");
  ExpectRefused(RunBatten({"bench", Suite(suite), "--out=" + (folder_ / "out")}), parts);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

INSTANTIATE_TEST_SUITE_P(
    BenchCommand, BadSuites,
    ::testing::Values(
        BadSuite{"UnknownKey",
                 [](json* s) { (*s)["repetition"] = 3; },
                 {"unknown key", "did you mean repetitions?"}},
        BadSuite{"NoFormat", [](json* s) { s->erase("format"); }, {"/format: found nothing"}},
        BadSuite{"WrongType",
                 [](json* s) { (*s)["repetitions"] = "five"; },
                 {"/repetitions: found \"five\"; allowed: 1 to 1000"}},
        BadSuite{"NoProblems",
                 [](json* s) { (*s)["problems"] = json::array(); },
                 {"/problems: found an empty list"}},
        BadSuite{"ProblemUnknown",
                 [](json* s) { (*s)["problems"][0] = "rihno"; },
                 {"/problems/0", "did you mean rhino?"}},
        BadSuite{"ProblemKey",
                 [](json* s) { (*s)["problems"][0]["point"] = 3; },
                 {"/problems/0", "did you mean points?"}},
        BadSuite{
            "MissingFile",
            [](json* s) {
              (*s)["problems"][0] = {{"data", "no/such.csv"}, {"name", "x"}, {"control_points", 9}};
            },
            {"/problems/0/data: found \"no/such.csv\"; allowed: a file in"}},
        BadSuite{"EmptyGrid",
                 [](json* s) { (*s)["problems"][0]["control_points"] = json::array(); },
                 {"/problems/0/control_points: found an empty list"}},
        BadSuite{"GridValue",
                 [](json* s) {
                   (*s)["problems"][0]["control_points"] = {8, -3};
                 },
                 {"/problems/0/control_points/1: found -3"}},
        BadSuite{"TooFewControlPoints",
                 [](json* s) { (*s)["problems"][1]["control_points"] = 2; },
                 {"/problems/1/control_points: found 2; allowed: more than the degree, 3"}},
        BadSuite{"SolverUnknown",
                 [](json* s) { (*s)["solvers"][1] = "gc"; },
                 {"/solvers/1", "did you mean cg?"}},
        BadSuite{"SolverOption",
                 [](json* s) {
                   (*s)["solvers"][2]["options"] = {{"memry", {3}}};
                 },
                 {"/solvers/2/options/memry", "memory"}},
        BadSuite{"SolverOptionRange",
                 [](json* s) {
                   (*s)["solvers"][2]["options"] = {{"memory", {3, 0}}};
                 },
                 {"/solvers/2/options/memory"}},
        BadSuite{"EmptyOptionGrid",
                 [](json* s) {
                   (*s)["solvers"][2]["options"] = {{"memory", json::array()}};
                 },
                 {"/solvers/2/options/memory: found an empty list"}},
        BadSuite{"SolverTwice",
                 [](json* s) { (*s)["solvers"][0] = "lbfgs"; },
                 {"/solvers/2: found lbfgs/memory=10 twice"}},
        BadSuite{"Term",
                 [](json* s) { (*s)["terms"] = {"distance,fairnig"}; },
                 {"/terms/0", "did you mean fairing?"}},
        BadSuite{"NegativeBudget",
                 [](json* s) { (*s)["budgets"]["seconds"] = -1; },
                 {"/budgets/seconds: found -1; allowed: 0.001 to"}},
        BadSuite{"BudgetKey",
                 [](json* s) {
                   (*s)["budgets"] = {{"second", 1}};
                 },
                 {"/budgets", "did you mean seconds?"}},
        BadSuite{"ModeWord",
                 [](json* s) {
                   (*s)["rule"] = {{"mode", "rase"}};
                 },
                 {"/rule/mode", "did you mean race?"}},
        BadSuite{"OneIterate",
                 [](json* s) { (*s)["keep_iterates"] = 1; },
                 {"/keep_iterates: found 1; allowed: 0, or 2 to 1000"}},
        BadSuite{"Target",
                 [](json* s) {
                   (*s)["targets"] = {{"gaps", {0.1, 2}}};
                 },
                 {"/targets/gaps/1: found 2"}},
        BadSuite{"Seeds",
                 [](json* s) {
                   (*s)["seeds"] = {{"start", {1, 1.5}}};
                 },
                 {"/seeds/start/1: found 1.5"}},
        BadSuite{"ExclusionOfNothing",
                 [](json* s) {
                   (*s)["exclude"] = {{{"solvers", {"gim*"}}}};
                 },
                 {"/exclude/0: matches nothing"}},
        BadSuite{"ExclusionOfAll",
                 [](json* s) {
                   (*s)["exclude"] = {{{"solvers", {"*"}}}};
                 },
                 {"/exclude: leaves nothing to run"}}),
    [](const auto& bad) { return std::string(bad.param.name); });

TEST_F(Bench, RefusesBadFlags) {
  const std::string suite = Suite(GoodSuite());
  ExpectRefused(RunBatten({"bench", suite}), {"--out"});
  ExpectRefused(RunBatten({"bench"}), {"one suite"});
  for (const char* shard : {"0/2", "3/2", "1", "a/b", "1.5/2"}) {
    ExpectRefused(RunBatten({"bench", suite, "--dry_run", std::string("--shard=") + shard}),
                  {"--shard: found", "I/N"});
  }
  ExpectRefused(RunBatten({"bench", folder_ / "none.json", "--dry_run"}), {"none.json"});
  ExpectRefused(RunBatten({"regress", folder_ / "a", folder_ / "b"}), {"manifest.json"});
}

}  // namespace
}  // namespace batten
