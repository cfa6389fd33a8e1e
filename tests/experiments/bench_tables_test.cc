// Tables of benchmarks written down by hand: what they say is computed on paper.
#include "experiments/bench_tables.h"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>
#include <tuple>

#include "experiments/table_text.h"
#include "tests/experiments/hand_made_bench.h"

namespace batten {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

// Means pass through logarithms.
constexpr double kRounding = 1e-12;

/// The one row of `solver`.
CsvTable RowOf(const CsvTable& table, const std::string& solver) {
  const CsvTable row = table.Where("solver", solver);
  EXPECT_EQ(row.num_rows(), 1u) << solver;
  return row;
}

TEST(BenchTables, ARepetitionThatFailsIsInfinityInTheMedian) {
  HandMadeBench bench({0.1});
  bench.AddInstance("p", 0.0);
  // The target is 1; times to it 0.2, 0.4 and never.
  bench.AddRun("p", "one_fails", {{1, 0.0, 10.0}, {5, 0.2, 0.5}, {9, 0.3, 0.0}});
  bench.AddRow("p", "one_fails", "wall_limit")["message"] = "killed after 3 s of wall time";
  bench.AddRun("p", "one_fails", {{1, 0.0, 10.0}, {5, 0.4, 0.5}, {9, 0.5, 0.0}});
  bench.AddRow("p", "two_fail", "crashed")["message"] = "ended by signal 11";
  bench.AddRun("p", "two_fail", {{1, 0.0, 10.0}, {2, 0.1, 0.5}});
  bench.AddRow("p", "two_fail", "crashed")["message"] = "ended by signal 11";
  const BenchResults results = bench.Results();

  const CsvTable runs = RunTable(results);
  EXPECT_EQ(RowOf(runs, "one_fails").Text(0, "failed"), "1");
  EXPECT_EQ(RowOf(runs, "one_fails").Text(0, "repetitions"), "3");
  EXPECT_EQ(RowOf(runs, "one_fails").Number(0, "seconds"), 0.5);
  EXPECT_EQ(RowOf(runs, "two_fail").Text(0, "failed"), "2");
  EXPECT_EQ(RowOf(runs, "two_fail").Text(0, "seconds"), "");

  const CsvTable solvers = SolverTable(results);
  const CsvTable one = RowOf(solvers, "one_fails");
  EXPECT_EQ(one.Text(0, "solved"), "1");
  EXPECT_NEAR(one.Number(0, "seconds"), 0.4, kRounding);
  EXPECT_NEAR(one.Number(0, "work_units"), 4.0, 10 * kRounding);
  const CsvTable two = RowOf(solvers, "two_fail");
  EXPECT_EQ(two.Text(0, "solved"), "0");
  EXPECT_NEAR(two.Number(0, "evaluations"), 50.0, 100 * kRounding);  // charged 10 x 5
  EXPECT_NEAR(two.Number(0, "seconds"), 4.0, 10 * kRounding);

  EXPECT_THAT(results.notes, Contains("p | own: one_fails: wall_limit: killed after 3 s of wall "
                                      "time, in 1 of 3 repetitions"));
  EXPECT_THAT(results.notes, Contains("p | own: two_fail: crashed: ended by signal 11, in 2 of 3 "
                                      "repetitions"));
}

TEST(BenchTables, OfTwoRepetitionsOneThatFailsIsTooMany) {
  HandMadeBench bench({0.1});
  bench.AddInstance("p", 0.0);
  bench.AddRun("p", "half", {{1, 0.0, 10.0}, {5, 0.2, 0.5}});
  bench.AddRow("p", "half", "out_of_memory");
  const BenchResults results = bench.Results();
  EXPECT_EQ(CostsOf(results, 0, BenchCost::kEvaluations, nullptr),
            CostTable({{std::numeric_limits<double>::infinity()}}));
}

TEST(BenchTables, WhatWasNotRunIsNoFailure) {
  HandMadeBench bench({0.1});
  bench.AddInstance("easy", 0.0);
  bench.AddInstance("hard", 0.0);
  bench.AddRun("easy", "everywhere", {{1, 0.0, 10.0}, {10, 0.1, 1.0}});
  bench.AddRun("hard", "everywhere", {{1, 0.0, 10.0}, {70, 0.7, 1.0}});
  bench.AddRun("hard", "not_on_easy", {{1, 0.0, 10.0}, {35, 0.7, 1.0}});
  bench.AddRun("easy", "not_far_enough", {{1, 0.0, 10.0}, {10, 0.1, 1.0}});
  bench.AddRun("hard", "not_far_enough", {{1, 0.0, 10.0}, {90, 0.9, 1.1}});
  const BenchResults results = bench.Results();
  const CsvTable table = SolverTable(results);

  const CsvTable all = RowOf(table, "everywhere");
  EXPECT_EQ(all.Text(0, "instances"), "2");
  EXPECT_EQ(all.Text(0, "not_run"), "0");
  EXPECT_EQ(all.Text(0, "solved"), "2");
  EXPECT_NEAR(all.Number(0, "evaluations"), 30.0, 100 * kRounding);  // 20 x 80 = 40^2

  const CsvTable part = RowOf(table, "not_on_easy");
  EXPECT_EQ(part.Text(0, "instances"), "2");
  EXPECT_EQ(part.Text(0, "not_run"), "1");
  EXPECT_EQ(part.Text(0, "solved"), "1");
  EXPECT_NEAR(part.Number(0, "evaluations"), 35.0, 100 * kRounding);

  const CsvTable failed = RowOf(table, "not_far_enough");
  EXPECT_EQ(failed.Text(0, "not_run"), "0");
  EXPECT_EQ(failed.Text(0, "solved"), "1");
  EXPECT_NEAR(failed.Number(0, "evaluations"), std::sqrt(20.0 * 710.0) - 10.0, 1000 * kRounding);

  // In profiles it counts for the others alone.
  const CostTable costs = CostsOf(results, 0, BenchCost::kEvaluations, nullptr);
  const std::vector<Steps> profiles = PerformanceProfiles(costs);
  EXPECT_EQ(profiles[0].At(1.0), 0.5);  // easy; on hard 2
  EXPECT_EQ(profiles[0].At(2.0), 1.0);
  EXPECT_EQ(profiles[1].At(1.0), 1.0);
  EXPECT_EQ(profiles[2].At(10.0), 0.5);
  EXPECT_EQ(PairCosts(results, 0, BenchCost::kEvaluations, 0, 1), CostTable({{70.0, 35.0}}));
}

TEST(BenchTables, TimesThatAreNotKnownAreNoFailures) {
  HandMadeBench bench({0.1});
  bench.AddInstance("p", 0.0);
  bench.AddRun("p", "alone", {{1, 0.0, 10.0}, {5, 0.2, 0.5}});
  bench.AddRun("p", "beside", {{1, 0.0, 10.0}, {8, 0.1, 0.5}})["overlapped"] = true;
  bench.AddRow("p", "beside_failed", "crashed")["overlapped"] = true;
  const BenchResults results = bench.Results();
  const CsvTable table = SolverTable(results);
  EXPECT_NEAR(RowOf(table, "alone").Number(0, "seconds"), 0.2, kRounding);
  EXPECT_EQ(RowOf(table, "beside").Text(0, "seconds"), "");
  EXPECT_EQ(RowOf(table, "beside").Text(0, "not_run"), "0");
  EXPECT_NEAR(RowOf(table, "beside").Number(0, "evaluations"), 8.0, 10 * kRounding);
  EXPECT_NEAR(RowOf(table, "beside_failed").Number(0, "seconds"), 2.0, 10 * kRounding);
  EXPECT_EQ(PairTable(results).Where("cost", "seconds").Where("second", "beside").num_rows(), 0u);
}

TEST(BenchTables, RunTableSaysWhatARowSays) {
  HandMadeBench bench({});
  bench.AddInstance("p", 2.0);
  nlohmann::json& row = bench.AddRun("p", "s/a=1", {{1, 0.0, 12.0}, {4, 0.5, 2.5}});
  row["gap"] = 0.05;
  row["gradient_calls"] = 3;
  row["jacobian_calls"] = 2;
  row["products"] = 10;
  row["projections"] = 1000;  // no evaluation
  row["verified"] = false;
  row["data_seed"] = 7;
  row["rms_orthogonal"] = 0.25;
  row["findings"] = {"claim_fails", "ignores_stop"};
  row["message"] = "one, two";
  const CsvTable table = RunTable(bench.Results());
  ASSERT_EQ(table.num_rows(), 1u);
  EXPECT_EQ(table.Text(0, "problem"), "p");
  EXPECT_EQ(table.Text(0, "data_seed"), "7");
  EXPECT_EQ(table.Text(0, "start_seed"), "");
  EXPECT_EQ(table.Text(0, "evaluations"), "19");
  EXPECT_EQ(table.Text(0, "iterations"), "1");
  EXPECT_EQ(table.Text(0, "verified"), "NO");
  EXPECT_EQ(table.Text(0, "gap"), "0.05");
  EXPECT_EQ(table.Text(0, "basin"), "");
  EXPECT_EQ(table.Text(0, "findings"), "claim_fails ignores_stop");
  EXPECT_EQ(table.Text(0, "message"), "one; two");
  EXPECT_EQ(table.Text(0, "seconds"), "0.5");
  EXPECT_EQ(table.Text(0, "seconds_low"), "");  // of one repetition
  EXPECT_EQ(table.Number(0, "work_units"), 5.0);
}

TEST(BenchTables, PairTableCountsWhoNeedsLess) {
  HandMadeBench bench({0.1});
  const auto Add = [&bench](const std::string& problem, const std::string& solver, int cost) {
    const double end = cost > 0 ? 1.0 : 5.0;
    bench.AddRun(problem, solver, {{1, 0.0, 10.0}, {std::max(cost, 2), 0.1, end}});
  };
  for (const auto& [problem, a, b] : {std::tuple{"first_less", 10, 20},
                                      {"equal", 10, 10},
                                      {"second_less", 40, 10},
                                      {"neither", 0, 0}}) {
    bench.AddInstance(problem, 0.0);
    Add(problem, "a", a);
    Add(problem, "b", b);
  }
  bench.AddInstance("not_for_b", 0.0);
  Add("not_for_b", "a", 10);
  bench.AddRow("not_for_b", "b", "skipped");
  const CsvTable table = PairTable(bench.Results()).Where("cost", "evaluations");
  ASSERT_EQ(table.num_rows(), 1u);
  EXPECT_EQ(table.Text(0, "instances"), "4");
  for (const char* column : {"first_less", "equal", "second_less", "neither"}) {
    EXPECT_EQ(table.Text(0, column), "1") << column;
  }
  // Ratios to the better one: of a 1, 1, 4; of b 2, 1, 1.
  EXPECT_EQ(table.Number(0, "first_at_1"), 0.5);
  EXPECT_EQ(table.Number(0, "second_at_1"), 0.5);
  EXPECT_EQ(table.Number(0, "first_at_2"), 0.5);
  EXPECT_EQ(table.Number(0, "second_at_2"), 0.75);
  EXPECT_EQ(table.Number(0, "first_at_10"), 0.75);
  EXPECT_EQ(table.Number(0, "second_at_10"), 0.75);
}

/// However many solvers there are, of which figures show no pairs.
TEST(BenchTables, PairTableHasEveryPairByEveryCostToEveryTarget) {
  HandMadeBench bench({0.5, 0.1});
  bench.AddInstance("p", 0.0);
  const std::vector<std::string> solvers = {"a", "b", "c", "d", "e", "f"};
  for (const std::string& solver : solvers) {
    bench.AddRun("p", solver, {{1, 0.0, 10.0}, {3, 0.3, 0.5}});
  }
  const CsvTable table = PairTable(bench.Results());
  for (const char* target : {"gap 0.5", "gap 0.1"}) {
    for (const char* cost : {"evaluations", "work_units", "seconds"}) {
      const CsvTable part = table.Where("target", target).Where("cost", cost);
      EXPECT_EQ(part.num_rows(), 15u) << target << ' ' << cost;  // 6 x 5 / 2
      for (std::size_t a = 0; a < solvers.size(); ++a) {
        for (std::size_t b = a + 1; b < solvers.size(); ++b) {
          EXPECT_EQ(part.Where("first", solvers[a]).Where("second", solvers[b]).num_rows(), 1u);
        }
      }
    }
  }
}

/// Two lines: minima of E = 1 and E = 3, to be reached from E = 11.
class BenchBasins : public ::testing::Test {
 protected:
  BenchBasins() {
    nlohmann::json& instance = bench_.AddInstance("free", nullptr);
    instance["degree"] = 1;
    instance["periodic"] = false;
    instance["knots"] = {0, 0, 1, 1};
    instance["size"] = 1;
    Add("best", {{1, 0.1, 11.0}, {4, 0.4, 1.9}}, 1.0, {0, 0, 1, 0});
    Add("worse", {{1, 0.1, 11.0}, {6, 0.6, 3.5}}, 3.0, {0, 0, 1, 1});
    Add("best_too", {{1, 0.1, 11.0}, {8, 0.8, 1.5}}, 1.0, {0, 0, 1, 0});
    bench_.AddRun("free", "nowhere", {{1, 0.1, 11.0}, {9, 0.9, 1.5}})["parameter_kind"] = "free";
    results_ = bench_.Results();
  }
  void Add(const std::string& solver, const std::vector<TracePoint>& trace, double end,
           const std::vector<double>& control_points) {
    nlohmann::json& row = bench_.AddRun("free", solver, trace);
    row["parameter_kind"] = "free";
    row["polished"] = true;
    row["polished_energy"] = end;
    row["polished_energy_at_foot_points"] = end;
    row["polished_control_points"] = control_points;
  }

  HandMadeBench bench_{{0.1}};
  BenchResults results_;
};

TEST_F(BenchBasins, TargetsAreOfTheBestBasinAndInPairsOfTheirOwn) {
  EXPECT_THAT(results_.instances.at(0).basin_energies, ElementsAre(1.0, 3.0));
  // To 1 + 0.1 * 10 = 2, and in the basin of `worse` to 3 + 0.1 * 8 = 3.8.
  ASSERT_EQ(results_.runs.size(), 4u);
  EXPECT_EQ(results_.runs[0].to_target[0][0], 4.0);
  EXPECT_EQ(results_.runs[1].to_target[0][0], std::numeric_limits<double>::infinity());
  EXPECT_EQ(results_.runs[1].to_own_target[0][0], 6.0);
}

TEST_F(BenchBasins, AreCountedPerSolver) {
  const CsvTable table = SolverTable(results_);
  for (const auto& [solver, solved, best] : {std::tuple{"best", "1", "1"},
                                             {"worse", "0", "0"},
                                             {"best_too", "1", "1"},
                                             {"nowhere", "1", "0"}}) {
    const CsvTable row = RowOf(table, solver);
    EXPECT_EQ(row.Text(0, "kind"), "free");
    EXPECT_EQ(row.Text(0, "solved"), solved) << solver;
    EXPECT_EQ(row.Text(0, "best_basin"), best) << solver;
    EXPECT_EQ(row.Text(0, "of_basins"), "1");
  }
  const CsvTable runs = RunTable(results_);
  EXPECT_EQ(RowOf(runs, "worse").Text(0, "basin"), "2");
  EXPECT_EQ(RowOf(runs, "worse").Number(0, "gap"), 0.25);  // (3.5 - 1) / 10
  EXPECT_EQ(RowOf(runs, "nowhere").Text(0, "basin"), "");
}

TEST_F(BenchBasins, OfTwoEndsThatDifferMakeNoPair) {
  const CsvTable table = PairTable(results_).Where("cost", "evaluations");
  ASSERT_EQ(table.num_rows(), 1u);
  EXPECT_EQ(table.Text(0, "first"), "best");
  EXPECT_EQ(table.Text(0, "second"), "best_too");
  EXPECT_EQ(table.Text(0, "first_less"), "1");
}

TEST(BenchTables, KindsOfParametersHaveRowsOfTheirOwn) {
  HandMadeBench bench({0.1});
  bench.AddInstance("p", 0.0);
  bench.AddInstance("q", 0.0);
  bench.AddRun("p", "both", {{1, 0.0, 10.0}, {5, 0.2, 0.5}});
  bench.AddRun("q", "both", {{1, 0.0, 10.0}, {7, 0.2, 0.5}})["parameter_kind"] = "projected";
  bench.AddRun("p", "fixed_only", {{1, 0.0, 10.0}, {5, 0.2, 0.5}});
  bench.AddRow("q", "fixed_only", "skipped")["parameter_kind"] = "projected";
  const CsvTable table = SolverTable(bench.Results());
  EXPECT_THAT(table.Where("solver", "both").Distinct("kind"), ElementsAre("fixed", "projected"));
  EXPECT_THAT(table.Where("solver", "fixed_only").Distinct("kind"), ElementsAre("fixed"));
}

TEST(BenchTables, PairsAreCountedForEachKindOfParametersByItself) {
  HandMadeBench bench({0.1});
  const auto Add = [&bench](const std::string& problem, const std::string& kind, int a, int b) {
    bench.AddInstance(problem, 0.0);
    bench.AddRun(problem, "a", {{1, 0.0, 10.0}, {a, 0.2, 0.5}})["parameter_kind"] = kind;
    bench.AddRun(problem, "b", {{1, 0.0, 10.0}, {b, 0.2, 0.5}})["parameter_kind"] = kind;
  };
  Add("p", "fixed", 5, 7);
  Add("q", "fixed", 5, 8);
  Add("r", "projected", 9, 4);
  const CsvTable table = PairTable(bench.Results()).Where("cost", "evaluations");
  EXPECT_THAT(table.Distinct("kind"), ElementsAre("fixed", "projected"));
  for (const auto& [kind, instances, less, more] :
       {std::tuple{"fixed", "2", "2", "0"}, {"projected", "1", "0", "1"}}) {
    const CsvTable row = table.Where("kind", kind);
    ASSERT_EQ(row.num_rows(), 1u) << kind;
    EXPECT_EQ(row.Text(0, "instances"), instances) << kind;
    EXPECT_EQ(row.Text(0, "first_less"), less) << kind;
    EXPECT_EQ(row.Text(0, "second_less"), more) << kind;
  }
}

TEST(BenchTargets, TheNoiseFloorIsTheEnergyOfTheTruth) {
  HandMadeBench bench({});
  nlohmann::json& noisy = bench.AddInstance("noisy", 1.0);
  noisy["noise"] = 0.1;
  noisy["truth_energy"] = 2.0;
  bench.AddInstance("exact", 0.0)["truth_energy"] = 0.0;
  for (const char* problem : {"noisy", "exact"}) {
    bench.AddRun(problem, "s", {{1, 0.0, 9.0}, {5, 0.1, 2.5}, {7, 0.2, 2.0}, {9, 0.3, 1.0}});
  }
  const BenchResults results = bench.Results();
  ASSERT_EQ(results.targets.size(), 1u);
  EXPECT_EQ(results.targets[0].label, "noise floor");
  std::vector<std::size_t> rows_of;
  EXPECT_EQ(CostsOf(results, 0, BenchCost::kEvaluations, &rows_of), CostTable({{7.0}}));
  EXPECT_THAT(rows_of, ElementsAre(0u));
}

TEST(BenchTargets, AGapWithinTheRoundingOfTheEnergyIsNone) {
  HandMadeBench bench({1e-6, 1e-7});
  bench.AddInstance("large", 1e6);  // 1000 eps of it: 2.2e-7, of a fall of 1
  bench.AddRun("large", "s", {{1, 0.0, 1e6 + 1.0}, {5, 0.1, 1e6}});
  bench.AddInstance("at_its_minimum", 3.0);
  bench.AddRun("at_its_minimum", "s", {{1, 0.0, 3.0}});
  const BenchResults results = bench.Results();
  EXPECT_EQ(CostsOf(results, 0, BenchCost::kEvaluations, nullptr), CostTable({{5.0}}));
  EXPECT_TRUE(CostsOf(results, 1, BenchCost::kEvaluations, nullptr).empty());
  EXPECT_THAT(results.notes, Contains(HasSubstr("gap 1e-07: left out on 2 of 2 instances")));
  EXPECT_THAT(results.notes, Contains(HasSubstr("gap 1e-06: left out on 1 of 2 instances")));
}

/// How often `part` stands in `text`.
int CountOf(const std::string& text, const std::string& part) {
  int count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

TEST(TablesLatex, SetsAFloatForEachGroupAndForAsManyRowsAsAPageHas) {
  CsvTable table({"target", "solver", "seconds", "basin", "long"});
  for (std::size_t k = 0; k <= kMostLatexRows; ++k) {
    table.AddRow({"gap_1", "s" + std::to_string(k), "1.5e-03", "", "words"});
  }
  table.AddRow({"gap_2", "cg", "2", "", "words"});
  const std::string text = TablesLatex(table, "a_b", {"target"}, {"solver", "seconds", "basin"});
  EXPECT_EQ(CountOf(text, "\\begin{table*}"), 3);
  EXPECT_EQ(CountOf(text, "\\end{table*}"), 3);
  EXPECT_THAT(text, HasSubstr("\\caption{a\\_b: target gap\\_1}"));
  EXPECT_THAT(text, HasSubstr("\\caption{a\\_b: target gap\\_1, continued}"));
  EXPECT_THAT(text, HasSubstr("\\caption{a\\_b: target gap\\_2}"));
  // No column of basins, of which there are none, and none that was not asked for.
  EXPECT_EQ(CountOf(text, "solver & seconds \\\\\n"), 3);
  EXPECT_EQ(CountOf(text, "\\begin{tabular}{lr}"), 3);
  EXPECT_EQ(CountOf(text, "s50 & $1.5\\cdot10^{-3}$ \\\\\n"), 1);
  EXPECT_EQ(CountOf(text, "words"), 0);
}

TEST(TablesLatex, LeavesNoMoreFloatsWaitingThanLatexHolds) {
  CsvTable table({"target", "solver"});
  for (int k = 0; k < 25; ++k) table.AddRow({std::to_string(k), "cg"});
  EXPECT_EQ(CountOf(TablesLatex(table, "t", {"target"}, {"solver"}), "\\clearpage"), 2);
}

TEST(BenchTables, OfRunsLatexShowsThoseOfAnInstanceTogether) {
  HandMadeBench bench({0.1});
  for (const char* problem : {"p", "q"}) {
    bench.AddInstance(problem, 0.0);
    bench.AddRun(problem, "cg", {{1, 0.0, 10.0}, {5, 0.1, 0.5}});
    bench.AddRun(problem, "gim", {{1, 0.0, 10.0}, {9, 0.1, 0.5}});
  }
  FileBatch batch;
  std::string error;
  ASSERT_TRUE(WriteBenchTables(bench.Results(), bench.folder().path(), &batch, &error)) << error;
  ASSERT_TRUE(batch.Commit(&error)) << error;
  std::ifstream file(bench.folder().path() / "table.tex");
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  EXPECT_EQ(CountOf(text, "\\begin{table*}"), 2);
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(CountOf(line, " & "), 12) << line;
}

TEST(BenchTables, OfPairsLatexKeepsKindsOfParametersApart) {
  HandMadeBench bench({0.1});
  for (const char* kind : {"fixed", "free"}) {
    bench.AddInstance(kind, 0.0);
    bench.AddRun(kind, "cg", {{1, 0.0, 10.0}, {5, 0.1, 0.5}})["parameter_kind"] = kind;
    bench.AddRun(kind, "gim", {{1, 0.0, 10.0}, {9, 0.1, 0.5}})["parameter_kind"] = kind;
  }
  FileBatch batch;
  std::string error;
  ASSERT_TRUE(WriteBenchTables(bench.Results(), bench.folder().path(), &batch, &error)) << error;
  ASSERT_TRUE(batch.Commit(&error)) << error;
  std::ifstream file(bench.folder().path() / "pairs.tex");
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  EXPECT_EQ(CountOf(text, "kind fixed"), 3);  // by evaluations, work units and seconds
  EXPECT_EQ(CountOf(text, "kind free"), 3);
}

TEST(BenchTables, FilesHoldAllDigitsAndForPeopleFour) {
  HandMadeBench bench({0.1});
  bench.AddInstance("p", 0.0);
  bench.AddRun("p", "s", {{1, 0.0, 10.0}, {5, 0.123456789, 0.5}});
  FileBatch batch;
  std::string error;
  ASSERT_TRUE(WriteBenchTables(bench.Results(), bench.folder().path(), &batch, &error)) << error;
  ASSERT_TRUE(batch.Commit(&error)) << error;
  const auto Read = [&bench](const char* name) {
    std::ifstream file(bench.folder().path() / name);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  };
  EXPECT_THAT(Read("table.csv"), HasSubstr(",0.123456789,"));
  EXPECT_THAT(Read("table.md"), HasSubstr("| 0.1235 |"));
  EXPECT_THAT(Read("notes.md"), HasSubstr("1 of 1 cells are finished."));
}

}  // namespace
}  // namespace batten
