// What runs of a report are held against: minima, starts, targets and work units of their
// instances.
#include "experiments/report_groups.h"

#include <cmath>
#include <tuple>

#include "tests/experiments/report_folder.h"

namespace batten {
namespace {

using nlohmann::json;

class ReportGroupsTest : public ReportFolder {};

// E - E* = 100 / 4^k: gaps of 4^-k, so that the target 10^-j takes ceil(j log_4 10) iterations.
TEST_F(ReportGroupsTest, FindsTheIterationsToEachTargetInTheWholeTrace) {
  Write("cells.jsonl", "{\"key\": \"k\", \"problem\": \"a\", \"minimum_energy\": 0}\n");
  std::string trace = kTraceHeader;
  for (int k = 0; k <= 400; ++k) {
    const double energy = 100.0 * std::pow(4.0, -k);
    char row[200];
    std::snprintf(row, sizeof(row), "%d,%d,%d,0,2,7,%d,%d,%.17g,1,1,%.17g\n", k, k, 2 * k, 3 * k, k,
                  energy, energy);
    trace += row;
  }
  Write("traces/k.csv", trace);
  limits_.rows_per_trace = 5;
  ASSERT_TRUE(Read()) << error_;
  const json shown = Traces()["k"];
  EXPECT_EQ(shown[0], 401);
  EXPECT_EQ(shown[1], json::parse("[0, 25, 100, 225, 400]"));
  EXPECT_EQ(shown[2][1], 25 + 50 + 2);  // calls of E, of the gradient, products; no projections
  EXPECT_EQ(shown[3][1], 75);
  for (int j = 1; j <= 10; ++j) {
    const int expected = static_cast<int>(std::ceil(j * std::log(10.0) / std::log(4.0)));
    EXPECT_EQ(shown[7][0][j - 1], expected) << j;
    EXPECT_EQ(shown[7][2][j - 1], 3 * expected) << j;
  }
}

TEST_F(ReportGroupsTest, HoldsRunsAgainstTheLowestEnergyWhereThereIsNoDirectAnswer) {
  Write("cells.jsonl",
        "{\"key\": \"a\", \"problem\": \"p\", \"energy\": 4}\n"
        "{\"key\": \"b\", \"problem\": \"p\", \"energy\": 3}\n"
        "{\"key\": \"c\", \"problem\": \"q\", \"energy\": 1, \"minimum_energy\": 0.5}\n");
  Write("traces/a.csv", "iteration,energy\n0,13\n1,4\n");
  ASSERT_TRUE(Read()) << error_;
  const json groups = Summary()["groups"];
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[0]["minimum"], 3.0);
  EXPECT_EQ(groups[0]["direct"], false);
  EXPECT_EQ(groups[1]["minimum"], 0.5);
  EXPECT_EQ(groups[1]["direct"], true);
  EXPECT_EQ(Traces()["a"][5], json::parse("[10, 1]"));
  EXPECT_EQ(Traces()["a"][6], json::parse("[null, null]"));  // no column of |g|
}

// Other starts lead to other minima: each has an E* of its own.
TEST_F(ReportGroupsTest, HoldsRunsFromOneStartAgainstEachOtherAlone) {
  Write("cells.jsonl",
        "{\"problem\": \"p\", \"start_seed\": 1, \"energy\": 4}\n"
        "{\"problem\": \"p\", \"start_seed\": 2, \"energy\": 3}\n"
        "{\"problem\": \"p\", \"start_seed\": 1, \"energy\": 5}\n");
  ASSERT_TRUE(Read()) << error_;
  const json groups = Summary()["groups"];
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[0]["start_seed"], 1);
  EXPECT_EQ(groups[0]["minimum"], 4.0);
  EXPECT_EQ(groups[1]["minimum"], 3.0);
  EXPECT_EQ(Summary()["group_of"], json::parse("[0, 1, 0]"));
}

TEST_F(ReportGroupsTest, HasTheWorkUnitOfEachInstanceOfABenchmark) {
  std::string rows;
  for (const auto& [key, problem, instance] :
       {std::tuple{"a", "p", "1"}, {"b", "q", "2"}, {"c", "r", "3"}}) {
    rows += json({{"format", "batten.cell/1"},
                  {"key", key},
                  {"problem", problem},
                  {"terms", "own"},
                  {"solver", "cg"},
                  {"stop", "solved"},
                  {"instance", instance}})
                .dump() +
            "\n";
  }
  Write("cells.jsonl", rows);
  const std::string instances =
      "{\"key\": \"1\", \"minimum_energy\": 1, \"evaluation_seconds\": 0.25}\n"
      "{\"key\": \"2\", \"minimum_energy\": null, \"evaluation_seconds\": 0.5}\n";
  Write("instances.jsonl", instances);
  Write(
      "manifest.json",
      "{\"format\": \"batten.manifest/1\", \"cells\": [\"a\", \"b\", \"c\"], \"gap_targets\": []}");
  ASSERT_TRUE(Read()) << error_;
  const json groups = Summary()["groups"];
  ASSERT_EQ(groups.size(), 3u);
  EXPECT_EQ(groups[0]["unit_seconds"], 0.25);
  EXPECT_EQ(groups[1]["unit_seconds"], 0.5);
  EXPECT_FALSE(groups[2].contains("unit_seconds"));  // not measured
}

// Some methods have done a step before their first row.
TEST_F(ReportGroupsTest, TakesGapsFromTheStartAndNotFromTheFirstRow) {
  Write("cells.jsonl",
        "{\"key\": \"b\", \"problem\": \"p\", \"minimum_energy\": 0, \"start_energy\": 8}\n");
  Write("traces/b.csv", "iteration,energy\n0,4\n1,0.7\n2,0.3\n3,0.03\n");
  ASSERT_TRUE(Read()) << error_;
  EXPECT_EQ(Traces()["b"][7][0][0], 1);  // 0.7 is below 0.8
  EXPECT_EQ(Traces()["b"][7][0][1], 3);
}

// The start has a gap of 1, iteration k one of 2^-k and E = 2^-k; the truth has E = 0.2.
TEST_F(ReportGroupsTest, HasTheTargetsOfTheSuiteAndTheNoiseFloor) {
  json cell = {
      {"format", "batten.cell/1"}, {"key", "a"},      {"problem", "p"},     {"solver", "cg"},
      {"stop", "solved"},          {"instance", "1"}, {"minimum_energy", 0}};
  json later = cell;  // has done a step before the start that it tells of
  cell["iterations"] = later["iterations"] = 8;
  cell["start_energy"] = 1;
  later["key"] = "b";
  later["solver"] = "gim";
  later["start_energy"] = 0.5;
  Write("cells.jsonl", cell.dump() + "\n" + later.dump() + "\n");
  Write("traces/b.csv", "iteration,energy\n0,0.5\n1,0.2\n");
  Write("instances.jsonl",
        "{\"key\": \"1\", \"minimum_energy\": 0, \"truth_energy\": 0.2, \"noise\": 0.1, "
        "\"num_variables\": 40}\n");
  Write("manifest.json",
        "{\"format\": \"batten.manifest/1\", \"cells\": [\"a\", \"b\"], \"gap_targets\": [0.25, "
        "0.01]}");
  std::string trace = "iteration,energy\n";
  for (int k = 0; k <= 8; ++k) {
    trace += std::to_string(k) + "," + std::to_string(std::pow(2.0, -k)) + "\n";
  }
  Write("traces/a.csv", trace);
  ASSERT_TRUE(Read()) << error_;
  EXPECT_EQ(Summary()["targets"],
            json::parse("[0.25, 0.1, 0.01, 0.001, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 0]"));
  EXPECT_EQ(Summary()["suite_targets"], json::parse("[0.25, 0.01, 0]"));
  EXPECT_EQ(Summary()["groups"][0]["truth"], 0.2);
  EXPECT_EQ(Summary()["groups"][0]["num_variables"], 40);
  const json hits = Traces()["a"][7][0];
  ASSERT_EQ(hits.size(), 12u);
  EXPECT_EQ(hits[0], 2);
  EXPECT_EQ(hits[2], 7);
  EXPECT_TRUE(hits[3].is_null());
  EXPECT_EQ(hits[11], 3);  // 1/8 is the first at most 0.2
  EXPECT_EQ(Traces()["b"][7][0][0], 1);
}

TEST_F(ReportGroupsTest, ASkippedRunBelongsToTheProblemAsTheOthersRanIt) {
  Write("cells.jsonl",
        "{\"problem\": \"p\", \"stop\": \"skipped\"}\n{\"key\": \"a\", \"problem\": \"p\"}\n");
  Write("traces/a.csv", std::string(kTraceHeader) + "0,1,1,0,0,0,1,1,4,1,0,4\n");
  ASSERT_TRUE(Read()) << error_;
  EXPECT_EQ(Summary()["groups"].size(), 1u);
  EXPECT_EQ(Summary()["groups"][0]["terms"], "interpolation");
}

}  // namespace
}  // namespace batten
