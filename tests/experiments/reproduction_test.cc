#include "experiments/reproduction.h"

#include <gmock/gmock.h>

#include "experiments/experiment_runs.h"
#include "experiments/reproduction_page.h"
#include "tests/experiments/figure_files.h"
#include "tests/problems/scratch_folder.h"

namespace batten {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// One experiment whose table is n and n^2, and a claim that its last square is 9.
Experiment Squares(int* num_runs) {
  Experiment experiment;
  experiment.name = "squares";
  experiment.title = "Squares";
  experiment.text = "The squares of 1, 2, 3.";
  experiment.run = [num_runs](const ExperimentRun& run, ExperimentTables* tables, std::string*) {
    ++*num_runs;
    if (run.progress) run.progress(0.5, "half");
    CsvTable& table = (*tables)[""] = CsvTable({"n", "square"});
    for (int n = 1; n <= 3; ++n) table.AddRow({std::to_string(n), std::to_string(n * n)});
    (*tables)["roots"] = CsvTable({"root"});
    return true;
  };
  experiment.claims = {
      {"nine at last", "page 1", "holds where the last square is 9",
       [](const ExperimentTables& tables) {
         const bool nine = tables.at("").Number(2, "square") == 9.0;
         return Judgement{nine ? ClaimVerdict::kHolds : ClaimVerdict::kDoesNotHold, "it is seen"};
       }}};
  experiment.figures = {
      {"squares_figure", "Squares.", 1, [](const ExperimentTables& tables) {
         PlotPanel panel;
         panel.title = "squares <&>";
         const CsvTable& table = tables.at("");
         panel.series.push_back({"n^2", table.Numbers("n"), table.Numbers("square")});
         return std::vector<PlotPanel>{panel};
       }}};
  return experiment;
}

Reproduction Numbers(int* num_runs) {
  Reproduction reproduction;
  reproduction.name = "numbers";
  reproduction.title = "Numbers";
  reproduction.source = "Euclid";
  reproduction.experiments = {Squares(num_runs)};
  return reproduction;
}

class Reproducing : public ::testing::Test {
 protected:
  ReproductionResult Run(bool resume = false) {
    ReproductionSpec spec;
    spec.folder = folder_.string();
    spec.resume = resume;
    spec.run.progress = [this](double fraction, const std::string& text) {
      fraction_ = fraction;
      text_ = text;
    };
    ReproductionResult result;
    std::string error;
    EXPECT_TRUE(Reproduce(reproduction_, spec, &result, &error)) << error;
    return result;
  }

  int num_runs_ = 0;
  double fraction_ = 0.0;
  std::string text_;
  Reproduction reproduction_ = Numbers(&num_runs_);
  ScratchFolder scratch_;
  std::filesystem::path folder_ = scratch_.path();
};

TEST_F(Reproducing, WritesTablesFiguresAndPages) {
  const ReproductionResult result = Run();
  ASSERT_EQ(result.experiments.size(), 1U);
  EXPECT_EQ(result.experiments[0].judgements[0].verdict, ClaimVerdict::kHolds);
  EXPECT_EQ(fraction_, 0.5);
  EXPECT_EQ(text_, "squares: half");
  for (const char* name : {"squares.csv", "squares_roots.csv", "squares_figure.svg",
                           "squares_figure.gp", "squares_figure.dat", "squares_figure.plot.json"}) {
    EXPECT_TRUE(std::filesystem::is_regular_file(folder_ / name)) << name;
  }
  const std::string page = Contents(folder_ / "numbers.md");
  EXPECT_THAT(page, HasSubstr("> nine at last (page 1)"));
  EXPECT_THAT(page, HasSubstr("**holds**: it is seen"));
  EXPECT_THAT(page, HasSubstr("Rule: holds where the last square is 9"));
  EXPECT_THAT(page, HasSubstr("![squares_figure](squares_figure.svg)"));
  EXPECT_THAT(page, HasSubstr("| 3 | 9 |"));
}

TEST_F(Reproducing, PutsPicturesIntoTheHtmlPage) {
  Run();
  const std::string page = Contents(folder_ / "numbers.html");
  EXPECT_THAT(page, HasSubstr("<img src=\"data:image/svg+xml,"));
  EXPECT_THAT(page, Not(HasSubstr("src=\"squares_figure.svg\"")));
  EXPECT_THAT(page, HasSubstr("<table>"));
}

TEST_F(Reproducing, TakesOverWhatAnEarlierRunHasFinished) {
  Run();
  EXPECT_FALSE(Run().experiments[0].taken_over);
  EXPECT_EQ(num_runs_, 2);
  const ReproductionResult resumed = Run(true);
  EXPECT_TRUE(resumed.experiments[0].taken_over);
  EXPECT_EQ(num_runs_, 2);
  EXPECT_EQ(resumed.experiments[0].tables.at("").ToCsv(), "n,square\n1,1\n2,4\n3,9\n");
}

TEST_F(Reproducing, KeepsTheRunsOfExperimentsAlsoWhereItTakesThemOver) {
  const auto squares = reproduction_.experiments[0].run;
  reproduction_.experiments[0].run = [squares](const ExperimentRun& run, ExperimentTables* tables,
                                               std::string* error) {
    ProblemRuns on("loop", LoopProblem(60, 10, 1.0), 1, run.recorder);
    CsvTable unused(RunColumns());
    on.Run("cg", RaceSpec(1e-8), &unused);
    return squares(run, tables, error);
  };
  Run();
  const std::string cells = Contents(folder_ / "cells.jsonl");
  EXPECT_THAT(cells, HasSubstr("\"experiment\":\"squares\""));
  EXPECT_THAT(cells, HasSubstr("\"solver\":\"cg\""));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "traces/squares-0001.csv"));
  Run(true);
  EXPECT_EQ(Contents(folder_ / "cells.jsonl"), cells);
}

TEST_F(Reproducing, JudgesTheFilesItTakesOver) {
  Run();
  std::string text = Contents(folder_ / "squares.csv");
  text.replace(text.find("3,9"), 3, "3,8");
  std::ofstream(folder_ / "squares.csv") << text;
  EXPECT_EQ(Run(true).experiments[0].judgements[0].verdict, ClaimVerdict::kDoesNotHold);
  EXPECT_THAT(Contents(folder_ / "numbers.md"), HasSubstr("**does not hold**"));
}

TEST_F(Reproducing, RunsAgainWhatIsNotItsOwn) {
  Run();
  std::string text = Contents(folder_ / "squares.csv");
  for (const std::string& broken :
       {"# another program\n" + text, text.substr(0, text.size() - 3), std::string("n,square\n")}) {
    std::ofstream(folder_ / "squares.csv") << broken;
    const int before = num_runs_;
    Run(true);
    EXPECT_EQ(num_runs_, before + 1) << broken;
  }
  std::filesystem::remove(folder_ / "squares_roots.csv");
  EXPECT_FALSE(Run(true).experiments[0].taken_over);
}

TEST_F(Reproducing, KeepsBarsInsideTheCellsOfItsTables) {
  reproduction_.experiments[0].claims[0].quote = "|g| < 1e-10";
  Run();
  EXPECT_THAT(Contents(folder_ / "numbers.md"), HasSubstr("| \\|g\\| < 1e-10 | holds |"));
  EXPECT_THAT(Contents(folder_ / "numbers.html"), HasSubstr("<td>|g| &lt; 1e-10</td>"));
}

TEST(SelfContainedHtml, KeepsTheNameOfAPictureThatIsNotThere) {
  const std::string page = SelfContainedHtml("T", "![a](missing.svg)", "/nowhere");
  EXPECT_THAT(page, HasSubstr("<img src=\"missing.svg\""));
  EXPECT_THAT(page, HasSubstr("<title>T</title>"));
}

}  // namespace
}  // namespace batten
