#include "experiments/run_recorder.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "experiments/anderson_paper_runs.h"
#include "experiments/experiment_runs.h"
#include "experiments/report_document.h"
#include "tests/experiments/figure_files.h"
#include "tests/problems/scratch_folder.h"

namespace batten {
namespace {

namespace fs = std::filesystem;
using CellRow = nlohmann::json;
using ::testing::HasSubstr;

std::vector<CellRow> Rows(const fs::path& folder) {
  std::vector<CellRow> rows;
  std::ifstream file(folder / "cells.jsonl");
  for (std::string line; std::getline(file, line);) rows.push_back(CellRow::parse(line));
  return rows;
}

class Recording : public ::testing::Test {
 protected:
  /// Runs on a loop, under a recorder of its own.
  void Record(const std::string& experiment, const std::vector<std::string>& solvers,
              RunSpec spec = RaceSpec(1e-10)) {
    RunRecorder recorder(folder_.string(), experiment);
    ProblemRuns on("loop", LoopProblem(60, 10, 1.0), 1, &recorder);
    CsvTable table(RunColumns());
    for (const std::string& solver : solvers) on.Run(solver, spec, &table);
    std::string error;
    EXPECT_TRUE(recorder.Commit(&error)) << error;
  }
  ScratchFolder scratch_;
  fs::path folder_ = scratch_.path();
};

TEST_F(Recording, KeepsRowsTracesAndIteratesThatTheReportReads) {
  Record("size", {"lbfgs", "banded_qr"});
  const std::vector<CellRow> rows = Rows(folder_);
  ASSERT_EQ(rows.size(), 2u);  // without banded_cholesky, by which times are measured
  EXPECT_EQ(rows[0]["solver"], "lbfgs");
  EXPECT_EQ(rows[0]["experiment"], "size");
  EXPECT_EQ(rows[0]["problem"], "size: loop, 60 points, 10 control points, race 1e-10");
  EXPECT_EQ(rows[0]["verified"], true);
  EXPECT_LT(rows[0]["gap"].get<double>(), 1e-12);
  EXPECT_GT(rows[0]["seconds"].get<double>(), 0.0);
  ReportDocument document;
  std::string error;
  ASSERT_TRUE(ReadReportDocument(folder_.string(), ReportLimits(), &document, &error)) << error;
  EXPECT_EQ(document.num_cells, 2);
  const CellRow summary = CellRow::parse(document.summary);
  EXPECT_EQ(summary["groups"].size(), 1u);
  EXPECT_EQ(summary["groups"][0]["direct"], true);
  const std::string key = rows[0]["key"];
  const CellRow trace = CellRow::parse(document.traces)[key];
  EXPECT_EQ(trace[0], rows[0]["iterations"].get<int>() + 1);
  EXPECT_EQ(CellRow::parse(document.curves)["runs"][key]["iterates"], trace[0]);
}

TEST_F(Recording, ReplacesTheRowsOfItsExperimentAlone) {
  Record("a", {"lbfgs", "cg"});
  Record("b", {"cg"});
  Record("a", {"banded_qr"});
  const std::vector<CellRow> rows = Rows(folder_);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0]["experiment"], "b");
  EXPECT_EQ(rows[1]["experiment"], "a");
  EXPECT_EQ(rows[1]["solver"], "banded_qr");
}

TEST_F(Recording, TakesAwayTheTraceOfARunThatHasNone) {
  Record("a", {"lbfgs"});
  EXPECT_TRUE(fs::exists(folder_ / "traces/a-0001.csv"));
  RunSpec spec = RaceSpec(1e-10);
  spec.keep_trace = false;
  Record("a", {"lbfgs"}, spec);
  EXPECT_FALSE(fs::exists(folder_ / "traces/a-0001.csv"));
  EXPECT_FALSE(fs::exists(folder_ / "iterates/a-0001.jsonl"));
}

TEST_F(Recording, NamesApartWhatIsNoOneComparison) {
  RunRecorder recorder(folder_.string(), "e");
  CsvTable table(RunColumns());
  for (const double size : {1.0, 100.0}) {
    ProblemRuns on("loop", LoopProblem(60, 10, size), 1, &recorder);
    on.Run("cg", NativeSpec(1e-6), &table);
    on.Run("cg", RaceSpec(1e-8), &table);
    on.Run("cg", RaceSpec(1e-8), &table);
    on.Run("lbfgs", RaceSpec(1e-8), &table);
  }
  std::string error;
  ASSERT_TRUE(recorder.Commit(&error)) << error;
  std::vector<std::string> names;
  for (const CellRow& row : Rows(folder_)) names.push_back(row["problem"]);
  const std::string first = "e: loop, 60 points, 10 control points, ";
  const std::string second = first + "no. 2, ";
  EXPECT_THAT(names, ::testing::ElementsAre(first + "native |g| 1e-06", first + "race 1e-08",
                                            first + "race 1e-08, run 2", first + "race 1e-08",
                                            second + "native |g| 1e-06", second + "race 1e-08",
                                            second + "race 1e-08, run 2", second + "race 1e-08"));
}

TEST_F(Recording, KeepsRunsOfFreeParameters) {
  RunRecorder recorder(folder_.string(), "e");
  const Points points = LoopProblem(60, 8, 1.0)->curve_fit()->data().points;
  CsvTable runs(FreeRunColumns());
  RunFree({"loop", "circle", FreeFit(points, 8, "circle"), &recorder}, "newton", FreeRaceSpec(), 1,
          &runs, nullptr);
  std::string error;
  ASSERT_TRUE(recorder.Commit(&error)) << error;
  const std::vector<CellRow> rows = Rows(folder_);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_THAT(rows[0]["problem"].get<std::string>(),
              HasSubstr("e: loop, from circle, 60 points, 8 control points"));
  EXPECT_EQ(rows[0]["parameter_kind"], "free");
  EXPECT_TRUE(rows[0]["setup_seconds"].is_number());
  EXPECT_TRUE(rows[0]["gap"].is_null());
  EXPECT_TRUE(fs::exists(folder_ / "curves/e-0001.json"));
}

// The audit knows what stands in a fit's specification; it would find |g| of the whole too large.
TEST_F(Recording, DoesNotAuditConstraintsThatAreNoneOfTheSpecification) {
  const auto loop = LoopProblem(60, 10, 1.0);
  std::string error;
  const std::shared_ptr<Problem> tied =
      MakeFitProblem(loop->curve_fit()->data(), loop->curve_fit()->spec(), &error);
  ASSERT_NE(tied, nullptr) << error;
  LinearConstraint constraint;
  constraint.coefficients = {{0, 1.0}, {10, -1.0}};
  ASSERT_TRUE(tied->SetLinearConstraints({constraint}, &error)) << error;
  RunRecorder recorder(folder_.string(), "e");
  ProblemRuns on("tied", tied, 1, &recorder);
  CsvTable table(RunColumns());
  on.Run("cg", RaceSpec(1e-8), &table);
  ASSERT_TRUE(recorder.Commit(&error)) << error;
  const CellRow row = Rows(folder_).at(0);
  EXPECT_TRUE(row["verified"].is_null());
  EXPECT_EQ(row["failure"], "");
  EXPECT_TRUE(row["disagreement"].is_null());
}

TEST_F(Recording, KeepsASkippedRunWithItsReason) {
  Record("a", {"foot_newton"});
  const std::vector<CellRow> rows = Rows(folder_);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0]["stop"], "skipped");
  EXPECT_NE(rows[0]["message"], "");
  EXPECT_TRUE(rows[0]["seconds"].is_null());
}

TEST_F(Recording, WritesNothingWhereNothingRan) {
  Record("a", {});
  EXPECT_FALSE(fs::exists(folder_ / "cells.jsonl"));
  EXPECT_FALSE(fs::exists(folder_ / "traces"));
}

TEST_F(Recording, ThinsLongTraces) {
  RunSpec spec = RaceSpec(0.0);
  spec.max_iterations = 2000;
  Record("a", {"lspia/relaxation=0.01"}, spec);
  std::ifstream file(folder_ / "traces/a-0001.csv");
  int lines = 0;
  std::string last;
  for (std::string line; std::getline(file, line); ++lines) last = line;
  EXPECT_EQ(lines, 501);
  EXPECT_THAT(last, ::testing::StartsWith("2000,"));
}

}  // namespace
}  // namespace batten
