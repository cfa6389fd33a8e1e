#include "experiments/anderson_paper.h"
#include "experiments/anderson_paper_growth.h"
#include "experiments/anderson_paper_runs.h"

namespace batten {
namespace {

constexpr const char* kCountColumn = "control_points";
constexpr int kFewest = 8;
constexpr int kMost = 88;
constexpr int kStep = 10;

bool RunControlPoints(const ExperimentRun& run, ExperimentTables* tables, std::string* error) {
  CsvTable& table = (*tables)[""] = CsvTable(GrowthColumns());
  std::vector<PaperExample> examples;
  if (!ShownExamples(&examples, error)) return false;
  constexpr std::size_t kNoisy = 2;
  const Points& points = examples[kNoisy].points;
  for (int n = kFewest; n <= kMost; n += kStep) {
    if (InterruptRequested()) return true;
    AddGrowthRows(*FreeFit(points, n, "circle"), run,
                  static_cast<double>(n - kFewest) / (kMost - kFewest + kStep), &table);
  }
  return true;
}

}  // namespace

Experiment AndersonPaperControlPoints() {
  Experiment experiment;
  experiment.name = "control_points";
  experiment.title = "Time per iteration against the number of control points";
  experiment.text =
      "The noisy example's 200 points with 8 to 88 control points. Time per iteration over the "
      "first 30, set-up left out.";
  experiment.run = &RunControlPoints;
  experiment.shown = [](const ExperimentTables& tables) {
    return GrowthShown(tables, kCountColumn);
  };
  experiment.claims = {
      {"the cost per iteration is linear in the control points", "its text",
       "holds where the time per iteration of both methods grows no faster than "
       "control_points^1.15, by a fit of the logarithms, in part where that of one, else does not "
       "hold",
       [](const ExperimentTables& tables) { return JudgeLinear(tables, kCountColumn); }},
      {"PDM, TDM and SDM slow down fast with the size: control points", "its text",
       "holds where their times per iteration all grow faster than control_points^1.5, in part "
       "where some do, else does not hold: their systems have a band",
       [](const ExperimentTables& tables) { return JudgeSlowsDown(tables, kCountColumn); }}};
  experiment.figures = {
      {"control_points_times", "Time per iteration against the number of control points.", 1,
       [](const ExperimentTables& tables) { return AgainstGrowth(tables, kCountColumn); }}};
  return experiment;
}

}  // namespace batten
