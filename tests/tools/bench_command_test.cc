// `bench` and `merge` as processes: killed runs, a full disk, parts.
#include <gmock/gmock.h>

#include <cstdlib>
#include <map>
#include <random>
#include <set>

#include "tests/tools/bench_fixture.h"
#include "tests/tools/page_text.h"

namespace batten {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

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

TEST_F(Bench, TermsThatAreTheSameOnSomeProblemsRunOnceThere) {
  json suite = GoodSuite();
  // Of a file: another problem with its own terms than with the distance.
  folder_.Write("faired.json", json({{"name", "faired"},
                                     {"data", "animals/rhino_100.csv"},
                                     {"spline", {{"control_points", 20}}},
                                     {"terms", {"interpolation", "fairing/weight=1e-3"}}})
                                   .dump());
  suite["problems"][0] = folder_ / "faired.json";
  suite["terms"] = {"own", "distance"};
  suite["solvers"] = {"banded_cholesky", "cg"};
  suite["repetitions"] = 1;
  const Ended dry = RunBatten({"bench", Suite(suite), "--dry_run"});
  ASSERT_EQ(dry.status, 0) << dry.err;
  const std::string left_out = "wave | distance: left out, the same problem as with terms own";
  EXPECT_THAT(Lines(dry.out), ::testing::Contains(left_out));
  EXPECT_THAT(dry.out, HasSubstr("6 cells: 3 instances"));
  ASSERT_EQ(RunIn(Suite(suite), "out").status, 0);
  EXPECT_EQ(Keys("out").size(), 6u);
  EXPECT_THAT(ReadFile(folder_ / "out/notes.md"),
              HasSubstr("distance: left out, the same problem as with terms own"));
  // What is excluded under its first name runs under the second.
  suite["exclude"] = {{{"problems", {"wave"}}, {"terms", {"own"}}, {"solvers", {"cg"}}}};
  EXPECT_THAT(Lines(RunBatten({"bench", Suite(suite), "--dry_run"}).out),
              ::testing::Contains("wave | distance | cg | seed 1 | repetition 1"));
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

TEST_F(Bench, KeepsAllIteratesInTheFolderAndShowsSomeOfThem) {
  json suite = GoodSuite();
  suite["repetitions"] = 1;
  ASSERT_EQ(RunIn(Suite(suite), "out").status, 0);
  ASSERT_EQ(RunBatten({"report", folder_ / "out"}).status, 0);
  const std::string page = ReadFile(folder_ / "out/report.html");
  const json runs = json::parse(ScriptText(page, "curves-data"))["runs"];
  int longest = 0;
  for (const auto& [key, text] : Iterates("out")) {
    const std::vector<std::string> lines = Lines(text);
    EXPECT_EQ(Lines(ReadFile(folder_ / ("out/traces/" + key + ".csv"))).size(), lines.size() + 1);
    for (std::size_t k = 0; k < lines.size(); ++k) {
      ASSERT_EQ(json::parse(lines[k])["iteration"], k);
    }
    const int last = static_cast<int>(lines.size()) - 1;
    const json shown = runs[key]["iterations"];
    EXPECT_EQ(shown.size(), std::min<std::size_t>(40, lines.size()));
    EXPECT_EQ(shown.front(), 0);
    EXPECT_EQ(shown.back(), last);
    longest = std::max(longest, last);
  }
  EXPECT_GT(longest, 40);  // or nothing was thinned
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
    EXPECT_LE(run["points"].size(), 40u);
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

TEST_F(Bench, SaysWhichLineIsNoRowAndRunsItsCellAgain) {
  json suite = GoodSuite();
  suite["solvers"] = {"cg"};
  suite["repetitions"] = 2;
  ASSERT_EQ(RunIn(Suite(suite), "out").status, 0);
  std::vector<std::string> lines = Lines(ReadFile(folder_ / "out/cells.jsonl"));
  ASSERT_EQ(lines.size(), 6u);
  const auto Spoil = [&lines](std::size_t line, const char* key, const json& value) {
    json row = json::parse(lines[line]);
    row[key] = value;
    lines[line] = row.dump();
  };
  lines[1].resize(lines[1].size() / 2);
  Spoil(2, "stop", nullptr);
  Spoil(3, "trace_rows", "some");
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  const std::string cells = folder_.Write("out/cells.jsonl", text);
  const Ended ended = RunIn(Suite(suite), "out");
  ASSERT_EQ(ended.status, 0) << ended.err;
  for (const char* line : {":2: found \"{", ":3: found \"{"}) {
    EXPECT_THAT(ended.out, HasSubstr(cells + line));
    EXPECT_THAT(ReadFile(folder_ / "out/notes.md"), HasSubstr(line));
  }
  EXPECT_THAT(ended.out, HasSubstr("6 of 6 cells"));
  EXPECT_EQ(Lines(ReadFile(cells)).size(), 9u);
  ExpectRefused(RunBatten({"report", folder_ / "out"}), {cells + ":2: found "});
  // A part of which a line is lost says so where it is merged.
  folder_.Write("out/cells.jsonl", text);
  const Ended merged = RunBatten({"merge", folder_ / "merged", folder_ / "out", "--nofigures"});
  EXPECT_EQ(merged.status, 0) << merged.err;
  EXPECT_THAT(merged.out, HasSubstr(cells + ":2: found "));
  EXPECT_THAT(merged.out, HasSubstr("4 cells, 2 missing"));
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

TEST_F(Bench, MergeTakesAWorkUnitThatWasMeasuredLater) {
  json suite = GoodSuite();
  suite["solvers"] = {"cg"};
  suite["repetitions"] = 1;
  ASSERT_EQ(RunIn(Suite(suite), "part").status, 0);
  std::string failed;
  for (const std::string& line : Lines(ReadFile(folder_ / "part/instances.jsonl"))) {
    failed += json({{"failure", "killed"}, {"key", json::parse(line)["key"]}}).dump() + "\n";
  }
  folder_.Write("part/instances.jsonl", failed);
  const auto merge = [this] {
    EXPECT_EQ(RunBatten({"merge", folder_ / "out", folder_ / "part", "--nofigures"}).status, 0);
    std::map<std::string, json> units;
    for (const std::string& line : Lines(ReadFile(folder_ / "out/instances.jsonl"))) {
      const json instance = json::parse(line);
      units[instance["key"]] = instance.value("evaluation_seconds", json());
    }
    EXPECT_EQ(units.size(), 3u);
    return units;
  };
  for (const auto& [key, seconds] : merge()) EXPECT_TRUE(seconds.is_null());
  ASSERT_EQ(RunIn(Suite(suite), "part").status, 0);
  for (const auto& [key, seconds] : merge()) EXPECT_GT(seconds.get<double>(), 0.0);
  const std::string merged = ReadFile(folder_ / "out/instances.jsonl");
  merge();
  EXPECT_EQ(ReadFile(folder_ / "out/instances.jsonl"), merged);
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

TEST_F(Bench, RefusesBadFlags) {
  const std::string suite = Suite(GoodSuite());
  ExpectRefused(RunBatten({"bench", suite}), {"--out"});
  ExpectRefused(RunBatten({"bench"}), {"one suite"});
  for (const char* shard : {"0/2", "3/2", "1", "a/b", "1.5/2"}) {
    ExpectRefused(RunBatten({"bench", suite, "--dry_run", std::string("--shard=") + shard}),
                  {"--shard: found", "I/N"});
  }
  ExpectRefused(RunBatten({"bench", folder_ / "none.json", "--dry_run"}), {"none.json"});
}

}  // namespace
}  // namespace batten
