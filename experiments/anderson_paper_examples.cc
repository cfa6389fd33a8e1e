#include <algorithm>
#include <cmath>

#include "experiments/anderson_paper.h"
#include "experiments/anderson_paper_judges.h"
#include "experiments/anderson_paper_runs.h"
#include "experiments/experiment_runs.h"

namespace batten {
namespace {

/// Iterations of `best_of` are ends of runs, and the undamped method has none worth a time.
std::vector<std::string> Solvers() {
  std::vector<std::string> solvers = IteratingMethods();
  solvers.insert(solvers.end(), {"best_of:lbfgs", "best_of:foot_newton", kUndampedTdm});
  return solvers;
}
constexpr const char* kCurves[] = {kJointLbfgs, kAndersonPdm, "foot_newton"};
constexpr const char* kData = "data";

void AddCurve(const std::string& example, const std::string& solver, const Points& points,
              CsvTable* curves) {
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    curves->AddRow({example, solver, NumberText(points(i, 0)), NumberText(points(i, 1))});
  }
}

void AddSampledCurve(const FreeCase& on, const std::string& solver, const Eigen::VectorXd& x,
                     CsvTable* curves) {
  if (!x.allFinite() || x.size() == 0) return;
  AddCurve(on.example, solver, SampledCurve(*on.problem, x), curves);
}

bool RunExamples(const ExperimentRun& run, ExperimentTables* tables, std::string* error) {
  CsvTable& runs = (*tables)[""] = CsvTable(FreeRunColumns());
  CsvTable& traces = (*tables)["traces"] = CsvTable(FreeTraceColumns());
  CsvTable& curves = (*tables)["curves"] = CsvTable({"example", "solver", "x", "y"});
  std::vector<PaperExample> examples;
  if (!ShownExamples(&examples, error)) return false;
  const std::vector<std::string> solvers = Solvers();
  double done = 0.0;
  for (const PaperExample& example : examples) {
    const FreeCase on = {example.name, "circle",
                         FreeFit(example.points, example.control_points, "circle"), run.recorder};
    AddCurve(example.name, kData, example.points, &curves);
    for (const std::string& solver : solvers) {
      if (InterruptRequested()) return true;
      if (run.progress) {
        run.progress(done / static_cast<double>(solvers.size() * examples.size()),
                     example.name + " " + solver);
      }
      done += 1.0;
      const RunResult result = RunFree(on, solver, FreeRaceSpec(), run.repetitions, &runs, &traces);
      if (std::find(std::begin(kCurves), std::end(kCurves), solver) != std::end(kCurves)) {
        AddSampledCurve(on, solver, result.x, &curves);
      }
    }
  }
  return true;
}

/// Spikes far outside would leave nothing to be seen of the rest.
std::vector<double> InFrame(const CsvTable& rows, const char* column) {
  constexpr double kMargin = 0.3;
  std::vector<double> values = rows.Numbers(column);
  for (double& value : values) value = std::clamp(value, -kMargin, 1.0 + kMargin);
  return values;
}

std::vector<PlotPanel> Pictures(const ExperimentTables& tables) {
  std::vector<PlotPanel> panels;
  for (const std::string& example : ShownExampleNames()) {
    const CsvTable of = tables.at("curves").Where("example", example);
    PlotPanel panel;
    panel.title = ExampleLabel(example);
    panel.equal_scale = true;
    int color = 0;
    for (const char* solver : kCurves) {
      const CsvTable rows = of.Where("solver", solver);
      panel.series.push_back(
          {solver, InFrame(rows, "x"), InFrame(rows, "y"), PlotSeries::Style::kLine, color++});
    }
    const CsvTable data = of.Where("solver", kData);
    panel.series.push_back(
        {kData, data.Numbers("x"), data.Numbers("y"), PlotSeries::Style::kPoints, 6});
    panels.push_back(std::move(panel));
  }
  return panels;
}

std::vector<PlotPanel> Errors(const ExperimentTables& tables) {
  std::vector<PlotPanel> panels;
  for (const std::string& example : ShownExampleNames()) {
    const CsvTable of = tables.at("traces").Where("example", example);
    for (const char* against : {"iteration", "seconds"}) {
      PlotPanel panel;
      panel.title = ExampleLabel(example);
      panel.x_label = against;
      panel.y_label = "E at the foot points";
      panel.log_x = panel.log_y = true;
      int color = 0;
      for (const char* solver : kDrawnMethods) {
        const CsvTable rows = of.Where("solver", solver);
        panel.series.push_back({solver, rows.Numbers(against), rows.Numbers("foot_energy"),
                                PlotSeries::Style::kLine, color++});
      }
      panels.push_back(std::move(panel));
    }
  }
  return panels;
}

CsvTable Shown(const ExperimentTables& tables) {
  CsvTable shown({"example", "solver", "status", "iterations", "projections", "ms", "us/iteration",
                  "E at its t", "E at feet", "polished", "length", "free loops",
                  "iterations to 1e-6", "ms to 1e-6", "rejected"});
  const CsvTable& all = tables.at("");
  for (std::size_t row = 0; row < all.num_rows(); ++row) {
    const auto scaled = [&](const char* column, double factor) {
      return NumberText(factor * all.Number(row, column));
    };
    shown.AddRow(
        {ExampleLabel(all.Text(row, "example")), all.Text(row, "solver"), all.Text(row, "status"),
         all.Text(row, "iterations"), all.Text(row, "projections"), scaled("seconds", 1e3),
         scaled("seconds_per_iteration", 1e6), all.Text(row, "energy"),
         all.Text(row, "foot_energy"), all.Text(row, "polished_energy"), all.Text(row, "length"),
         all.Text(row, "free_loops"), all.Text(row, "iterations_to_1e-6"),
         scaled("seconds_to_1e-6", 1e3), all.Text(row, "rejected")});
  }
  return shown;
}

}  // namespace

Experiment AndersonPaperExamples() {
  Experiment experiment;
  experiment.name = "examples";
  experiment.title = "The examples";
  experiment.text =
      "From a circle around the data. *smooth*: the cat's outline after three moving means over "
      "181 "
      "of its 2000 points, every 20th: 100 points, 8 control points. *sharp*: the outline itself, "
      "90 points, 20 control points. *noisy*: the squirrel after means over 281 points, 200 "
      "points, each moved at random (seeded) in a square of side 0.06; 8 control points. "
      "*crawling* is no example of the paper: the rhinoceros after means over 181 points, as "
      "noisy, "
      "taken because PDM crawls on it: the paper's claims are judged on its three alone. Beside "
      "the "
      "paper's two methods all others of ours, and TDM without damping or halving "
      "(`tdm/damping=0/search=none`). *length* is the curve's, *free loops* how many loops it has "
      "that no point is nearest to: in *sharp* the least E belongs to such curves. *rejected* is "
      "the share of accelerated points that "
      "the safeguard throws away because E would have risen.";
  experiment.run = &RunExamples;
  experiment.shown = &Shown;
  experiment.claims = {
      {"Anderson acceleration converges faster than L-BFGS", "its text",
       "over the examples on which both end in one basin and at least one comes within 1e-6: holds "
       "where Anderson is there sooner in iterations and in time on all, does not hold where on "
       "none in either, else in part",
       &JudgeFaster},
      {"its error is smaller at every equal time", "its figures of error against time",
       "over the examples on which both end in one basin, at 200 times evenly spaced on a "
       "logarithmic scale from the first iteration of either to the end of the slower run: holds "
       "where at all Anderson's last E is at most 1 + 1e-6 times that of L-BFGS, in part where on "
       "one example at half of them or more, else does not hold",
       &JudgeEqualTimes},
      {"both start alike", "its figures of error against iterations",
       "holds where on all examples E after each of iterations 1 to 5 of one is within a "
       "factor of 2 of the other's, in part where on some",
       &JudgeAlike},
      {"no projection is needed in each step", "its text",
       "counts projections: holds where Anderson's run makes fewer than one per iteration on "
       "all examples, in part where on some, else does not hold",
       &JudgeProjections},
      {"undamped TDM diverges", "its text",
       "holds where on all examples E at the feet is higher at the end than at the start, or no "
       "number, in part where on some, else does not hold",
       &JudgeUndamped},
      {"accelerated steps are mostly taken", "our question",
       "holds where on all examples the safeguard rejects less than half of the accelerated "
       "points, in part where on some, else does not hold",
       &JudgeRejections}};
  experiment.figures = {
      {"examples_curves",
       "The data and three of the curves, which are cut off at a frame of 0.3 around the data: "
       "where one runs along it, it is outside.",
       2, &Pictures},
      {"examples_errors",
       "E at the foot points against iterations and against time, both on logarithmic axes; "
       "iteration 0 is left out on the left.",
       2, &Errors}};
  return experiment;
}

}  // namespace batten
