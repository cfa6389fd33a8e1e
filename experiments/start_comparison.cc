#include "experiments/start_comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>

#include "experiments/comparison.h"
#include "experiments/fit_report.h"
#include "problems/fit_problem.h"
#include "splines/closest_point.h"

namespace batten {
namespace {

struct OneRun {
  std::size_t solver = 0;
  int start = 0;
  RunResult run;
};

/// The problem's data and spec, to be made a problem again.
void TakeApart(const Problem& problem, DataSet* data, FitSpec* spec) {
  const CurveFit& fit = *problem.curve_fit();
  *data = fit.data();
  *spec = fit.spec();
  if (!spec->parameters.has_value()) data->parameters = fit.parameters();
}

int CountBasins(const std::vector<int>& basins) {
  return basins.empty() ? 0 : *std::max_element(basins.begin(), basins.end()) + 1;
}

/// Which end stands for `basin`: all ends in it are one curve.
std::size_t FirstEnd(const std::vector<int>& basins, int basin) {
  return static_cast<std::size_t>(std::find(basins.begin(), basins.end(), basin) - basins.begin());
}

/// What each basin's curve is like. There are no circles on the line, where a curve has no shape.
std::vector<CurveShape> BasinShapes(const CurveFit& fit, const std::vector<BasinEnd>& ends,
                                    const std::vector<int>& basins) {
  std::vector<CurveShape> shapes;
  for (int basin = 0; basin < CountBasins(basins); ++basin) {
    const BsplineCurve curve(fit.basis(), ends[FirstEnd(basins, basin)].control_points);
    Eigen::VectorXd feet =
        Eigen::VectorXd::Constant(fit.data().points.rows(), curve.basis().domain_begin());
    ClosestPoint(curve).FindAll(fit.data().points, 1, &feet, nullptr);
    shapes.push_back(ShapeBesideData(fit, curve, feet).value());
  }
  return shapes;
}

/// What the curves that a solver's runs end in are like, as cells.
std::vector<std::string> EndCells(const std::vector<int>& basins_of_ends,
                                  const std::vector<CurveShape>& shapes) {
  std::vector<double> lengths;
  int with_loops = 0;
  for (const int basin : basins_of_ends) {
    const CurveShape& shape = shapes[static_cast<std::size_t>(basin)];
    lengths.push_back(shape.length);
    with_loops += shape.num_free_loops > 0 ? 1 : 0;
  }
  const double share =
      lengths.empty() ? std::nan("") : with_loops / static_cast<double>(lengths.size());
  return {NumberCell(Median(lengths)), NumberCell(share)};
}

CsvTable SolverTable(const std::string& problem, const StartComparisonSpec& spec,
                     const std::vector<OneRun>& runs, const std::vector<BasinEnd>& ends,
                     const std::vector<int>& basins, const std::vector<CurveShape>& shapes) {
  CsvTable table({"problem", "solver", "runs", "reached", "best_found", "basins", "median_energy",
                  "best_energy", "median_length", "loop_share", "median_iterations",
                  "median_seconds"});
  for (std::size_t s = 0; s < spec.solvers.size(); ++s) {
    int reached = 0;
    std::vector<int> ended_in;
    std::vector<double> energies, iterations, seconds;
    for (std::size_t k = 0; k < runs.size(); ++k) {
      if (runs[k].solver != s) continue;
      reached += IsSuccess(runs[k].run.outcome.reason) ? 1 : 0;
      ended_in.push_back(basins[k]);
      energies.push_back(ends[k].energy_at_foot_points);
      iterations.push_back(runs[k].run.iterations);
      seconds.push_back(runs[k].run.seconds);
    }
    const auto best = std::count(ended_in.begin(), ended_in.end(), 0);
    const std::set<int> different(ended_in.begin(), ended_in.end());
    const double least =
        energies.empty() ? std::nan("") : *std::min_element(energies.begin(), energies.end());
    std::vector<std::string> row = {problem,
                                    spec.solvers[s].ToString(),
                                    std::to_string(ended_in.size()),
                                    std::to_string(reached),
                                    std::to_string(best),
                                    std::to_string(different.size()),
                                    NumberCell(Median(energies)),
                                    NumberCell(least)};
    for (std::string& cell : EndCells(ended_in, shapes)) row.push_back(std::move(cell));
    row.push_back(NumberCell(Median(iterations)));
    row.push_back(NumberCell(Median(seconds)));
    table.AddRow(row);
  }
  return table;
}

/// A basin's shape as cells.
std::vector<std::string> ShapeCells(const CurveShape& shape) {
  return {NumberCell(shape.length), NumberCell(shape.turning), std::to_string(shape.num_free_loops),
          NumberCell(shape.max_distance_to_data)};
}

CsvTable BasinTable(const std::string& problem, const StartComparisonSpec& spec,
                    const std::vector<OneRun>& runs, const std::vector<BasinEnd>& ends,
                    const std::vector<int>& basins, const std::vector<CurveShape>& shapes) {
  std::vector<std::string> columns = {
      "problem", "basin",   "energy",         "energy_at_foot_points",
      "length",  "turning", "num_free_loops", "max_distance_to_data"};
  for (const NameSpec& solver : spec.solvers) {
    columns.push_back(solver.ToString());
    columns.push_back(solver.ToString() + " seconds");
  }
  CsvTable table(columns);
  for (int basin = 0; basin < CountBasins(basins); ++basin) {
    const BasinEnd& first = ends[FirstEnd(basins, basin)];
    std::vector<std::string> row = {problem, std::to_string(basin + 1), NumberCell(first.energy),
                                    NumberCell(first.energy_at_foot_points)};
    for (std::string& cell : ShapeCells(shapes[static_cast<std::size_t>(basin)])) {
      row.push_back(std::move(cell));
    }
    for (std::size_t s = 0; s < spec.solvers.size(); ++s) {
      std::vector<double> seconds;
      for (std::size_t k = 0; k < runs.size(); ++k) {
        if (runs[k].solver == s && basins[k] == basin) seconds.push_back(runs[k].run.seconds);
      }
      row.push_back(std::to_string(seconds.size()));
      row.push_back(NumberCell(Median(seconds)));
    }
    table.AddRow(row);
  }
  return table;
}

}  // namespace

std::unique_ptr<Problem> FromDisturbedCircle(const Problem& problem, double disturbance,
                                             std::uint64_t seed, int k, std::string* error) {
  DataSet data;
  FitSpec spec;
  TakeApart(problem, &data, &spec);
  spec.start = "circle";
  spec.start_points.resize(0, 0);
  const std::unique_ptr<Problem> round = MakeFitProblem(std::move(data), std::move(spec), error);
  if (round == nullptr) return nullptr;
  return FromDisturbed(*round, round->curve_fit()->ControlPoints(round->start()), disturbance, seed,
                       k, error);
}

std::unique_ptr<Problem> FromDisturbed(const Problem& problem, const Points& control_points,
                                       double disturbance, std::uint64_t seed, int k,
                                       std::string* error) {
  DataSet data;
  FitSpec spec;
  TakeApart(problem, &data, &spec);
  spec.start_points = control_points;
  const Eigen::RowVectorXd mean = spec.start_points.colwise().mean();
  const double radius = (spec.start_points.rowwise() - mean).rowwise().norm().mean();
  std::mt19937_64 random(seed * 1'000'003 + static_cast<std::uint64_t>(k));
  // Not std::uniform_real_distribution, whose numbers differ between standard libraries.
  const auto noise = [&random] {
    return 2.0 * static_cast<double>(random() >> 11) * 0x1p-53 - 1.0;
  };
  for (double& value : spec.start_points.reshaped()) value += disturbance * radius * noise();
  return MakeFitProblem(std::move(data), std::move(spec), error);
}

bool CompareStarts(const Problem& problem, const StartComparisonSpec& spec,
                   StartComparison* comparison, std::string* error) {
  if (!MayHaveSeveralMinima(problem)) {
    *error = problem.name() +
             ": starts are compared where E may have several minima, as with free "
             "parameters or the loss tukey; here it has one";
    return false;
  }
  std::vector<OneRun> runs;
  std::vector<BasinEnd> ends;
  const int total = spec.starts * static_cast<int>(spec.solvers.size());
  for (int k = 0; k < spec.starts && !InterruptRequested(); ++k) {
    const auto from = FromDisturbedCircle(problem, spec.disturbance, spec.run.seed, k, error);
    if (from == nullptr) return false;
    for (std::size_t s = 0; s < spec.solvers.size() && !InterruptRequested(); ++s) {
      if (spec.progress) {
        spec.progress(static_cast<int>(runs.size()), total, spec.solvers[s].ToString());
      }
      OneRun one = {s, k, {}};
      if (!Run(*from, spec.solvers[s], spec.run, &one.run, error)) return false;
      if (!one.run.skipped.empty()) continue;
      ends.push_back(Polish(*from, one.run.x));
      runs.push_back(std::move(one));
    }
  }
  comparison->interrupted = InterruptRequested();
  const std::vector<int> basins = FindBasins(problem, ends);
  const std::vector<CurveShape> shapes = BasinShapes(*problem.curve_fit(), ends, basins);
  comparison->solvers = SolverTable(problem.name(), spec, runs, ends, basins, shapes);
  comparison->basins = BasinTable(problem.name(), spec, runs, ends, basins, shapes);
  comparison->runs = CsvTable({"problem", "solver", "start", "status", "iterations", "seconds",
                               "energy", "energy_at_foot_points", "basin", "polished"});
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const RunResult& run = runs[k].run;
    comparison->runs.AddRow({problem.name(), spec.solvers[runs[k].solver].ToString(),
                             std::to_string(runs[k].start), ToString(run.outcome.reason),
                             std::to_string(run.iterations), NumberText(run.seconds),
                             NumberText(run.energy), NumberText(ends[k].energy_at_foot_points),
                             std::to_string(basins[k] + 1), ends[k].polished ? "1" : "0"});
  }
  return true;
}

}  // namespace batten
