// Plugins in `bench`: a suite with a solver and a term of one, and what it finds in plugins with
// one fault each.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include "tests/tools/plugin_files.h"
#include "tests/tools/program.h"

namespace batten {
namespace {

using nlohmann::json;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

json SuiteOf(const std::vector<std::string>& plugins) {
  json suite = {{"format", "batten.suite/1"},
                {"name", "plugins"},
                {"plugins", json::array()},
                {"problems",
                 {{{"synthetic", "star"},
                   {"name", "star"},
                   {"points", 60},
                   {"control_points", 10},
                   {"start", "centroid"}}}},
                {"solvers", {"faulty"}},
                {"budgets", {{"seconds", 5}, {"iterations", 200}}},
                {"warm_up", 0},
                {"repetitions", 2}};
  for (const std::string& plugin : plugins) suite["plugins"].push_back(Plugin(plugin));
  return suite;
}

class BenchPlugins : public ::testing::Test {
 protected:
  Ended RunSuite(const json& suite) const {
    return RunBatten({"bench", folder_.Write("suite.json", suite.dump()),
                      "--out=" + (folder_ / "out"), "--nofigures", "--quiet"});
  }
  std::vector<json> Rows() const {
    std::vector<json> rows;
    for (const std::string& line : Lines(ReadFile(folder_ / "out/cells.jsonl"))) {
      rows.push_back(json::parse(line));
    }
    return rows;
  }

  TemporaryFolder folder_;
};

TEST_F(BenchPlugins, SolverAndTermHaveTheirRows) {
  json suite = SuiteOf({"barzilai_borwein", "tension"});
  suite["solvers"] = {"barzilai_borwein", "banded_cholesky"};
  suite["terms"] = {"distance", "distance,tension/weight=1e-3"};
  const Ended ended = RunSuite(suite);
  ASSERT_EQ(ended.status, 0) << ended.err << ended.out;
  const std::vector<json> rows = Rows();
  ASSERT_EQ(rows.size(), 8u);
  std::map<std::string, std::map<std::string, double>> energies;
  for (const json& row : rows) {
    EXPECT_TRUE(row["findings"].empty()) << row["findings"].dump();
    EXPECT_EQ(row["plugins"].size(), 2u);
    energies[row["terms"]][row["solver"]] = row["energy"];
  }
  ASSERT_EQ(energies.size(), 2u);
  for (const auto& [terms, of_solver] : energies) {
    ASSERT_EQ(of_solver.size(), 2u) << terms;
    const double direct = of_solver.at("banded_cholesky");
    EXPECT_NEAR(of_solver.at("barzilai_borwein"), direct, 1e-9 * (1.0 + direct)) << terms;
  }
  // The term counts: the minimum with it lies higher.
  EXPECT_GT(energies["distance+tension/weight=1e-3"]["banded_cholesky"],
            energies["distance"]["banded_cholesky"] + 1e-6);
  const json manifest = json::parse(ReadFile(folder_ / "out/manifest.json"));
  EXPECT_EQ(manifest["plugins"].size(), 2u);
}

TEST_F(BenchPlugins, AChangedPluginRunsItsCellsAgain) {
  json suite = SuiteOf({"fault_none"});
  std::filesystem::copy(Plugin("fault_none"), folder_ / "mine.so");
  suite["plugins"] = {"mine.so"};
  ASSERT_EQ(RunSuite(suite).status, 0);
  EXPECT_EQ(Rows().size(), 2u);
  ASSERT_EQ(RunSuite(suite).status, 0);
  EXPECT_EQ(Rows().size(), 2u);
  std::ofstream(folder_ / "mine.so", std::ios::app) << "another build";
  ASSERT_EQ(RunSuite(suite).status, 0);
  EXPECT_EQ(Rows().size(), 4u);
}

TEST_F(BenchPlugins, IdentityIsOfSolverOptionsThatRanPluginAndProblem) {
  json suite = SuiteOf({"fault_other_options"});
  suite["solvers"] = {"faulty/memory=6", "faulty/memory=6/rule=second", "cg"};
  RunSuite(suite);
  std::map<std::string, std::set<std::string>> hashes;  // by identity
  for (const json& row : Rows()) hashes[row["identity"]].insert(row["identity_hash"]);
  // Whatever was asked, it says that it ran with the first rule.
  EXPECT_EQ(hashes.size(), 2u);
  EXPECT_EQ(hashes.count("faulty/memory=6/rule=first"), 1u);
  std::set<std::string> all;
  for (const auto& [identity, of_it] : hashes) {
    EXPECT_EQ(of_it.size(), 1u) << identity;  // whatever the repetition
    all.insert(of_it.begin(), of_it.end());
  }
  EXPECT_EQ(all.size(), 2u);
  suite["problems"][0]["points"] = 61;
  RunSuite(suite);
  for (const json& row : Rows()) all.insert(row["identity_hash"]);
  EXPECT_EQ(all.size(), 4u);
}

struct FaultInBench {
  std::string plugin;
  std::string stop;     // of every repetition; "": any
  std::string finding;  // of the first
  int status = 0;
  std::string note;
};
void PrintTo(const FaultInBench& fault, std::ostream* stream) { *stream << fault.plugin; }

class FaultyPluginInBench : public BenchPlugins,
                            public ::testing::WithParamInterface<FaultInBench> {};

TEST_P(FaultyPluginInBench, IsFlaggedAndTheOtherSolverGoesOn) {
  const FaultInBench& fault = GetParam();
  json suite = SuiteOf({fault.plugin});
  suite["solvers"] = {"faulty", "cg"};
  if (fault.plugin == "fault_sleeper") suite["budgets"] = {{"wall_seconds", 1.0}};
  if (fault.plugin == "fault_worker") suite["budgets"]["cpu_seconds"] = 1.0;
  const Ended ended = RunSuite(suite);
  EXPECT_EQ(ended.status, fault.status) << ended.err << ended.out;
  EXPECT_THAT(ended.out, HasSubstr(fault.note));
  int first = 0;
  for (const json& row : Rows()) {
    if (row["solver"] == "cg") {
      EXPECT_EQ(row["stop"], "gradient_small");
      EXPECT_TRUE(row["findings"].empty()) << row["findings"].dump();
      continue;
    }
    EXPECT_THAT(row["stop"].get<std::string>(), HasSubstr(fault.stop));
    if (row["repetition"] != 1) continue;
    ++first;
    EXPECT_THAT(row["findings"].get<std::vector<std::string>>(), Contains(fault.finding));
  }
  EXPECT_EQ(first, 1);
}

#if defined(__SANITIZE_ADDRESS__)
// The sanitizer is the first to see it and ends the process of the cell that looks for it.
const FaultInBench kBenchReadsPastX = {"fault_reads_past_x", "", "crashed", 0,
                                       "ended with status 1"};
#else
const FaultInBench kBenchReadsPastX = {"fault_reads_past_x", "", "reads_past_x", 3,
                                       "faulty: reads past x: "};
#endif

INSTANTIATE_TEST_SUITE_P(
    Faults, FaultyPluginInBench,
    ::testing::Values(
        FaultInBench{"fault_crasher", "crashed", "crashed", 0, "ended by signal 6 (Aborted)"},
        FaultInBench{"fault_throws", "crashed", "crashed", 0, "threw an exception: no such luck"},
        FaultInBench{"fault_resizes", "crashed", "crashed", 0,
                     "books 21 variables where there are 20"},
        FaultInBench{"fault_exits", "crashed", "crashed", 0, "ended with status 0 and no result"},
        FaultInBench{"fault_reason", "crashed", "crashed", 0,
                     "returns the reason 77, which is none"},
        FaultInBench{"fault_sleeper", "wall_limit", "wall_limit", 0, "of wall time"},
        FaultInBench{"fault_worker", "cpu_limit", "cpu_limit", 0, "of processor time"},
        FaultInBench{"fault_nan", "", "no_finite_end", 0, "its end is no finite number"},
        FaultInBench{"fault_liar", "", "claim_fails", 3, "claim fails: "},
        FaultInBench{"fault_ignores_stop", "", "ignores_stop", 0, "ignores stop: "},
        FaultInBench{"fault_other_options", "", "other_options", 3,
                     "faulty: other options ran: asked memory=5, ran memory=6"},
        kBenchReadsPastX),
    [](const auto& row) { return row.param.plugin.substr(6); });

/// Whether a limit cuts the run, or it ends before any tells it to stop.
TEST_F(BenchPlugins, FlagsASolverThatIgnoresStopWhateverTheLimits) {
  json suite = SuiteOf({"fault_ignores_stop"});
  for (const auto& [iterations, early] : {std::pair{10, false}, {10'000, true}}) {
    suite["budgets"]["iterations"] = iterations;
    const Ended ended = RunSuite(suite);
    EXPECT_EQ(ended.status, 0) << ended.err;
    EXPECT_THAT(ended.out, HasSubstr("faulty: ignores stop: "));
    for (const json& one : Rows()) {
      if (one["repetition"] != 1 || one["max_iterations"] != iterations) continue;
      EXPECT_THAT(one["findings"].get<std::vector<std::string>>(), Contains("ignores_stop"));
      EXPECT_EQ(one.contains("calls_past_early_stop"), early);
      EXPECT_EQ(one["calls_past_stop"].get<int>() > 2, !early);
    }
  }
}

TEST_F(BenchPlugins, StopsAMemoryHog) {
  if (!kCanLimitMemory) GTEST_SKIP() << "the sanitizer needs terabytes of addresses";
  json suite = SuiteOf({"fault_memory_hog"});
  suite["budgets"]["memory_mb"] = 256;
  EXPECT_THAT(RunSuite(suite).out, HasSubstr("needs more than 256 MB of memory"));
}

TEST_F(BenchPlugins, FlagsATermWhoseGradientIsWrongAtTheEndAlone) {
  json suite = SuiteOf({"fault_wrong_gradient"});
  suite["solvers"] = {"lbfgs"};
  // All control points start at the centroid, which is near 0, and end on the star; nowhere: beyond
  // all of them.
  suite["terms"] = {"distance,faulty_term/weight=0.001/from=0.2",
                    "distance,faulty_term/weight=0.001/from=9"};
  suite["repetitions"] = 1;
  EXPECT_EQ(RunSuite(suite).status, 3);
  for (const json& row : Rows()) {
    const bool at_end = row["terms"] == "distance+faulty_term/weight=0.001/from=0.2";
    const auto findings = row["findings"].get<std::vector<std::string>>();
    EXPECT_EQ(std::count(findings.begin(), findings.end(), "wrong_gradient"), at_end ? 1 : 0);
  }
}

TEST_F(BenchPlugins, FlagsATermWithAWrongGradient) {
  json suite = SuiteOf({"fault_wrong_gradient", "tension"});
  suite["solvers"] = {"lbfgs", "newton"};
  suite["terms"] = {"distance,tension/weight=0.1", "distance,faulty_term/weight=0.5"};
  const Ended ended = RunSuite(suite);
  EXPECT_EQ(ended.status, 3) << ended.err << ended.out;
  EXPECT_THAT(ended.out,
              HasSubstr("lbfgs: wrong gradient: that of faulty_term/weight=0.5 is not the one"));
  int wrong = 0;
  for (const json& row : Rows()) {
    const bool is_wrong = row["terms"] == "distance+faulty_term/weight=0.5";
    const auto findings = row["findings"].get<std::vector<std::string>>();
    if (!is_wrong || row["repetition"] != 1) {
      EXPECT_THAT(findings, Not(Contains("wrong_gradient"))) << row["solver"];
      continue;
    }
    ++wrong;
    EXPECT_THAT(findings, Contains("wrong_gradient")) << row["solver"];
    EXPECT_EQ(row["wrong_gradients"], json({"faulty_term/weight=0.5"}));
  }
  EXPECT_EQ(wrong, 2);
}

}  // namespace
}  // namespace batten
