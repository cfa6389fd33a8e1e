// Free parameters: time of each method from the same starts to a gap of 1e-6 to the minimum of the
// basin it ends in, and the time of one iteration of lm_schur per point. Prints a Markdown page.
//   free_race_benchmark [STARTS] [SECONDS]   starts per outline (20), most seconds per run (5)

#include <lbfgs.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "experiments/comparison.h"
#include "experiments/start_comparison.h"
#include "problems/objective.h"
#include "solvers/foot_model.h"

namespace batten {
namespace {

constexpr double kGap = 1e-6;
constexpr const char* kLibLbfgs = "libLBFGS";

double Now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// One row per iteration, as a trace keeps it; inside units.
struct Trace {
  std::vector<double> seconds;
  std::vector<double> energies;
};

struct LibRun {
  Objective* objective;
  Eigen::VectorXd gradient;
  double begin;
  double most_seconds;
  Trace trace;
};

lbfgsfloatval_t EvaluateForLib(void* instance, const lbfgsfloatval_t* x, lbfgsfloatval_t* g,
                               const int n, const lbfgsfloatval_t /*step*/) {
  auto* run = static_cast<LibRun*>(instance);
  const Eigen::VectorXd at = Eigen::Map<const Eigen::VectorXd>(x, n);
  double energy = 0.0;
  run->objective->EnergyAndGradient(at, &energy, &run->gradient);
  std::copy(run->gradient.data(), run->gradient.data() + n, g);
  return energy;
}

int ProgressOfLib(void* instance, const lbfgsfloatval_t* /*x*/, const lbfgsfloatval_t* /*g*/,
                  const lbfgsfloatval_t fx, const lbfgsfloatval_t /*xnorm*/,
                  const lbfgsfloatval_t /*gnorm*/, const lbfgsfloatval_t /*step*/, int /*n*/,
                  int /*k*/, int /*ls*/) {
  auto* run = static_cast<LibRun*>(instance);
  run->trace.seconds.push_back(Now() - run->begin);
  run->trace.energies.push_back(fx);
  return run->trace.seconds.back() > run->most_seconds ? 1 : 0;
}

Trace RunLibLbfgs(const Problem& problem, double most_seconds, Eigen::VectorXd* x) {
  Objective objective(&problem, nullptr);
  *x = objective.start();
  lbfgs_parameter_t parameters;
  lbfgs_parameter_init(&parameters);
  parameters.m = 10;
  parameters.epsilon = 1e-14;
  parameters.max_iterations = 100'000;
  LibRun run = {&objective, {}, Now(), most_seconds, {}};
  lbfgs(static_cast<int>(x->size()), x->data(), nullptr, &EvaluateForLib, &ProgressOfLib, &run,
        &parameters);
  return run.trace;
}

/// Seconds to the gap; infinite if it is not reached. E is in the units of `trace`.
double SecondsToGap(const Trace& trace, double start, double minimum) {
  for (std::size_t k = 0; k < trace.energies.size(); ++k) {
    if (trace.energies[k] - minimum <= kGap * (start - minimum)) return trace.seconds[k];
  }
  return std::numeric_limits<double>::infinity();
}

/// One run; its time to the gap of its own basin, and the energy at foot points of that basin.
void RunOnce(const Problem& problem, const std::string& solver, double most_seconds,
             double* seconds, double* energy) {
  Trace trace;
  Eigen::VectorXd end;
  double unit = 1.0;
  double start = 0.0;
  if (solver == kLibLbfgs) {
    Objective objective(&problem, nullptr);
    objective.Energy(objective.start(), &start);
    start *= problem.units().energy;
    unit = problem.units().energy;
    trace = RunLibLbfgs(problem, most_seconds, &end);
  } else {
    NameSpec name;
    std::string error;
    RunSpec spec;
    spec.max_seconds = most_seconds;
    spec.max_iterations = 100'000;
    RunResult run;
    if (!ParseNameSpec(solver, &name, &error) || !Run(problem, name, spec, &run, &error)) {
      std::fprintf(stderr, "%s: %s\n", solver.c_str(), error.c_str());
      std::exit(1);
    }
    for (const TraceRow& row : run.trace) {
      trace.seconds.push_back(row.seconds);
      trace.energies.push_back(row.energy);
    }
    start = run.start_energy;
    end = run.x;
  }
  for (double& value : trace.energies) value *= unit;
  const BasinEnd basin = Polish(problem, end);
  // A run that is far from where polishing leads has not reached its basin.
  *seconds = SecondsToGap(trace, start, std::min(basin.energy, trace.energies.back()));
  const bool arrived = trace.energies.back() - basin.energy <= 1e-3 * (start - basin.energy);
  if (!arrived) *seconds = std::numeric_limits<double>::infinity();
  *energy = basin.energy_at_foot_points;
}

void Race(int starts, double most_seconds) {
  const std::vector<std::string> solvers = {"foot_newton",  "newton",
                                            "lm_schur",     "varpro",
                                            "sdm",          "tdm",
                                            "anderson:sdm", "anderson/window=3:pdm",
                                            "anderson:pdm", "anderson/window=10:pdm",
                                            "lbfgs",        "ceres_lbfgs",
                                            kLibLbfgs,      "ceres_lm"};
  std::printf(
      "| method | median ms to gap 1e-6 | 90 %% below, ms | reached | times foot_newton | "
      "geometric "
      "mean of E at feet |\n|---|---|---|---|---|---|\n");
  double ours = 0.0;
  for (const std::string& solver : solvers) {
    std::vector<double> seconds;
    double log_energy = 0.0;
    int reached = 0;
    for (const char* outline : {"rhino_free", "squirrel_free", "dolphin_free", "cat_free"}) {
      CatalogueEntry entry;
      std::string error;
      FindProblem(outline, &entry, &error);
      const auto problem = LoadProblem(entry, &error);
      for (int k = 0; k < starts; ++k) {
        const auto from = FromDisturbedCircle(*problem, 0.3, 1, k, &error);
        double time = 0.0, energy = 0.0;
        RunOnce(*from, solver, most_seconds, &time, &energy);
        seconds.push_back(time);
        log_energy += std::log(energy);
        reached += std::isfinite(time) ? 1 : 0;
      }
    }
    std::sort(seconds.begin(), seconds.end());
    const double median = Median(seconds);
    if (ours == 0.0) ours = median;
    const double high = seconds[seconds.size() * 9 / 10];
    std::printf("| `%s` | %.3g | %.3g | %d of %zu | %.3g | %.4g |\n", solver.c_str(), 1e3 * median,
                1e3 * high, reached, seconds.size(), median / ours,
                std::exp(log_energy / static_cast<double>(seconds.size())));
    std::fflush(stdout);
  }
}

/// A bent loop with noise, free parameters from the data's own.
std::unique_ptr<Problem> Loop(int m, int n) {
  DataSet data;
  data.points.resize(m, 2);
  for (int i = 0; i < m; ++i) {
    const double a = 2.0 * M_PI * i / m;
    const double r = 1.0 + 0.3 * std::cos(3.0 * a + 0.7) + 0.01 * std::sin(977.0 * i);
    data.points.row(i) << r * std::cos(a), r * std::sin(a);
  }
  FitSpec spec;
  spec.closed = true;
  spec.control_points = n;
  spec.parameter_kind = ParameterKind::kFree;
  std::string error;
  return MakeFitProblem(std::move(data), spec, &error);
}

/// Sums, factorization and the parameters' steps: an iteration of lm_schur whose step is taken.
void IterationPerPoint() {
  std::printf(
      "\n| points | control points | sums, ns per point | steps | factor | together |\n"
      "|---|---|---|---|---|---|\n");
  for (const int m : {1000, 10'000, 100'000, 1'000'000}) {
    const int n = std::max(20, m / 1000);
    const auto problem = Loop(m, n);
    const Objective objective(problem.get(), nullptr);
    FootModel model(*objective.free_view(), 1);
    const Eigen::VectorXd x = objective.start();
    Eigen::VectorXd step, next;
    const int rounds = std::max(3, 3'000'000 / m);
    double parts[3] = {};
    for (int round = -1; round < rounds; ++round) {
      const double t0 = Now();
      model.Sum(x, FootModelKind::kTangent, 1e-3);
      const double t1 = Now();
      model.Factor(1e-3);
      model.Solve(&step);
      const double t2 = Now();
      model.Move(x, step, &next);
      const double t3 = Now();
      if (round < 0) continue;  // caches
      parts[0] += t1 - t0;
      parts[1] += t3 - t2;
      parts[2] += t2 - t1;
    }
    for (double& part : parts) part *= 1e9 / rounds / m;
    std::printf("| %d | %d | %.1f | %.1f | %.1f | %.1f |\n", m, n, parts[0], parts[1], parts[2],
                parts[0] + parts[1] + parts[2]);
  }
}

}  // namespace
}  // namespace batten

int main(int argc, char** argv) {
  const int starts = argc > 1 ? std::atoi(argv[1]) : 20;
  const double seconds = argc > 2 ? std::atof(argv[2]) : 5.0;
  std::printf(
      "# Free parameters\n\nFour outlines of 80 to 120 points, 12 control points, %d "
      "disturbed circles each, one thread. A run's time is that to a gap of 1e-6 to the "
      "minimum of its own basin, found by polishing its end; runs that do not arrive in "
      "%g s count as slowest.\n\n",
      starts, seconds);
  batten::Race(starts, seconds);
  std::printf("\nOne iteration of `lm_schur`, one core, cubic in the plane:\n");
  batten::IterationPerPoint();
  return 0;
}
