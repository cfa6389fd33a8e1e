// Every verdict of the reproduction from hand-made tables, each way it can come out.
#include "experiments/anderson_paper.h"

#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "cost_functions/options.h"
#include "experiments/anderson_paper_growth.h"
#include "experiments/anderson_paper_runs.h"
#include "tests/experiments/hand_made_tables.h"

namespace batten {
namespace {

using ::testing::HasSubstr;

/// All that is not said of a method's runs on an example.
struct Method {
  const char* polished = "1";
  const char* iterations_to_gap = "100";
  const char* seconds_to_gap = "0.1";
  const char* projections = "200";
  const char* rejected = "0.2";
};

/// Both methods on all examples alike but for the last.
ExperimentTables Examples(const Method& lbfgs, const Method& anderson, const Method& last) {
  ExperimentTables tables;
  CsvTable& table = tables[""] = CsvTable(FreeRunColumns());
  tables["traces"] = CsvTable(FreeTraceColumns());
  for (const std::string& example : PaperExampleNames()) {
    const auto row = [&](const char* solver, const Method& method) {
      AddCells({{"example", example},
                {"solver", solver},
                {"iterations", "100"},
                {"projections", method.projections},
                {"polished_energy", method.polished},
                {"iterations_to_1e-6", method.iterations_to_gap},
                {"seconds_to_1e-6", method.seconds_to_gap},
                {"rejected", method.rejected}},
               &table);
    };
    row(kJointLbfgs, lbfgs);
    row(kAndersonPdm, example == PaperExampleNames().back() ? last : anderson);
  }
  return tables;
}

/// The same of the whole table without its last row.
ExperimentTables WithoutLastRow(ExperimentTables tables, const std::string& name = "") {
  const CsvTable whole = tables.at(name);
  CsvTable& table = tables[name] = CsvTable(whole.columns());
  for (std::size_t row = 0; row + 1 < whole.num_rows(); ++row) {
    std::vector<std::string> cells;
    for (const std::string& column : whole.columns()) cells.push_back(whole.Text(row, column));
    table.AddRow(cells);
  }
  return tables;
}

TEST(AndersonPaper, ListsItsExperimentsWithDifferentNamesAndRules) {
  const Reproduction reproduction = AndersonPaper();
  EXPECT_EQ(reproduction.experiments.size(), 5U);
  EXPECT_EQ(FindReproduction("anderson")->title, reproduction.title);
  std::set<std::string> names;
  for (const Experiment& experiment : reproduction.experiments) {
    EXPECT_TRUE(names.insert(experiment.name).second);
    EXPECT_FALSE(experiment.claims.empty()) << experiment.name;
    EXPECT_FALSE(experiment.figures.empty()) << experiment.name;
    for (const SourceClaim& claim : experiment.claims) {
      EXPECT_THAT(claim.rule, ::testing::AnyOf(HasSubstr("holds"), HasSubstr("Holds")));
      EXPECT_FALSE(claim.place.empty()) << claim.quote;
    }
  }
}

TEST(AndersonPaper, JudgesWhichIsFasterWhereBothEndInOneBasin) {
  const Experiment experiment = AndersonPaperExamples();
  const Method lbfgs;
  const Method faster = {"1.0005", "50", "0.05"};
  const Method slower = {"1.0005", "150", "0.15"};
  const Method elsewhere = {"2", "1", "0.001"};
  const Method never = {"1", "nan", "nan"};
  const Method fewer_but_dearer = {"1", "50", "0.2"};
  EXPECT_EQ(VerdictOn(experiment, Examples(lbfgs, faster, faster)), kHolds);
  EXPECT_EQ(VerdictOn(experiment, Examples(lbfgs, faster, slower)), kInPart);
  EXPECT_EQ(VerdictOn(experiment, Examples(lbfgs, fewer_but_dearer, fewer_but_dearer)), kInPart);
  EXPECT_EQ(VerdictOn(experiment, Examples(lbfgs, slower, slower)), kDoesNotHold);
  EXPECT_EQ(VerdictOn(experiment, Examples(lbfgs, never, never)), kDoesNotHold);
  EXPECT_EQ(VerdictOn(experiment, Examples(never, faster, faster)), kHolds);
  // Another minimum says nothing of speed, nor do two that do not get there.
  EXPECT_EQ(VerdictOn(experiment, Examples(lbfgs, faster, elsewhere)), kHolds);
  EXPECT_EQ(VerdictOn(experiment, Examples(lbfgs, elsewhere, elsewhere)), kUndecided);
  EXPECT_EQ(VerdictOn(experiment, Examples(never, never, never)), kUndecided);
  EXPECT_EQ(VerdictOn(experiment, WithoutLastRow(Examples(lbfgs, faster, faster))), kUndecided);
}

/// Both methods' errors at four times, the same on all examples but the last.
ExperimentTables Traces(const std::vector<double>& lbfgs, const std::vector<double>& anderson,
                        const std::vector<double>& last, const Method& method = Method()) {
  ExperimentTables tables = Examples(Method(), method, method);
  for (const std::string& example : PaperExampleNames()) {
    const auto rows = [&](const char* solver, const std::vector<double>& errors) {
      for (std::size_t k = 0; k < errors.size(); ++k) {
        AddCells({{"example", example},
                  {"solver", solver},
                  {"iteration", std::to_string(k)},
                  {"seconds", NumberText(static_cast<double>(k + 1))},
                  {"foot_energy", NumberText(errors[k])}},
                 &tables["traces"]);
      }
    };
    rows(kJointLbfgs, lbfgs);
    rows(kAndersonPdm, example == PaperExampleNames().back() ? last : anderson);
  }
  return tables;
}

TEST(AndersonPaper, JudgesErrorsAtEqualTimes) {
  const Experiment experiment = AndersonPaperExamples();
  const std::vector<double> middle = {9.0, 4.0, 2.0, 1.0};
  const std::vector<double> below = {9.0, 3.0, 1.5, 1.0};
  const std::vector<double> above = {9.0, 5.0, 3.0, 1.0};
  // Ahead from the third of four times on: log(4 / 3) of log(4 / 2).
  const std::vector<double> late = {9.0, 5.0, 1.0, 1.0};
  const std::vector<double> early = {9.0, 3.0, 3.0, 1.0};
  EXPECT_EQ(VerdictOn(experiment, Traces(middle, below, below), 1), kHolds);
  EXPECT_EQ(VerdictOn(experiment, Traces(middle, below, late), 1), kInPart);
  EXPECT_EQ(VerdictOn(experiment, Traces(middle, early, early), 1), kInPart);
  EXPECT_EQ(VerdictOn(experiment, Traces(middle, above, late), 1), kDoesNotHold);
  EXPECT_EQ(VerdictOn(experiment, Traces(middle, below, {}), 1), kUndecided);
  EXPECT_EQ(VerdictOn(experiment, Traces(middle, below, below, {"2"}), 1), kUndecided);
  EXPECT_EQ(VerdictOn(experiment, WithoutLastRow(Traces(middle, below, below)), 1), kUndecided);
}

TEST(AndersonPaper, JudgesWhetherBothStartAlike) {
  const Experiment experiment = AndersonPaperExamples();
  const std::vector<double> errors = {9.0, 8.0, 7.0, 6.0, 5.0, 4.0, 3.0};
  const std::vector<double> near = {9.0, 4.1, 4.0, 11.9, 5.0, 4.0, 0.1};
  const std::vector<double> far = {9.0, 8.0, 7.0, 6.0, 5.0, 1.9, 3.0};
  const std::vector<double> too_short = {9.0, 8.0, 7.0, 6.0, 5.0};
  EXPECT_EQ(VerdictOn(experiment, Traces(errors, near, near), 2), kHolds);
  EXPECT_EQ(VerdictOn(experiment, Traces(errors, near, far), 2), kInPart);
  EXPECT_EQ(VerdictOn(experiment, Traces(errors, far, far), 2), kDoesNotHold);
  EXPECT_EQ(VerdictOn(experiment, Traces(errors, near, too_short), 2), kUndecided);
}

TEST(AndersonPaper, JudgesProjectionsAndRejections) {
  const Experiment experiment = AndersonPaperExamples();
  const Method lbfgs;
  const Method often = {"1", "100", "0.1", "100", "0.5"};
  const Method seldom = {"1", "100", "0.1", "99", "0.49"};
  for (const std::size_t claim : {3U, 5U}) {
    EXPECT_EQ(VerdictOn(experiment, Examples(lbfgs, seldom, seldom), claim), kHolds);
    EXPECT_EQ(VerdictOn(experiment, Examples(lbfgs, seldom, often), claim), kInPart);
    EXPECT_EQ(VerdictOn(experiment, Examples(lbfgs, often, often), claim), kDoesNotHold);
    EXPECT_EQ(VerdictOn(experiment, WithoutLastRow(Examples(lbfgs, often, often)), claim),
              kUndecided);
  }
}

TEST(AndersonPaper, JudgesWhetherUndampedTdmDiverges) {
  const Experiment experiment = AndersonPaperExamples();
  const auto tables = [](const char* first, const char* last) {
    ExperimentTables made;
    CsvTable& table = made[""] = CsvTable(FreeRunColumns());
    for (const std::string& example : PaperExampleNames()) {
      AddCells({{"example", example},
                {"solver", kUndampedTdm},
                {"start_energy", "2"},
                {"foot_energy", example == PaperExampleNames().back() ? last : first}},
               &table);
    }
    return made;
  };
  EXPECT_EQ(VerdictOn(experiment, tables("3", "nan"), 4), kHolds);
  EXPECT_EQ(VerdictOn(experiment, tables("3", "2"), 4), kInPart);
  EXPECT_EQ(VerdictOn(experiment, tables("1", "2"), 4), kDoesNotHold);
  EXPECT_EQ(VerdictOn(experiment, WithoutLastRow(tables("3", "3")), 4), kUndecided);
}

/// `tables` of the paper's examples with the rows that the last one has in `from` given to ours.
ExperimentTables WithOurExample(ExperimentTables tables, const ExperimentTables& from) {
  const std::string& ours = ShownExampleNames().back();
  for (auto& [name, table] : tables) {
    const CsvTable rows = from.at(name).Where("example", PaperExampleNames().back());
    for (std::size_t row = 0; row < rows.num_rows(); ++row) {
      Cells cells;
      for (const std::string& column : rows.columns()) {
        cells.emplace_back(column, column == "example" ? ours : rows.Text(row, column));
      }
      AddCells(cells, &table);
    }
  }
  return tables;
}

TEST(AndersonPaper, TellsWhatOurExampleGivesAndJudgesByThePapersAlone) {
  const Experiment experiment = AndersonPaperExamples();
  const std::vector<double> middle = {9.0, 4.0, 2.0, 1.0, 1.0, 1.0};
  const std::vector<double> above = {9.0, 40.0, 20.0, 10.0, 10.0, 10.0};
  const Method slower = {"1.0005", "150", "0.15", "300", "0.9"};
  const Method faster = {"1.0005", "50", "0.05", "90", "0.1"};
  const ExperimentTables slow = Traces(middle, above, above, slower);
  const ExperimentTables fast = Traces(middle, middle, middle, faster);
  for (const std::size_t claim : {0U, 1U, 2U, 3U, 5U}) {
    for (const auto& [paper, ours] : {std::pair(slow, fast), std::pair(fast, slow)}) {
      const auto& judge = experiment.claims[claim].judge;
      const Judgement alone = judge(paper);
      const Judgement both = judge(WithOurExample(paper, ours));
      EXPECT_EQ(both.verdict, alone.verdict) << claim;
      EXPECT_NE(judge(ours).verdict, alone.verdict) << claim;
      EXPECT_THAT(both.because, HasSubstr("crawling (ours), not counted")) << claim;
      EXPECT_THAT(both.because, ::testing::StartsWith(alone.because)) << claim;
    }
  }
}

TEST(AndersonPaper, TellsUndampedTdmOnOurExampleAndJudgesByThePapersAlone) {
  const auto tables = [](const char* end) {
    ExperimentTables made;
    CsvTable& table = made[""] = CsvTable(FreeRunColumns());
    for (const std::string& example : PaperExampleNames()) {
      AddCells({{"example", example},
                {"solver", kUndampedTdm},
                {"start_energy", "2"},
                {"foot_energy", end}},
               &table);
    }
    return made;
  };
  const Experiment experiment = AndersonPaperExamples();
  const ExperimentTables diverging = tables("3"), falling = tables("1");
  const ExperimentTables falls_on_ours = WithOurExample(diverging, falling);
  EXPECT_EQ(VerdictOn(experiment, falls_on_ours, 4), kHolds);
  EXPECT_EQ(VerdictOn(experiment, WithOurExample(falling, diverging), 4), kDoesNotHold);
  EXPECT_THAT(experiment.claims[4].judge(falls_on_ours).because,
              HasSubstr("crawling (ours), not counted: 2.00 to 1.00"));
}

struct Windows {
  const char* small;  // iterations with windows 1 to 6
  const char* large;  // with those above
  const char* polished_of_large = "1";
};

ExperimentTables WindowTables(const Windows& first, const Windows& last) {
  ExperimentTables tables;
  std::vector<std::string> columns = {"window"};
  for (const std::string& column : FreeRunColumns()) columns.push_back(column);
  CsvTable& table = tables[""] = CsvTable(columns);
  for (const std::string& example : PaperExampleNames()) {
    const Windows& on = example == PaperExampleNames().back() ? last : first;
    for (const int window : {1, 2, 3, 4, 5, 6, 7, 8, 10, 15, 20}) {
      AddCells({{"window", std::to_string(window)},
                {"example", example},
                {"polished_energy", window > 6 ? on.polished_of_large : "1"},
                {"iterations_to_1e-6", window > 6 ? on.large : on.small}},
               &table);
    }
  }
  return tables;
}

TEST(AndersonPaper, JudgesTheWindow) {
  const Experiment experiment = AndersonPaperWindow();
  EXPECT_EQ(VerdictOn(experiment, WindowTables({"100", "90"}, {"100", "200"})), kHolds);
  EXPECT_EQ(VerdictOn(experiment, WindowTables({"100", "nan"}, {"100", "100"})), kHolds);
  EXPECT_EQ(VerdictOn(experiment, WindowTables({"100", "90"}, {"100", "89"})), kInPart);
  EXPECT_EQ(VerdictOn(experiment, WindowTables({"100", "70"}, {"nan", "100"})), kDoesNotHold);
  EXPECT_EQ(VerdictOn(experiment, WindowTables({"100", "10", "2"}, {"100", "100"})), kHolds);
  EXPECT_EQ(VerdictOn(experiment, WindowTables({"100", "10", "2"}, {"nan", "nan"})), kUndecided);
  EXPECT_EQ(VerdictOn(experiment, WithoutLastRow(WindowTables({"100", "90"}, {"100", "90"}))),
            kUndecided);
}

/// Times that grow like size^power; those of `other` like size^other_power.
ExperimentTables Growth(const std::string& size, double power, const char* other,
                        double other_power, int sizes = 3) {
  ExperimentTables tables;
  CsvTable& table = tables[""] = CsvTable(GrowthColumns());
  for (int k = 0; k < sizes; ++k) {
    const double value = 8.0 * std::pow(2.0, k);
    for (const char* solver : {kJointLbfgs, kAndersonPdm, "pdm", "tdm", "sdm"}) {
      const double grows = std::string(solver) == other ? other_power : power;
      AddCells({{size, NumberText(value)},
                {"solver", solver},
                {"seconds_per_iteration", NumberText(1e-6 * std::pow(value, grows))}},
               &table);
    }
  }
  return tables;
}

TEST(AndersonPaper, JudgesTheCostPerIteration) {
  const std::pair<const char*, Experiment> experiments[] = {
      {"points", AndersonPaperPoints()}, {"control_points", AndersonPaperControlPoints()}};
  for (const auto& [size, experiment] : experiments) {
    EXPECT_EQ(VerdictOn(experiment, Growth(size, 1.1, "pdm", 3.0)), kHolds);
    EXPECT_EQ(VerdictOn(experiment, Growth(size, 1.1, kAndersonPdm, 1.2)), kInPart);
    EXPECT_EQ(VerdictOn(experiment, Growth(size, 1.2, "pdm", 1.0)), kDoesNotHold);
    EXPECT_EQ(VerdictOn(experiment, Growth(size, 1.0, "pdm", 1.0, 1)), kUndecided);
    EXPECT_EQ(VerdictOn(experiment, Growth(size, 1.6, kJointLbfgs, 1.0), 1), kHolds);
    EXPECT_EQ(VerdictOn(experiment, Growth(size, 1.6, "sdm", 1.4), 1), kInPart);
    EXPECT_EQ(VerdictOn(experiment, Growth(size, 1.0, kJointLbfgs, 3.0), 1), kDoesNotHold);
    EXPECT_EQ(VerdictOn(experiment, {{"", CsvTable(GrowthColumns())}}, 1), kUndecided);
  }
}

/// Polished E and iterations from the third start; the other two have 1 and 100.
ExperimentTables Starts(const char* polished, const char* iterations, bool of_lbfgs_too) {
  ExperimentTables tables;
  CsvTable& table = tables[""] = CsvTable(FreeRunColumns());
  for (const std::string& example : PaperExampleNames()) {
    for (const char* solver : {kJointLbfgs, kAndersonPdm}) {
      for (const std::string start : {"circle", "ellipse", "disturbed circle"}) {
        const bool other = start == "disturbed circle" && (of_lbfgs_too || solver == kAndersonPdm);
        AddCells({{"example", example},
                  {"solver", solver},
                  {"start", start},
                  {"polished_energy", other ? polished : "1"},
                  {"iterations_to_1e-6", other ? iterations : "100"}},
                 &table);
      }
    }
  }
  return tables;
}

TEST(AndersonPaper, TellsWindowsAndStartsOfOurExampleWithoutCountingThem) {
  const std::tuple<Experiment, ExperimentTables, ExperimentTables> cases[] = {
      {AndersonPaperWindow(), WindowTables({"100", "90"}, {"100", "90"}),
       WindowTables({"100", "10"}, {"100", "10"})},
      {AndersonPaperStarts(), Starts("1", "100", true), Starts("2", "100", true)}};
  for (const auto& [experiment, paper, other] : cases) {
    ASSERT_EQ(VerdictOn(experiment, paper), kHolds);
    const ExperimentTables both = WithOurExample(paper, other);
    EXPECT_EQ(VerdictOn(experiment, both), kHolds) << experiment.name;
    EXPECT_THAT(experiment.claims[0].judge(both).because,
                HasSubstr("crawling (ours), not counted"));
  }
}

TEST(AndersonPaper, JudgesTheStarts) {
  const Experiment experiment = AndersonPaperStarts();
  EXPECT_EQ(VerdictOn(experiment, Starts("1.0009", "200", true)), kHolds);
  EXPECT_EQ(VerdictOn(experiment, Starts("1.002", "100", false)), kInPart);
  EXPECT_EQ(VerdictOn(experiment, Starts("1", "201", true)), kDoesNotHold);
  EXPECT_EQ(VerdictOn(experiment, Starts("1", "nan", true)), kDoesNotHold);
  EXPECT_EQ(VerdictOn(experiment, Starts("2", "100", true)), kDoesNotHold);
  EXPECT_EQ(VerdictOn(experiment, WithoutLastRow(Starts("1", "100", true))), kUndecided);
}

TEST(AndersonPaper, ShowsWhatIsLeftOfTablesWithRowsTakenOut) {
  std::vector<std::string> columns = {"window"};
  for (const std::string& column : FreeRunColumns()) columns.push_back(column);
  CsvTable table(columns);
  AddCells({{"example", "smooth"}, {"solver", kJointLbfgs}, {"points", "100"}}, &table);
  CsvTable traces(FreeTraceColumns());
  AddCells({{"example", "smooth"}, {"solver", kJointLbfgs}, {"iteration", "0"}}, &traces);
  for (const Experiment& experiment : AndersonPaper().experiments) {
    const ExperimentTables tables = {
        {"", table}, {"traces", traces}, {"curves", CsvTable({"example", "solver", "x", "y"})}};
    for (std::size_t claim = 0; claim < experiment.claims.size(); ++claim) {
      EXPECT_EQ(VerdictOn(experiment, tables, claim), kUndecided) << experiment.name << claim;
    }
    for (const ExperimentFigure& figure : experiment.figures) figure.panels(tables);
    if (experiment.shown) experiment.shown(tables);
  }
}

TEST(AndersonPaper, ScalesItsExamplesToTheUnitBox) {
  std::vector<PaperExample> examples;
  std::string error;
  ASSERT_TRUE(ShownExamples(&examples, &error)) << error;
  ASSERT_EQ(examples.size(), PaperExampleNames().size() + 1);
  for (const PaperExample& example : examples) {
    // Noise moves points by 0.03 at most.
    EXPECT_GE(example.points.minCoeff(), -0.03) << example.name;
    EXPECT_LE(example.points.maxCoeff(), 1.03) << example.name;
    EXPECT_GT(example.points.maxCoeff(), 0.97) << example.name;
  }
  EXPECT_EQ(examples[0].points.rows(), 100);
  EXPECT_EQ(examples[1].points.rows(), 90);
  EXPECT_EQ(examples[2].points.rows(), 200);
}

TEST(AndersonPaper, RunsThePapersTwoMethodsAndAllThatAreDrawn) {
  for (const char* method : kDrawnMethods) {
    EXPECT_THAT(IteratingMethods(), ::testing::Contains(method));
  }
}

TEST(AndersonPaper, CountsProjectionsAndReachesThePolishedMinimum) {
  std::vector<PaperExample> examples;
  std::string error;
  ASSERT_TRUE(ShownExamples(&examples, &error)) << error;
  const PaperExample& smooth = examples.front();
  const FreeCase on = {smooth.name, "circle",
                       FreeFit(smooth.points, smooth.control_points, "circle")};
  CsvTable runs(FreeRunColumns());
  CsvTable traces(FreeTraceColumns());
  for (const char* solver : {kJointLbfgs, "newton", "tdm"}) {
    RunFree(on, solver, FreeRaceSpec(), 1, &runs, &traces);
  }
  // Sums of 100 squares, seen from other starting parameters and in other units.
  constexpr double kRounding = 1e-12;
  ASSERT_EQ(runs.num_rows(), 3U);
  EXPECT_EQ(runs.Text(0, "projections"), "0");
  EXPECT_GT(runs.Number(2, "projections"), runs.Number(2, "iterations"));
  for (std::size_t row = 0; row < runs.num_rows(); ++row) {
    const double polished = runs.Number(row, "polished_energy");
    EXPECT_LE(polished, runs.Number(row, "foot_energy"));
    // A foot is never farther than the point at t.
    EXPECT_LE(runs.Number(row, "foot_energy"), (1.0 + kRounding) * runs.Number(row, "energy"));
    EXPECT_GE(runs.Number(row, "free_loops"), 0.0);
    EXPECT_LE(runs.Number(row, "iterations_to_1e-6"), runs.Number(row, "iterations"));
    const double start = runs.Number(0, "start_energy");
    EXPECT_NEAR(runs.Number(row, "start_energy"), start, kRounding * start);
  }
}

}  // namespace
}  // namespace batten
