#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "experiments/accelerated_gim.h"
#include "experiments/experiment_runs.h"
#include "solvers/lanczos.h"

namespace batten {
namespace {

constexpr const char* kEarly = "early stopping";
constexpr const char* kWarm = "warm start";
constexpr const char* kTied = "control points tied";
constexpr const char* kBounds = "bounds";
constexpr const char* kCholesky = "banded_cholesky";

/// Adds one row behind the reason and what was varied.
RunResult AddRun(const std::string& reason, const std::string& setting, const std::string& solver,
                 const RunSpec& spec, ProblemRuns* on, CsvTable* table) {
  CsvTable rows(RunColumns());
  RunResult result = on->Run(solver, spec, &rows);
  AddRowsBehind({reason, setting}, rows, table);
  return result;
}

/// Iterations until the gap is reached, then the time of a run of so many.
void RunEarly(const ExperimentRun& run, CsvTable* table) {
  ProblemRuns on("loop", LoopProblem(1'000'000, 10'000, kLoopSize), run.repetitions, run.recorder);
  AddRun(kEarly, "exact", kCholesky, RaceSpec(1e-10), &on, table);
  for (const char* solver : {"cg", "lbfgs", "lspia"}) {
    CsvTable unused(RunColumns());
    CsvTable traces(TraceColumns());
    on.Run(solver, RaceSpec(1e-8), &unused, &traces);
    const std::vector<double> gaps = traces.Numbers("gap");
    for (const double gap : {1e-1, 1e-2, 1e-4}) {
      if (InterruptRequested()) return;
      const auto found =
          std::find_if(gaps.begin(), gaps.end(), [gap](double value) { return value <= gap; });
      if (found == gaps.end()) continue;
      RunSpec spec = RaceSpec(0.0);
      spec.max_iterations = static_cast<int>(found - gaps.begin());
      spec.keep_trace = false;
      AddRun(kEarly, "gap " + NumberText(gap), solver, spec, &on, table);
    }
  }
}

/// The answer of one data set as the start for another, every point of which has moved by up to
/// `moved` sizes.
void RunWarm(const ExperimentRun& run, CsvTable* table) {
  const std::shared_ptr<const Problem> before = LoopProblem(1'000'000, 10'000, kLoopSize);
  const CurveFit& fit = *before->curve_fit();
  RunResult last;
  NameSpec direct;
  direct.name = kCholesky;
  std::string error;
  CHECK(Run(*before, direct, RaceSpec(1e-10), &last, &error)) << error;
  const Points answer = fit.ControlPoints(last.x);
  for (const double moved : {1e-2, 1e-4, 1e-6}) {
    if (InterruptRequested()) return;
    DataSet data = fit.data();
    const Eigen::VectorXd noise = RandomStart(data.points.size(), 7);
    data.points +=
        moved * kLoopSize * Eigen::Map<const Points>(noise.data(), data.points.rows(), 2);
    const std::shared_ptr<const Problem> now = CheckedFit(std::move(data), fit.spec());
    ProblemRuns on("loop", now, run.repetitions, run.recorder);
    const std::string setting = "moved by " + NumberText(moved);
    AddRun(kWarm, setting + " (direct)", kCholesky, RaceSpec(1e-10), &on, table);
    // One |g| for both: 1e-6 of that at the cold start.
    RunSpec spec = NativeSpec(1e-6);
    RunResult cold = AddRun(kWarm, setting + " (own rule)", "cg", spec, &on, table);
    spec.native_gradient = 1e-6 * cold.start_gradient_norm;
    AddRun(kWarm, setting + " (cold)", "cg", spec, &on, table);
    spec.start = now->curve_fit()->Variables(answer);
    AddRun(kWarm, setting + " (warm)", "cg", spec, &on, table);
  }
}

/// P_0 = P_(n/2): a curve that meets itself. After elimination a row can reach half way around.
std::shared_ptr<const Problem> Tied(int n) {
  const std::shared_ptr<const Problem> loop = LoopProblem(4 * n, n, kLoopSize);
  std::string error;
  std::unique_ptr<Problem> tied =
      MakeFitProblem(loop->curve_fit()->data(), loop->curve_fit()->spec(), &error);
  CHECK(tied != nullptr) << error;
  std::vector<LinearConstraint> constraints;
  for (int c = 0; c < 2; ++c) {
    LinearConstraint constraint;
    constraint.name = "P_0 = P_" + std::to_string(n / 2);
    constraint.coefficients = {{c, 1.0}, {n / 2 * 2 + c, -1.0}};
    constraints.push_back(constraint);
  }
  CHECK(tied->SetLinearConstraints(constraints, &error)) << error;
  return tied;
}

void RunTied(const ExperimentRun& run, CsvTable* table) {
  for (const int n : {100, 400, 1600}) {
    ProblemRuns on("tied_loop", Tied(n), n > 1000 ? 1 : run.repetitions, run.recorder);
    const std::string setting = "n = " + std::to_string(n);
    for (const char* solver : {kCholesky, "cg", "lbfgs"}) {
      if (InterruptRequested()) return;
      AddRun(kTied, setting, solver, RaceSpec(1e-8), &on, table);
    }
    RunSpec through_functors = RaceSpec(1e-8);
    through_functors.compile = false;
    AddRun(kTied, setting + " (not compiled)", "lbfgs", through_functors, &on, table);
  }
}

/// No control point above the fraction `at` of the height that the direct answer has.
std::shared_ptr<const Problem> BelowALine(const Problem& loop, const Eigen::VectorXd& answer,
                                          double at, int* held) {
  std::string error;
  std::unique_ptr<Problem> bounded =
      MakeFitProblem(loop.curve_fit()->data(), loop.curve_fit()->spec(), &error);
  CHECK(bounded != nullptr) << error;
  const Eigen::Map<const Points> points(answer.data(), answer.size() / 2, 2);
  const double low = points.col(1).minCoeff();
  const double line = low + at * (points.col(1).maxCoeff() - low);
  Eigen::VectorXd lower =
      Eigen::VectorXd::Constant(answer.size(), -std::numeric_limits<double>::infinity());
  Eigen::VectorXd upper = -lower;
  for (Eigen::Index j = 1; j < answer.size(); j += 2) upper[j] = line;
  *held = static_cast<int>((points.col(1).array() > line).count());
  bounded->SetBounds(lower, upper);
  return bounded;
}

/// Direct solvers refuse bounds: the multiple is of banded_cholesky's time without them.
void RunBounds(const ExperimentRun& run, CsvTable* table) {
  for (const int n : {100, 400, 1600}) {
    if (InterruptRequested()) return;
    const std::shared_ptr<const Problem> loop = LoopProblem(4 * n, n, kLoopSize);
    ProblemRuns without("loop", loop, run.repetitions, run.recorder);
    const RunResult direct = AddRun(kBounds, "n = " + std::to_string(n) + " (without)", kCholesky,
                                    RaceSpec(1e-8), &without, table);
    int held = 0;
    ProblemRuns on("bounded_loop", BelowALine(*loop, direct.x, 0.8, &held), run.repetitions,
                   run.recorder);
    const std::string setting =
        "n = " + std::to_string(n) + " (" + std::to_string(held) + " above)";
    for (const char* solver : {kCholesky, "lbfgs", "ceres_lm"}) {
      CsvTable rows(RunColumns());
      on.Run(solver, RaceSpec(1e-8), &rows);
      const double times = rows.Number(0, "seconds") / without.cholesky_seconds();
      rows.Set(0, "times_cholesky", NumberText(times));
      AddRowsBehind({kBounds, setting}, rows, table);
    }
  }
}

bool RunAll(const ExperimentRun& run, ExperimentTables* tables, std::string* /*error*/) {
  CsvTable& runs = (*tables)[""] = CsvTable(RunColumnsBehind({"reason", "setting"}));
  const auto tell = [&run](double fraction, const char* reason) {
    if (run.progress) run.progress(fraction, reason);
  };
  tell(0.0, kEarly);
  RunEarly(run, &runs);
  tell(0.3, kWarm);
  RunWarm(run, &runs);
  tell(0.7, kTied);
  RunTied(run, &runs);
  tell(0.9, kBounds);
  RunBounds(run, &runs);
  return true;
}

// Times scatter by a few percent.
constexpr double kFaster = 0.95;

/// Least multiple of banded_cholesky's time among the rows of `reason` whose setting ends so.
Judgement JudgeReason(const ExperimentTables& tables, const std::string& reason,
                      const std::string& ending) {
  const CsvTable rows = tables.at("").Where("reason", reason);
  Judgement judgement;
  double best = std::numeric_limits<double>::infinity();
  double worst = 0.0;
  for (std::size_t row = 0; row < rows.num_rows(); ++row) {
    const std::string& setting = rows.Text(row, "setting");
    if (rows.Text(row, "solver") == kCholesky) continue;
    if (setting.size() < ending.size() ||
        setting.compare(setting.size() - ending.size(), ending.size(), ending) != 0) {
      continue;
    }
    const double times = rows.Number(row, "times_cholesky");
    if (std::isnan(times)) continue;
    worst = std::max(worst, times);
    if (times >= best) continue;
    best = times;
    judgement.because = rows.Text(row, "solver") + ", " + setting + ": " + Rounded(times, 2) +
                        " times banded_cholesky's time";
  }
  if (worst == 0.0) return judgement;
  judgement.because += "; the slowest of this kind takes " + Rounded(worst, 2) + " times";
  judgement.verdict = worst < kFaster  ? ClaimVerdict::kHolds
                      : best < kFaster ? ClaimVerdict::kInPart
                                       : ClaimVerdict::kDoesNotHold;
  return judgement;
}

/// Which methods take bounds, and what that costs.
Judgement JudgeBounds(const ExperimentTables& tables) {
  const CsvTable rows = tables.at("").Where("reason", kBounds).Where("problem", "bounded_loop");
  Judgement judgement;
  int refused = 0, direct = 0, solved = 0, iterating = 0;
  double most = 0.0;
  for (std::size_t row = 0; row < rows.num_rows(); ++row) {
    const bool skipped = rows.Text(row, "status") == "skipped";
    if (rows.Text(row, "solver") == kCholesky) {
      ++direct;
      refused += skipped ? 1 : 0;
    } else if (rows.Text(row, "solver") == "ceres_lm") {
      ++iterating;
      const std::string& status = rows.Text(row, "status");
      solved += status == "gradient_small" || status == "rounding_floor" || status == "native_stop";
      if (!skipped) most = std::max(most, rows.Number(row, "times_cholesky"));
    }
  }
  if (direct == 0 || iterating == 0) return judgement;
  judgement.because = "banded_cholesky refuses " + std::to_string(refused) + " of " +
                      std::to_string(direct) + " problems with bounds, ceres_lm takes " +
                      std::to_string(solved) + " of " + std::to_string(iterating) + ", in up to " +
                      Rounded(most, 0) +
                      " times the direct time without bounds (a factorization per iteration)";
  judgement.verdict = refused == direct && solved == iterating ? ClaimVerdict::kHolds
                      : refused > 0 && solved > 0              ? ClaimVerdict::kInPart
                                                               : ClaimVerdict::kDoesNotHold;
  return judgement;
}

SourceClaim Question(const std::string& quote, const std::string& reason,
                     const std::string& ending) {
  return {quote, "our question",
          "time over that of banded_cholesky on the same problem, set-up included: holds where it "
          "is below 0.95 (times scatter) for every such run, in part where for one",
          [reason, ending](const ExperimentTables& tables) {
            return JudgeReason(tables, reason, ending);
          }};
}

std::vector<PlotPanel> TimesByReason(const ExperimentTables& tables) {
  std::vector<PlotPanel> panels;
  for (const char* reason : {kEarly, kWarm, kTied, kBounds}) {
    const CsvTable rows = tables.at("").Where("reason", reason);
    PlotPanel panel;
    panel.title = reason;
    panel.x_label = "run, in the order of the table";
    panel.y_label = "times banded_cholesky";
    panel.log_y = true;
    int color = 0;
    for (const std::string& solver : rows.Distinct("solver")) {
      PlotSeries series = {solver, {}, {}, PlotSeries::Style::kPoints, color++};
      for (std::size_t row = 0; row < rows.num_rows(); ++row) {
        if (rows.Text(row, "solver") != solver) continue;
        series.x.push_back(static_cast<double>(row) + 1.0);
        series.y.push_back(rows.Number(row, "times_cholesky"));
      }
      panel.series.push_back(std::move(series));
    }
    panel.series.push_back({"",
                            {1.0, static_cast<double>(rows.num_rows())},
                            {1.0, 1.0},
                            PlotSeries::Style::kDashed,
                            7});
    panels.push_back(std::move(panel));
  }
  return panels;
}

}  // namespace

Experiment AcceleratedGimWhenToIterate() {
  Experiment experiment;
  experiment.name = "when_to_iterate";
  experiment.title = "When iterating pays at all";
  experiment.text =
      "A fit with fixed parameters is a banded linear system, and `banded_cholesky` solves it in "
      "one "
      "pass over the data and one over the band. An iteration can only pay where one of these does "
      "not hold. *Stopped early*: 1e6 points, 1e4 control points, to gaps of 0.1, 0.01 and 1e-4. "
      "*Warm*: the answer of the same data before each point moved by up to 1e-2, 1e-4, 1e-6 of "
      "the size, to 1e-6 of |g| at the cold start. *Structure that a band does not have*: P_0 = "
      "P_(n/2); after elimination our band is half as wide as the curve has control points (a "
      "bordered solve, which Batten does not have, would stay direct and cheap). *Bounds*: no "
      "control point above a line that cuts the direct answer's at four fifths of its height; "
      "`ceres_lm` takes bounds, the direct solvers and L-BFGS do not. In short: on a fit with "
      "fixed "
      "parameters iterate where a rough answer will do, where there are bounds, or where "
      "constraints fill the band; a warm start pays little at best, because summing the band up "
      "costs "
      "more than solving it. With losses or free parameters E is no quadratic, and iterating is "
      "the "
      "only way.";
  experiment.run = &RunAll;
  experiment.shown = [](const ExperimentTables& tables) {
    CsvTable shown(
        {"reason", "setting", "solver", "iterations", "seconds", "times cholesky", "gap"});
    const CsvTable& all = tables.at("");
    for (std::size_t row = 0; row < all.num_rows(); ++row) {
      shown.AddRow({all.Text(row, "reason"), all.Text(row, "setting"), all.Text(row, "solver"),
                    all.Text(row, "iterations"), all.Text(row, "seconds"),
                    all.Text(row, "times_cholesky"), all.Text(row, "gap")});
    }
    return shown;
  };
  experiment.claims = {
      Question("iterating pays where it is stopped early", kEarly, ""),
      Question("iterating pays from a warm start", kWarm, " (warm)"),
      Question("iterating pays where control points far apart are tied", kTied, ""),
      {"with bounds iterating is the only way", "our question",
       "holds where banded_cholesky refuses every problem with bounds and ceres_lm takes it, in "
       "part where some",
       &JudgeBounds}};
  experiment.figures = {{"when_to_iterate_times",
                         "Time over that of banded_cholesky on the same problem; below the dashed "
                         "line iterating pays.",
                         2, &TimesByReason}};
  return experiment;
}

}  // namespace batten
