#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "experiments/anderson_paper.h"
#include "experiments/anderson_paper_judges.h"
#include "experiments/anderson_paper_runs.h"
#include "experiments/experiment_runs.h"

namespace batten {
namespace {

constexpr int kClaimed = 6;
constexpr int kWindows[] = {1, 2, 3, 4, 5, 6, 7, 8, 10, 15, 20};
constexpr int kNumLarge = 5;  // above kClaimed

bool RunWindows(const ExperimentRun& run, ExperimentTables* tables, std::string* error) {
  std::vector<std::string> columns = {"window"};
  for (std::string& column : FreeRunColumns()) columns.push_back(std::move(column));
  CsvTable& runs = (*tables)[""] = CsvTable(columns);
  std::vector<PaperExample> examples;
  if (!ShownExamples(&examples, error)) return false;
  double done = 0.0;
  for (const PaperExample& example : examples) {
    const FreeCase on = {example.name, "circle",
                         FreeFit(example.points, example.control_points, "circle"), run.recorder};
    for (const int window : kWindows) {
      if (InterruptRequested()) return true;
      const std::string text = std::to_string(window);
      if (run.progress) {
        run.progress(done / static_cast<double>(std::size(kWindows) * examples.size()),
                     example.name + " window " + text);
      }
      done += 1.0;
      CsvTable rows(FreeRunColumns());
      RunFree(on, "anderson/window=" + text + ":pdm", FreeRaceSpec(), run.repetitions, &rows,
              nullptr);
      AddRowsBehind({text}, rows, &runs);
    }
  }
  return true;
}

/// The fewest iterations to the gap over windows `first` to `last`; NaN: none comes so far. Of
/// those alone that end in the basin of window 6; `num_others` counts the others.
double Fewest(const CsvTable& on, int first, int last, int* num_others) {
  const double basin = OnlyNumber(on.Where("window", std::to_string(kClaimed)), "polished_energy");
  double fewest = std::numeric_limits<double>::quiet_NaN();
  *num_others = 0;
  for (const int window : kWindows) {
    if (window < first || window > last) continue;
    const CsvTable row = on.Where("window", std::to_string(window));
    if (!InOneBasin(OnlyNumber(row, "polished_energy"), basin)) {
      ++*num_others;
      continue;
    }
    const double count = OnlyNumber(row, "iterations_to_1e-6");
    if (IsSooner(count, fewest)) fewest = count;
  }
  return fewest;
}

std::string ShownCount(double count) { return std::isnan(count) ? "-" : NumberText(count); }

bool AllWindowsThere(const CsvTable& on) {
  for (const int window : kWindows) {
    const CsvTable row = on.Where("window", std::to_string(window));
    if (std::isnan(OnlyNumber(row, "polished_energy"))) return false;
  }
  return true;
}

Judgement JudgeWindow(const ExperimentTables& tables) {
  constexpr double kHelps = 0.9;  // counts of iterations are exact
  Judgement judgement;
  int compared = 0, useless = 0;
  for (const std::string& example : ShownExampleNames()) {
    const bool counts = IsPaperExample(example);
    const CsvTable on = tables.at("").Where("example", example);
    if (!AllWindowsThere(on) && counts) return Judgement();
    if (!AllWindowsThere(on)) continue;
    int small_others = 0, large_others = 0;
    const double small = Fewest(on, 1, kClaimed, &small_others);
    const double large = Fewest(on, kClaimed + 1, std::end(kWindows)[-1], &large_others);
    judgement.because += (judgement.because.empty() ? "" : "; ") + ExampleLabel(example) +
                         (counts ? ": " : ", not counted: ");
    const bool is_comparable =
        large_others < kNumLarge && !(std::isnan(small) && std::isnan(large));
    if (!is_comparable) {
      judgement.because += "windows above 6 end at other minima, or none comes so far";
      continue;
    }
    compared += counts ? 1 : 0;
    useless += counts && !IsSooner(large, kHelps * small) ? 1 : 0;
    judgement.because += ShownCount(large) + " against " + ShownCount(small);
    if (small_others + large_others > 0) {
      judgement.because += " (" + std::to_string(small_others + large_others) + " of " +
                           std::to_string(std::size(kWindows)) + " end at other minima)";
    }
  }
  judgement.because =
      "fewest iterations to a gap of 1e-6 with windows 7, 8, 10, 15 and 20 against "
      "1 to 6, " +
      judgement.because;
  if (compared > 0) judgement.verdict = VerdictOf(useless, compared);
  return judgement;
}

std::vector<PlotPanel> AgainstWindow(const ExperimentTables& tables) {
  std::vector<PlotPanel> panels;
  const std::pair<const char*, const char*> drawn[] = {
      {"iterations_to_1e-6", "iterations to a gap of 1e-6"},
      {"seconds_to_1e-6", "seconds to a gap of 1e-6"},
      {"polished_energy", "E at the foot points, polished"},
      {"rejected", "share of rejected steps"}};
  for (const auto& [column, label] : drawn) {
    PlotPanel panel;
    panel.title = "Anderson acceleration of PDM";
    panel.x_label = "window";
    panel.y_label = label;
    panel.log_y = std::string(column) != "rejected";
    int color = 0;
    for (const std::string& example : ShownExampleNames()) {
      const CsvTable rows = tables.at("").Where("example", example);
      panel.series.push_back({ExampleLabel(example), rows.Numbers("window"), rows.Numbers(column),
                              PlotSeries::Style::kLinePoints, color++});
    }
    panels.push_back(std::move(panel));
  }
  return panels;
}

}  // namespace

Experiment AndersonPaperWindow() {
  Experiment experiment;
  experiment.name = "window";
  experiment.title = "The window";
  experiment.text =
      "Anderson acceleration of PDM with the last 1 to 8, 10, 15 and 20 steps combined, on the "
      "examples, from the circle. *crawling* is ours and not judged.";
  experiment.run = &RunWindows;
  experiment.shown = [](const ExperimentTables& tables) {
    return tables.at("").Select({"example", "window", "status", "iterations", "seconds",
                                 "polished_energy", "iterations_to_1e-3", "iterations_to_1e-6",
                                 "seconds_to_1e-6", "rejected"});
  };
  experiment.claims = {
      {"a window above 6 does not help", "its text",
       "over the examples where one of the windows 7, 8, 10, 15 and 20 ends in the basin of window "
       "6, and over the windows that end there: holds where on all the fewest iterations to a gap "
       "of 1e-6 with these are at least 0.9 of the fewest with 1 to 6, in part where on some, else "
       "does not hold",
       &JudgeWindow}};
  experiment.figures = {{"window_counts",
                         "Iterations and time to 1e-6 above each run's own minimum, that minimum, "
                         "and the share of rejected steps, against the window.",
                         2, &AgainstWindow}};
  return experiment;
}

}  // namespace batten
