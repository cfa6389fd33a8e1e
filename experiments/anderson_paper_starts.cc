#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "experiments/anderson_paper.h"
#include "experiments/anderson_paper_judges.h"
#include "experiments/anderson_paper_runs.h"
#include "experiments/experiment_runs.h"
#include "solvers/lanczos.h"

namespace batten {
namespace {

constexpr const char* kStarts[] = {"circle", "ellipse", "disturbed circle"};
constexpr const char* kJudged[] = {kJointLbfgs, kAndersonPdm};
constexpr double kNotReached = std::numeric_limits<double>::infinity();

/// The circle with its control points moved at random in a square of side 0.2.
std::shared_ptr<const Problem> FromDisturbedCircle(const PaperExample& example) {
  constexpr double kHalfSide = 0.1;
  constexpr std::uint64_t kSeed = 20200603;
  const std::shared_ptr<const Problem> circle =
      FreeFit(example.points, example.control_points, kStarts[0]);
  Points start = circle->curve_fit()->ControlPoints(circle->start());
  const Eigen::VectorXd moves = RandomStart(start.size(), kSeed);
  start += kHalfSide * Eigen::Map<const Points>(moves.data(), start.rows(), start.cols());
  return FreeFitFrom(example.points, start);
}

bool RunStarts(const ExperimentRun& run, ExperimentTables* tables, std::string* error) {
  CsvTable& runs = (*tables)[""] = CsvTable(FreeRunColumns());
  CsvTable& traces = (*tables)["traces"] = CsvTable(FreeTraceColumns());
  std::vector<PaperExample> examples;
  if (!ShownExamples(&examples, error)) return false;
  double done = 0.0;
  const auto all =
      static_cast<double>(examples.size() * std::size(kStarts) * std::size(kDrawnMethods));
  for (const PaperExample& example : examples) {
    for (const std::string start : kStarts) {
      const FreeCase on = {example.name, start,
                           start == kStarts[2]
                               ? FromDisturbedCircle(example)
                               : FreeFit(example.points, example.control_points, start),
                           run.recorder};
      for (const char* solver : kDrawnMethods) {
        if (InterruptRequested()) return true;
        if (run.progress) run.progress(done / all, example.name + " " + start + " " + solver);
        done += 1.0;
        RunFree(on, solver, FreeRaceSpec(), run.repetitions, &runs, &traces);
      }
    }
  }
  return true;
}

/// Rows of one method on one example, one per start.
struct OverStarts {
  bool complete = true;
  bool one_basin = true;
  double fewest = 0.0, most = 0.0;  // iterations to the gap
};

OverStarts LookAt(const CsvTable& rows) {
  OverStarts over;
  over.fewest = kNotReached;
  const double first = OnlyNumber(rows.Where("start", kStarts[0]), "polished_energy");
  for (const char* start : kStarts) {
    const CsvTable row = rows.Where("start", start);
    const double polished = OnlyNumber(row, "polished_energy");
    over.complete = over.complete && !std::isnan(polished);
    over.one_basin = over.one_basin && InOneBasin(polished, first);
    const double reached = OnlyNumber(row, "iterations_to_1e-6");
    const double count = std::isnan(reached) ? kNotReached : reached;
    over.fewest = std::min(over.fewest, count);
    over.most = std::max(over.most, count);
  }
  return over;
}

Judgement JudgeStarts(const ExperimentTables& tables) {
  constexpr double kFactor = 2.0;
  Judgement judgement;
  int judged = 0, alike = 0;
  for (const std::string& example : ShownExampleNames()) {
    const bool counts = IsPaperExample(example);
    for (const char* solver : kJudged) {
      const OverStarts over =
          LookAt(tables.at("").Where("example", example).Where("solver", solver));
      if (!over.complete && counts) return Judgement();
      if (!over.complete) continue;
      judged += counts ? 1 : 0;
      const bool is_alike =
          over.one_basin && over.most <= kFactor * over.fewest && std::isfinite(over.most);
      alike += counts && is_alike ? 1 : 0;
      judgement.because += (judgement.because.empty() ? "" : "; ") + ExampleLabel(example) +
                           (counts ? " " : ", not counted, ") + solver + ": " +
                           (over.one_basin ? "one minimum" : "different minima") + ", ";
      judgement.because += std::isfinite(over.most) ? NumberText(over.fewest) + " to " +
                                                          NumberText(over.most) + " iterations"
                                                    : "not all runs come to a gap of 1e-6";
    }
  }
  judgement.verdict = VerdictOf(alike, judged);
  return judgement;
}

std::vector<PlotPanel> ErrorsFromStarts(const ExperimentTables& tables) {
  std::vector<PlotPanel> panels;
  for (const std::string& example : ShownExampleNames()) {
    PlotPanel panel;
    panel.title = ExampleLabel(example);
    panel.x_label = "iteration";
    panel.y_label = "E at the foot points";
    panel.log_x = panel.log_y = true;
    int color = 0;
    for (const char* solver : kJudged) {
      for (const char* start : kStarts) {
        const CsvTable rows = tables.at("traces")
                                  .Where("example", example)
                                  .Where("solver", solver)
                                  .Where("start", start);
        panel.series.push_back({std::string(solver) + " " + start, rows.Numbers("iteration"),
                                rows.Numbers("foot_energy"), PlotSeries::Style::kLine, color++});
      }
    }
    panels.push_back(std::move(panel));
  }
  return panels;
}

}  // namespace

Experiment AndersonPaperStarts() {
  Experiment experiment;
  experiment.name = "starts";
  experiment.title = "Three starting curves";
  experiment.text =
      "The examples from a circle, from an ellipse with the data's principal axes, and from "
      "the circle with its control points moved at random (seeded) in a square of side 0.2. "
      "*crawling* is ours and not judged.";
  experiment.run = &RunStarts;
  experiment.shown = [](const ExperimentTables& tables) {
    return tables.at("").Select({"example", "start", "solver", "status", "iterations", "seconds",
                                 "start_energy", "foot_energy", "polished_energy",
                                 "iterations_to_1e-6", "seconds_to_1e-6"});
  };
  experiment.claims = {
      {"the starting curve matters little", "its experiment with three of them",
       "per example and method: the polished E from all three starts agree to 1e-3, all runs come "
       "to a gap of 1e-6, and the counts of iterations to it lie within a factor of 2. Holds where "
       "all are so, in part where some are, else does not hold",
       &JudgeStarts}};
  experiment.figures = {{"starts_errors",
                         "E at the foot points against iterations from the three starts; iteration "
                         "0 is left out.",
                         2, &ErrorsFromStarts}};
  return experiment;
}

}  // namespace batten
