// Faults on purpose: the runner flags each, and goes on.
#include "experiments/bench_runner.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>

#include "experiments/bench_manifest.h"
#include "experiments/bench_results.h"
#include "solvers/plugin_loader.h"
#include "tests/experiments/faulty_solvers.h"
#include "tests/problems/scratch_folder.h"

namespace batten {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class BenchRunnerTest : public ::testing::Test {
 protected:
  // Tests that run beside this one are not to be seen: MachineUse goes by the temporary folder.
  void SetUp() override {
    const char* const before = getenv("TMPDIR");
    if (before != nullptr) temporary_ = before;
    setenv("TMPDIR", folder_.path().c_str(), 1);
  }
  void TearDown() override {
    if (temporary_.has_value()) {
      setenv("TMPDIR", temporary_->c_str(), 1);
    } else {
      unsetenv("TMPDIR");
    }
  }

  /// Runs a suite of these solvers on one small problem; rows in the order of the solvers.
  std::vector<nlohmann::json> Run(const std::string& solvers, const std::string& more = "") {
    const std::string path = folder_.Write(
        "suite.json",
        R"({"format": "batten.suite/1", "name": "faults", "problems": [)"
        R"({"synthetic": "star", "name": "star", "points": 60, "control_points": 10)"
        R"(, "start": "centroid"}],)"
        R"("solvers": [)" +
            solvers + R"(], "order": {"shuffled": false})" + more +
            (more.find("warm_up") == std::string::npos ? R"(, "repetitions": 1, "warm_up": 0})"
                                                       : "}"));
    std::string error;
    EXPECT_TRUE(ReadBenchSuite(path, &suite_, &error)) << error;
    BenchRunner runner(suite_, BenchMatrix(suite_), {out_}, 1);
    EXPECT_TRUE(runner.Open(&error)) << error;
    EXPECT_TRUE(WriteManifest(suite_, {}, out_, &error)) << error;
    taken_over_ = runner.num_taken_over();
    EXPECT_TRUE(runner.Run(nullptr, &error)) << error;
    std::vector<nlohmann::json> rows;
    for (const nlohmann::json* row : runner.Rows()) rows.push_back(*row);
    return rows;
  }
  BenchResults Results() {
    std::string error;
    EXPECT_TRUE(ReadBenchData(out_, &data_, &error)) << error;
    return CollectResults(data_);
  }

  ScratchFolder folder_;
  std::string out_ = folder_.path() / "out";
  BenchSuite suite_;
  BenchData data_;
  std::size_t taken_over_ = 0;

 private:
  std::optional<std::string> temporary_;
};

TEST_F(BenchRunnerTest, MarksWhatRanBesideAnotherMeasurement) {
  {
    const MachineUse other;
    const auto rows = Run(R"("cg")", R"(, "repetitions": 2, "warm_up": 0)");
    for (const nlohmann::json& row : rows) EXPECT_EQ(row["overlapped"], true);
    const BenchResults results = Results();
    EXPECT_TRUE(results.overlapped);
    EXPECT_THAT(results.runs.at(0).seconds, IsEmpty());
    EXPECT_TRUE(std::isnan(results.instances.at(0).unit_seconds));
  }
  // Alone: the work unit is measured again, cells that are finished stay.
  const auto rows = Run(R"("cg")", R"(, "repetitions": 3, "warm_up": 0)");
  EXPECT_EQ(taken_over_, 2u);
  EXPECT_EQ(rows.at(1)["overlapped"], true);
  EXPECT_EQ(rows.at(2)["overlapped"], false);
  EXPECT_GT(Results().instances.at(0).unit_seconds, 0.0);
}

TEST_F(BenchRunnerTest, MeasuresAWorkUnitAgainThatFailed) {
  Run(R"("cg")");
  const std::string path = out_ + "/instances.jsonl";
  std::string line;
  std::getline(std::ifstream(path), line);
  const nlohmann::json good = nlohmann::json::parse(line);
  ASSERT_GT(good["evaluation_seconds"], 0.0);
  std::ofstream(path) << nlohmann::json{{"format", "batten.instance/1"},
                                        {"problem", "star"},
                                        {"failure", "killed"},
                                        {"key", good["key"]}}
                      << "\n";
  Run(R"("cg")");
  EXPECT_EQ(taken_over_, 1u);
  EXPECT_GT(Results().instances.at(0).unit_seconds, 0.0);
  EXPECT_EQ(Results().instances.at(0).minimum_energy, good["minimum_energy"]);
  // Once it is measured it stays.
  const auto size = std::filesystem::file_size(path);
  Run(R"("cg")");
  EXPECT_EQ(std::filesystem::file_size(path), size);
}

TEST_F(BenchRunnerTest, MakesARowOfACrash) {
  const RegisteredSolver crasher("crasher", &faults::Crash);
  const auto rows = Run(R"("crasher", "cg")");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0]["stop"], "crashed");
  EXPECT_THAT(rows[0]["message"].get<std::string>(), HasSubstr("signal 11"));
  EXPECT_TRUE(rows[0]["energy"].is_null());
  EXPECT_EQ(rows[1]["stop"], "gradient_small");
  EXPECT_THAT(Results().notes, Contains(HasSubstr("crasher: crashed: ended by signal 11")));
}

TEST_F(BenchRunnerTest, MakesARowOfAProcessThatLeaves) {
  const RegisteredSolver leaver("leaver", &faults::Leave);
  const auto rows = Run(R"("leaver")");
  EXPECT_EQ(rows.at(0)["stop"], "crashed");
  EXPECT_THAT(rows[0]["message"].get<std::string>(), HasSubstr("no result"));
}

TEST_F(BenchRunnerTest, KillsASleeper) {
  const RegisteredSolver sleeper("sleeper", &faults::Sleep);
  const auto rows = Run(R"("sleeper", "cg")", R"(, "budgets": {"wall_seconds": 0.3})");
  EXPECT_EQ(rows.at(0)["stop"], "wall_limit");
  EXPECT_EQ(rows.at(1)["stop"], "gradient_small");
  EXPECT_TRUE(Results().some_failed);
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST_F(BenchRunnerTest, StopsAMemoryHog) {
  const RegisteredSolver hog("hog", &faults::HogMemory);
  const auto rows = Run(R"("hog", "cg")", R"(, "budgets": {"memory_mb": 256})");
  EXPECT_EQ(rows.at(0)["stop"], "out_of_memory");
  EXPECT_THAT(rows[0]["message"].get<std::string>(), HasSubstr("256 MB"));
  EXPECT_EQ(rows.at(1)["stop"], "gradient_small");
}
#endif

TEST_F(BenchRunnerTest, FlagsNan) {
  const RegisteredSolver solver("turns_nan", &faults::TurnNan);
  const auto rows = Run(R"("turns_nan")");
  EXPECT_EQ(rows.at(0)["stop"], "diverged");
  EXPECT_EQ(rows[0]["iterations"], 11);
  EXPECT_TRUE(rows[0]["energy"].is_null());
  EXPECT_THAT(rows[0]["findings"], Contains("no_finite_end"));
}

TEST_F(BenchRunnerTest, FlagsALiar) {
  const RegisteredSolver solver("liar", &faults::Lie);
  const auto rows = Run(R"("liar", "cg")");
  EXPECT_EQ(rows.at(0)["stop"], "gradient_small");
  EXPECT_THAT(rows[0]["findings"], ElementsAre("claim_fails"));
  EXPECT_THAT(rows.at(1)["findings"], IsEmpty());
  const BenchResults results = Results();
  EXPECT_TRUE(results.some_claim_failed);
  EXPECT_THAT(results.notes, Contains(HasSubstr("liar")));
}

TEST_F(BenchRunnerTest, FlagsALiarWhereTheAuditDoesNotApply) {
  const RegisteredSolver solver("liar", &faults::Lie);
  const auto rows = Run(R"("liar")", R"(, "terms": ["distance,fairing/weight=1e-6/loss=huber"])");
  EXPECT_TRUE(rows.at(0)["verified"].is_null());
  EXPECT_THAT(rows[0]["findings"], ElementsAre("claim_fails"));
}

TEST_F(BenchRunnerTest, FlagsWhoIgnoresStop) {
  const RegisteredSolver solver("deaf", &faults::GoOn<1000>);
  const RegisteredSolver slow("slow_to_hear", &faults::GoOn<3>);
  const RegisteredSolver last("books_its_end", &faults::GoOn<2>);
  const auto rows =
      Run(R"("deaf", "slow_to_hear", "books_its_end")", R"(, "budgets": {"iterations": 5})");
  EXPECT_EQ(rows.at(0)["stop"], "iteration_limit");
  EXPECT_EQ(rows[0]["gradient_calls"], 5);
  EXPECT_EQ(rows[0]["calls_past_stop"], 1000);
  EXPECT_THAT(rows[0]["findings"], ElementsAre("ignores_stop"));
  EXPECT_EQ(rows[1]["calls_past_stop"], 3);
  EXPECT_THAT(rows[1]["findings"], ElementsAre("ignores_stop"));
  EXPECT_EQ(rows[2]["calls_past_stop"], 2);
  EXPECT_THAT(rows[2]["findings"], IsEmpty());
}

TEST_F(BenchRunnerTest, SaysThatTwoSolversAreOneMethod) {
  const RegisteredSolver first("descent", &faults::Descend);
  const RegisteredSolver second("other_descent", &faults::Descend);
  Run(R"("descent", "other_descent", "cg")", R"(, "budgets": {"iterations": 20})");
  const BenchResults results = Results();
  EXPECT_THAT(results.notes, Contains(HasSubstr("descent and other_descent evaluate at the same")));
  EXPECT_THAT(results.notes, ::testing::Not(Contains(HasSubstr("cg evaluate at the same"))));
}

TEST_F(BenchRunnerTest, NoBuiltInSolverIgnoresStop) {
  const auto rows = Run(R"("all")", R"(, "budgets": {"iterations": 3, "seconds": 5})");
  for (const nlohmann::json& row : rows) {
    EXPECT_THAT(row["findings"], ::testing::Not(Contains("ignores_stop")))
        << row["solver"] << " " << row["calls_past_stop"];
  }
}

TEST_F(BenchRunnerTest, RunsAgainWhatHasChanged) {
  Run(R"("cg", "lbfgs")");
  EXPECT_EQ(taken_over_, 0u);
  Run(R"("cg", "lbfgs")");
  EXPECT_EQ(taken_over_, 2u);
  Run(R"("cg", "lbfgs/memory=3")");
  EXPECT_EQ(taken_over_, 1u);
  Run(R"("cg", "lbfgs")", R"(, "budgets": {"iterations": 20})");
  EXPECT_EQ(taken_over_, 0u);
  // Without its trace a row is not finished.
  std::filesystem::remove_all(out_ + "/traces");
  Run(R"("cg", "lbfgs")");
  EXPECT_EQ(taken_over_, 0u);
}

TEST_F(BenchRunnerTest, RunsAgainWhereAWeightOfASpanHasChanged) {
  Run(R"("cg")");
  const BenchCell cell = BenchMatrix(suite_).front();
  std::set<std::string> keys = {BenchCellKey(suite_, cell)};
  std::vector<double>* const weights = &suite_.problems[0].entry.spec.span_weights;
  for (const std::vector<double>& values : {std::vector<double>{1.0, 2.0}, {1.0, 3.0}, {1.0}}) {
    *weights = values;
    EXPECT_TRUE(keys.insert(BenchCellKey(suite_, cell)).second);
  }
}

TEST_F(BenchRunnerTest, StartsEveryRepetitionFromTheStart) {
  const auto rows = Run(R"("lbfgs")", R"(, "warm_up": 3, "repetitions": 2)");
  ASSERT_EQ(rows.size(), 2u);
  for (const char* key : {"start_energy", "iterations", "energy_calls", "stream", "energy"}) {
    EXPECT_EQ(rows[0][key], rows[1][key]) << key;
  }
  EXPECT_GT(rows[0]["iterations"], 5);
}

TEST_F(BenchRunnerTest, KeysAreOfTheLibrariesOfPluginsToo) {
  Run(R"("cg")");
  const BenchCell cell = BenchMatrix(suite_).front();
  std::set<std::string> keys = {BenchCellKey(suite_, cell)};
  for (const char* name : {"a.so", "b.so", "c.so"}) {
    const std::string library = folder_.Write(name, name == std::string("a.so") ? "one" : "other");
    LoadedPlugins().push_back({"", "", {}, {}, {library}});
    keys.insert(BenchCellKey(suite_, cell));
    LoadedPlugins().pop_back();
  }
  EXPECT_EQ(keys.size(), 3u);  // none, one and the other
}

}  // namespace
}  // namespace batten
