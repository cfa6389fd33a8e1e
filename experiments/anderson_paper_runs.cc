#include "experiments/anderson_paper_runs.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>

#include "experiments/curve_shape.h"
#include "experiments/experiment_runs.h"
#include "splines/closest_point.h"

namespace batten {
namespace {

/// Seconds from which on a run is made once.
constexpr double kLongRun = 0.5;
constexpr double kGaps[] = {1e-3, 1e-6};

struct KeptIterate {
  int iteration = 0;
  double seconds = 0.0;
  double energy = 0.0;
};

NameSpec Parsed(const std::string& solver) {
  NameSpec name;
  std::string error;
  CHECK(ParseNameSpec(solver, &name, &error)) << error;
  return name;
}

/// Sorted by time, the middle run; the first one has found caches cold and is not counted.
RunResult MedianRun(const Problem& problem, const NameSpec& name, const RunSpec& spec,
                    int repetitions) {
  RunResult result;
  std::string error;
  CHECK(Run(problem, name, spec, &result, &error)) << error;
  if (!result.skipped.empty() || result.seconds > kLongRun) return result;
  RunSpec again = spec;
  again.keep_iterates = false;
  std::vector<RunResult> runs(static_cast<std::size_t>(repetitions));
  for (RunResult& run : runs) {
    if (InterruptRequested()) return result;
    CHECK(Run(problem, name, again, &run, &error)) << error;
  }
  if (runs.empty()) return result;
  std::sort(runs.begin(), runs.end(),
            [](const RunResult& a, const RunResult& b) { return a.seconds < b.seconds; });
  RunResult& median = runs[runs.size() / 2];
  // Runs are the same but for their times, unless time itself ended one.
  if (median.iterations != result.iterations) return result;
  result.seconds = median.seconds;
  result.setup_seconds = median.setup_seconds;
  result.trace = std::move(median.trace);
  return result;
}

Eigen::VectorXd Feet(const Problem& problem, const Eigen::VectorXd& x, double* energy) {
  const CurveFit& fit = *problem.curve_fit();
  const BsplineCurve curve = fit.Curve(x);
  Eigen::VectorXd feet = fit.Parameters(x);
  Eigen::VectorXd squared_distances;
  ClosestPoint(curve).FindAll(fit.data().points, 1, &feet, &squared_distances);
  *energy = squared_distances.sum();
  return feet;
}

/// Loops of the curve that no point is nearest to; NaN where there is no curve.
double FreeLoops(const Problem& problem, const Eigen::VectorXd& x) {
  if (!x.allFinite()) return NAN;
  double energy = NAN;
  const Eigen::VectorXd feet = Feet(problem, x, &energy);
  const CurveFit& fit = *problem.curve_fit();
  return MeasureShape(fit.Curve(x), fit.data().points, feet).num_free_loops;
}

/// E at the feet of the minimum that `x` belongs to: newton, from the feet.
double Polished(const Problem& problem, const Eigen::VectorXd& x) {
  if (!x.allFinite()) return NAN;
  double energy = NAN;
  const Eigen::VectorXd feet = Feet(problem, x, &energy);
  RunSpec spec = RaceSpec(0.0);
  spec.max_seconds = 10.0;  // The count ends it, on a busy machine too.
  spec.max_iterations = 2000;
  spec.keep_trace = false;
  spec.start = problem.curve_fit()->Variables(problem.curve_fit()->ControlPoints(x), feet);
  RunResult result;
  std::string error;
  CHECK(Run(problem, Parsed("newton"), spec, &result, &error)) << error;
  const double polished = FootEnergy(problem, result.x);
  return polished < energy ? polished : energy;
}

std::vector<KeptIterate> Thinned(const Problem& problem, const RunResult& result) {
  constexpr int kAll = 50;
  constexpr int kPart = 30;
  std::vector<KeptIterate> kept;
  const std::size_t count = std::min(result.iterates.size(), result.trace.size());
  int next = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const int iteration = result.iterates[k].iteration;
    if (iteration < next && k + 1 < count) continue;
    kept.push_back({iteration, result.trace[k].seconds, FootEnergy(problem, result.iterates[k].x)});
    next = iteration < kAll ? iteration + 1 : iteration + iteration / kPart;
  }
  return kept;
}

void KeepRun(const FreeCase& on, const std::string& solver, const RunSpec& spec, int repetitions,
             RunResult* result) {
  if (on.recorder == nullptr) return;
  const DirectReference reference(*on.problem);  // of free parameters there is none
  RecordedRun run;
  run.label = on.example + ", from " + on.start;
  run.problem = on.problem;
  run.reference = &reference;
  run.solver = solver;
  run.spec = spec;
  if (result->skipped.empty()) {
    run.seconds = result->seconds;
    run.setup_seconds = result->setup_seconds;
  }
  run.repetitions = repetitions;
  on.recorder->Add(run, result);
}

/// Share of accelerated points that were rejected, from the run's note "135 of 294, ..."; NaN.
double RejectedShare(const RunResult& result) {
  for (const auto& [name, value] : result.notes) {
    if (name != "rejected steps") continue;
    const std::size_t of = value.find(" of ");
    const std::size_t end = value.find(',');
    double rejected = 0.0, tried = 0.0;
    if (of == std::string::npos || end == std::string::npos || end < of + 4) continue;
    if (!ParseNumber(value.substr(0, of), &rejected)) continue;
    if (!ParseNumber(value.substr(of + 4, end - of - 4), &tried)) continue;
    return rejected / tried;
  }
  return NAN;
}

}  // namespace

std::vector<std::string> FreeRunColumns() {
  return {"example",
          "start",
          "solver",
          "points",
          "control_points",
          "status",
          "iterations",
          "projections",
          "seconds",
          "seconds_per_iteration",
          "start_energy",
          "energy",
          "foot_energy",
          "polished_energy",
          "length",
          "free_loops",
          "iterations_to_1e-3",
          "seconds_to_1e-3",
          "iterations_to_1e-6",
          "seconds_to_1e-6",
          "rejected"};
}

std::vector<std::string> FreeTraceColumns() {
  return {"example", "start", "solver", "iteration", "seconds", "foot_energy"};
}

RunSpec FreeRaceSpec() {
  RunSpec spec = RaceSpec(1e-8);
  spec.max_iterations = 20'000;
  spec.max_seconds = 1.5;
  spec.keep_iterates = true;
  return spec;
}

double FootEnergy(const Problem& problem, const Eigen::VectorXd& x) {
  if (!x.allFinite()) return NAN;
  double energy = NAN;
  Feet(problem, x, &energy);
  return energy;
}

Points SampledCurve(const Problem& problem, const Eigen::VectorXd& x) {
  constexpr int kSamples = 401;
  const BsplineCurve curve = problem.curve_fit()->Curve(x);
  return curve.Sample(Eigen::VectorXd::LinSpaced(kSamples, curve.basis().domain_begin(),
                                                 curve.basis().domain_end()));
}

double PolygonLength(const Points& polygon) {
  const Eigen::Index last = polygon.rows() - 1;
  return (polygon.bottomRows(last) - polygon.topRows(last)).rowwise().norm().sum();
}

RunResult RunFree(const FreeCase& on, const std::string& solver, const RunSpec& spec,
                  int repetitions, CsvTable* runs, CsvTable* traces) {
  RunResult result = MedianRun(*on.problem, Parsed(solver), spec, repetitions);
  KeepRun(on, solver, spec, repetitions, &result);
  const CurveFit& fit = *on.problem->curve_fit();
  std::vector<std::string> row = {on.example, on.start, solver,
                                  std::to_string(fit.parameters().size()),
                                  std::to_string(fit.basis().num_control_points())};
  if (!result.skipped.empty()) {
    row.emplace_back("skipped");
    row.resize(FreeRunColumns().size());
    runs->AddRow(row);
    return result;
  }
  const double polished = Polished(*on.problem, result.x);
  const std::vector<KeptIterate> kept = Thinned(*on.problem, result);
  const double iterations = result.iterations;
  row.insert(row.end(),
             {ToString(result.outcome.reason), NumberText(iterations),
              std::to_string(result.counts.projections), NumberText(result.seconds),
              NumberText((result.seconds - result.setup_seconds) / std::max(iterations, 1.0)),
              NumberText(kept.empty() ? NAN : kept.front().energy), NumberText(result.energy),
              NumberText(FootEnergy(*on.problem, result.x)), NumberText(polished),
              NumberText(PolygonLength(SampledCurve(*on.problem, result.x))),
              NumberText(FreeLoops(*on.problem, result.x))});
  for (const double gap : kGaps) {
    const auto at = std::find_if(kept.begin(), kept.end(), [&](const KeptIterate& point) {
      // One that ends above its start comes to no minimum.
      return polished < kept.front().energy && point.energy <= (1.0 + gap) * polished;
    });
    row.push_back(NumberText(at == kept.end() ? NAN : at->iteration));
    row.push_back(NumberText(at == kept.end() ? NAN : at->seconds));
  }
  row.push_back(NumberText(RejectedShare(result)));
  runs->AddRow(row);
  for (std::size_t k = 0; traces != nullptr && k < kept.size(); ++k) {
    traces->AddRow({on.example, on.start, solver, std::to_string(kept[k].iteration),
                    NumberText(kept[k].seconds), NumberText(kept[k].energy)});
  }
  return result;
}

double SecondsPerIteration(const Problem& problem, const std::string& solver, int iterations,
                           int repetitions) {
  RunSpec spec = RaceSpec(0.0);
  spec.max_iterations = iterations;
  spec.max_seconds = 5.0;
  spec.keep_trace = false;
  const RunResult result = MedianRun(problem, Parsed(solver), spec, repetitions);
  if (!result.skipped.empty() || result.iterations == 0) return NAN;
  return (result.seconds - result.setup_seconds) / result.iterations;
}

double OnlyNumber(const CsvTable& rows, const std::string& column) {
  return rows.num_rows() == 1 ? rows.Number(0, column) : NAN;
}

bool InOneBasin(double polished, double other) {
  constexpr double kAgree = 1e-3;
  return std::abs(polished - other) <= kAgree * std::min(polished, other);
}

bool IsSooner(double value, double other) {
  return value < other || (std::isfinite(value) && std::isnan(other));
}

}  // namespace batten
