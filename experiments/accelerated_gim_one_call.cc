#include <glog/logging.h>

#include <algorithm>
#include <cmath>

#include "experiments/accelerated_gim.h"
#include "experiments/experiment_runs.h"
#include "experiments/short_number.h"

namespace batten {
namespace {

// Distance from the direct answer nearest to the start, over the data's size, that counts as equal.
constexpr double kEqual = 1e-6;
constexpr int kNumProblems = 4;

struct FitInOneCall {
  std::string name;
  std::shared_ptr<const Problem> problem;
};

/// The rhinoceros with points 10 and 11 on one parameter.
std::shared_ptr<const Problem> WithTwoOnOneParameter(const Problem& outline) {
  Eigen::VectorXd t = outline.curve_fit()->parameters();
  t[11] = t[10];
  return AtParameters(outline, t);
}

std::shared_ptr<const Problem> WithControlPoints(const Problem& outline, int n) {
  FitSpec spec = outline.curve_fit()->spec();
  spec.control_points = n;
  return CheckedFit(outline.curve_fit()->data(), spec);
}

bool RunFitsInOneCall(const ExperimentRun& run, ExperimentTables* tables, std::string* error) {
  CsvTable& runs = (*tables)[""] = CsvTable(RunColumnsBehind({"distance_to_direct"}));
  const auto through = CatalogueProblem("rhino_interpolation", error);
  const auto near = CatalogueProblem("rhino", error);
  if (through == nullptr || near == nullptr) return false;
  const std::vector<FitInOneCall> cases = {
      {"interpolation", through},
      {"approximation", near},
      {"too few points", WithControlPoints(*near, 150)},
      {"two on one parameter", WithTwoOnOneParameter(*through)}};
  double done = 0.0;
  for (const FitInOneCall& c : cases) {
    if (run.progress) run.progress(done / static_cast<double>(cases.size()), c.name);
    done += 1.0;
    ProblemRuns on(c.name, c.problem, run.repetitions, run.recorder);
    CsvTable unused(RunColumns());
    const RunResult direct = on.Run("banded_qr", RaceSpec(1e-10), &unused);
    for (const RunSpec& spec : {NativeSpec(1e-6), RaceSpec(1e-10)}) {
      for (const char* solver : {"lbfgs", "gim", "lspia", "cg", "banded_qr"}) {
        if (InterruptRequested()) return true;
        CsvTable rows(RunColumns());
        const RunResult result = on.Run(solver, spec, &rows);
        const double distance = result.skipped.empty()
                                    ? (result.x - direct.x).cwiseAbs().maxCoeff() /
                                          c.problem->curve_fit()->setting().size
                                    : std::nan("");
        AddRowsBehind({NumberText(distance)}, rows, &runs);
      }
    }
  }
  return true;
}

Judgement JudgeOneCall(const ExperimentTables& tables) {
  const CsvTable rows = tables.at("").Where("mode", "race").Where("solver", "lbfgs");
  Judgement judgement;
  int solved = 0, nearest = 0;
  double worst = 0.0;
  for (std::size_t row = 0; row < rows.num_rows(); ++row) {
    const std::string& status = rows.Text(row, "status");
    solved += status == "gradient_small" || status == "rounding_floor" ? 1 : 0;
    nearest += rows.Number(row, "distance_to_direct") <= kEqual ? 1 : 0;
    worst = std::max(worst, rows.Number(row, "distance_to_direct"));
  }
  const int all = static_cast<int>(rows.num_rows());
  if (all == 0) return judgement;
  judgement.because = "lbfgs reaches |g| <= 1e-10 |g(start)| on " + std::to_string(solved) +
                      " of " + std::to_string(all) +
                      " problems, and is at the direct answer nearest to the "
                      "start, to 1e-6 of the size, on " +
                      std::to_string(nearest) + " (the farthest is " + ShortNumber(worst, 2) +
                      " away)";
  judgement.verdict = solved < all         ? ClaimVerdict::kDoesNotHold
                      : all < kNumProblems ? ClaimVerdict::kUndecided
                      : nearest == all     ? ClaimVerdict::kHolds
                                           : ClaimVerdict::kInPart;
  return judgement;
}

std::vector<PlotPanel> IterationsByCase(const ExperimentTables& tables) {
  PlotPanel panel;
  panel.title = "Race";
  panel.x_names = tables.at("").Distinct("problem");
  panel.y_label = "iterations";
  panel.log_y = true;
  const CsvTable race = tables.at("").Where("mode", "race");
  int color = 0;
  for (const char* solver : {"gim", "lspia", "lbfgs", "cg"}) {
    const CsvTable rows = race.Where("solver", solver);
    std::vector<double> x;
    // Side by side: the problems have no order.
    for (std::size_t k = 0; k < rows.num_rows(); ++k) {
      x.push_back(static_cast<double>(k) + 0.85 + 0.1 * color);
    }
    panel.series.push_back(
        {solver, x, rows.Numbers("iterations"), PlotSeries::Style::kPoints, color++});
  }
  return {panel};
}

}  // namespace

Experiment AcceleratedGimOneCall() {
  Experiment experiment;
  experiment.name = "one_call";
  experiment.title = "Interpolation, approximation and too few points by one call";
  experiment.text =
      "The rhinoceros' 100 points with 100, 80 and 150 control points, and with 100 where two "
      "points "
      "share one parameter. Where the minimum is not unique the direct answer is the one nearest "
      "to "
      "the start.";
  experiment.run = &RunFitsInOneCall;
  experiment.shown = [](const ExperimentTables& tables) {
    CsvTable shown({"problem", "solver", "status", "iterations", "x cholesky", "E", "|g|",
                    "distance to direct"});
    const CsvTable race = tables.at("").Where("mode", "race");
    for (std::size_t row = 0; row < race.num_rows(); ++row) {
      shown.AddRow({race.Text(row, "problem"), race.Text(row, "solver"), race.Text(row, "status"),
                    race.Text(row, "iterations"), race.Text(row, "times_cholesky"),
                    race.Text(row, "energy"), race.Text(row, "gradient_norm"),
                    race.Text(row, "distance_to_direct")});
    }
    return shown;
  };
  experiment.claims = {
      {"Interpolation, approximation and too few points by one call; two points on one parameter",
       "introduction",
       "holds where lbfgs reaches |g| <= 1e-10 |g(start)| on all four problems and ends within "
       "1e-6 "
       "of the size from the direct answer nearest to the start, in part where only the first",
       &JudgeOneCall}};
  experiment.figures = {
      {"one_call_iterations",
       "Iterations on the four problems, race; gim takes only those with as many control points "
       "as points.",
       1, &IterationsByCase}};
  return experiment;
}

}  // namespace batten
