#include <glog/logging.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "experiments/accelerated_gim.h"
#include "experiments/experiment_runs.h"

namespace batten {
namespace {

constexpr const char* kOutlines[] = {"rhino", "squirrel", "dolphin", "cat"};
constexpr const char* kLawson = "lawson";
constexpr int kLawsonIterations = 300;

struct Residuals {
  Eigen::VectorXd lengths;  // |Q_i - C(t_i)|
  double largest() const { return lengths.maxCoeff(); }
  double rms() const {
    return std::sqrt(lengths.squaredNorm() / static_cast<double>(lengths.size()));
  }
};

Residuals Measure(const Problem& problem, const Eigen::VectorXd& x) {
  const CurveFit& fit = *problem.curve_fit();
  return {(fit.Curve(x).Sample(fit.parameters()) - fit.data().points).rowwise().norm()};
}

/// A curve with a small largest residual by Lawson's algorithm (1961): least squares again and
/// again, each weight multiplied by its residual. The best of its iterates.
Residuals Lawson(const Problem& problem) {
  const CurveFit& fit = *problem.curve_fit();
  const Eigen::Index m = fit.parameters().size();
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(m);
  Residuals best = {Eigen::VectorXd::Constant(m, std::numeric_limits<double>::infinity())};
  for (int k = 0; k < kLawsonIterations && !InterruptRequested(); ++k) {
    DataSet data = fit.data();
    data.weights = weights;
    const std::shared_ptr<const Problem> weighted = CheckedFit(std::move(data), fit.spec());
    std::string error;
    RunResult run;
    NameSpec solver;
    solver.name = "banded_qr";
    RunSpec spec;
    spec.keep_trace = false;
    CHECK(Run(*weighted, solver, spec, &run, &error)) << error;
    const Residuals now = Measure(*weighted, run.x);
    if (now.largest() < best.largest()) best = now;
    // What has met its point keeps a little weight, lest rows are lost.
    constexpr double kLeastWeight = 1e-8;
    weights = weights.cwiseProduct(now.lengths / now.largest()).cwiseMax(kLeastWeight);
    weights /= weights.maxCoeff();
  }
  return best;
}

void AddProfile(const std::string& problem, const std::string& method, const Residuals& residuals,
                CsvTable* profiles) {
  for (Eigen::Index i = 0; i < residuals.lengths.size(); ++i) {
    profiles->AddRow({problem, method, std::to_string(i), NumberText(residuals.lengths[i])});
  }
}

bool RunResiduals(const ExperimentRun& run, ExperimentTables* tables, std::string* error) {
  CsvTable& ends = (*tables)[""] = CsvTable(RunColumnsBehind({"largest", "rms"}));
  CsvTable& traces = (*tables)["traces"] =
      CsvTable({"problem", "solver", "iteration", "largest", "rms"});
  CsvTable& profiles = (*tables)["profiles"] = CsvTable({"problem", "method", "point", "residual"});
  double done = 0.0;
  for (const char* name : {"rhino_interpolation", "rhino", "squirrel", "dolphin", "cat"}) {
    if (run.progress) run.progress(done / 5.0, name);
    done += 1.0;
    const std::shared_ptr<const Problem> problem = CatalogueProblem(name, error);
    if (problem == nullptr) return false;
    ProblemRuns on(name, problem, run.repetitions, run.recorder);
    for (RunSpec spec : {NativeSpec(1e-6), RaceSpec(1e-10)}) {
      spec.keep_iterates = true;
      for (const char* solver : {"gim", "lspia", "lbfgs", "banded_qr"}) {
        if (InterruptRequested()) return true;
        CsvTable rows(RunColumns());
        const RunResult result = on.Run(solver, spec, &rows);
        if (!result.skipped.empty()) continue;
        const Residuals end = Measure(*problem, result.x);
        AddRowsBehind({NumberText(end.largest()), NumberText(end.rms())}, rows, &ends);
        if (spec.mode == Mode::kNative) continue;
        for (const Iterate& iterate : result.iterates) {
          const Residuals at = Measure(*problem, iterate.x);
          traces.AddRow({name, solver, std::to_string(iterate.iteration), NumberText(at.largest()),
                         NumberText(at.rms())});
        }
        if (std::string(solver) == "banded_qr") AddProfile(name, "least squares", end, &profiles);
      }
    }
    if (std::string(name) == "rhino_interpolation") continue;
    const auto begin = std::chrono::steady_clock::now();
    const Residuals least = Lawson(*problem);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    ends.AddRow(std::vector<std::string>(ends.columns().size()));
    for (const auto& [column, text] :
         {std::pair<std::string, std::string>("largest", NumberText(least.largest())),
          {"rms", NumberText(least.rms())},
          {"problem", name},
          {"solver", kLawson},
          {"iterations", std::to_string(kLawsonIterations)},
          {"seconds", NumberText(seconds.count())},
          {"times_cholesky", NumberText(seconds.count() / on.cholesky_seconds())}}) {
      ends.Set(ends.num_rows() - 1, column, text);
    }
    AddProfile(name, kLawson, least, &profiles);
  }
  return true;
}

/// The largest residual of `solver` at its end on `problem`; NaN if there is none.
double Largest(const ExperimentTables& tables, const std::string& problem,
               const std::string& solver) {
  const CsvTable rows = tables.at("").Where("problem", problem).Where("solver", solver);
  return rows.num_rows() == 0 ? std::nan("") : rows.Number(rows.num_rows() - 1, "largest");
}

Judgement JudgeLargest(const ExperimentTables& tables) {
  Judgement judgement;
  int least = 0;
  int judged = 0;
  for (const char* outline : kOutlines) {
    const double reached = Largest(tables, outline, "lspia");
    const double found = Largest(tables, outline, kLawson);
    if (std::isnan(reached) || std::isnan(found)) continue;
    ++judged;
    least += reached <= 1.01 * found ? 1 : 0;
    judgement.because +=
        (judgement.because.empty() ? "the largest residual that lspia ends at is " : ", ") +
        Rounded(reached / found, 2) + " (" + outline + ")";
  }
  if (judged == 0) return judgement;
  judgement.because +=
      " times that of a curve of the same knots found by Lawson's algorithm, and is that of the "
      "least-squares curve; through all points both are zero";
  if (least > 0 && least < judged) {
    judgement.verdict = ClaimVerdict::kInPart;
  } else if (judged == static_cast<int>(std::size(kOutlines))) {
    judgement.verdict = least == judged ? ClaimVerdict::kHolds : ClaimVerdict::kDoesNotHold;
  }
  return judgement;
}

std::vector<PlotPanel> Panels(const ExperimentTables& tables) {
  PlotPanel falls;
  falls.title = "rhino: largest residual";
  falls.x_label = "iteration";
  falls.y_label = "max |Q_i - C(t_i)|";
  const CsvTable traces = tables.at("traces").Where("problem", "rhino");
  int color = 0;
  for (const char* solver : {"lspia", "lbfgs"}) {
    const CsvTable rows = traces.Where("solver", solver);
    falls.series.push_back({solver, rows.Numbers("iteration"), rows.Numbers("largest"),
                            PlotSeries::Style::kLine, color++});
  }
  const double least = Largest(tables, "rhino", kLawson);
  falls.series.push_back({"lawson", {0.0, 350.0}, {least, least}, PlotSeries::Style::kDashed, 2});
  PlotPanel profile;
  profile.title = "rhino: residuals along the outline";
  profile.x_label = "point";
  profile.y_label = "|Q_i - C(t_i)|";
  const CsvTable profiles = tables.at("profiles").Where("problem", "rhino");
  color = 0;
  for (const std::string& method : profiles.Distinct("method")) {
    const CsvTable rows = profiles.Where("method", method);
    profile.series.push_back(
        {method, rows.Numbers("point"), rows.Numbers("residual"), PlotSeries::Style::kLine, color});
    color += 2;
  }
  return {falls, profile};
}

}  // namespace

Experiment AcceleratedGimLargestResidual() {
  Experiment experiment;
  experiment.name = "largest_residual";
  experiment.title = "The largest residual";
  experiment.text =
      "Largest and root-mean-square residual at the parameters: GIM on the rhinoceros through all "
      "its points, LSPIA and L-BFGS on the four outlines with fewer control points, beside a curve "
      "with the same knots and parameters whose largest residual Lawson's algorithm (1961) makes "
      "small: least squares 300 times, each weight multiplied by its residual.";
  experiment.run = &RunResiduals;
  experiment.shown = [](const ExperimentTables& tables) {
    CsvTable shown({"problem", "mode", "solver", "iterations", "x cholesky", "largest", "rms"});
    const CsvTable& all = tables.at("");
    for (std::size_t row = 0; row < all.num_rows(); ++row) {
      if (all.Text(row, "mode") == "native") continue;
      shown.AddRow({all.Text(row, "problem"), all.Text(row, "mode"), all.Text(row, "solver"),
                    all.Text(row, "iterations"), all.Text(row, "times_cholesky"),
                    all.Text(row, "largest"), all.Text(row, "rms")});
    }
    return shown;
  };
  experiment.claims = {{"GIM minimises the largest residual", "section on the energy",
                        "holds where on all four outlines the largest residual that lspia ends at "
                        "is at most 1 % above "
                        "the least one found, in part where on some",
                        &JudgeLargest}};
  experiment.figures = {
      {"largest_residual_rhino",
       "Left: the largest residual against the iteration; right: residuals of the "
       "least-squares curve and of Lawson's.",
       2, &Panels}};
  return experiment;
}

}  // namespace batten
