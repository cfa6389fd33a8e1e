// Free parameters: time of each method from the same starts to a gap of 1e-6 to the minimum of the
// basin it ends in, beside ours in the pairs of runs that end in one basin. Prints a Markdown page.
//   free_race_benchmark [--starts=20] [--seconds=0.4]   starts per outline, most seconds per run
// At the defaults it is done in less than a quarter of an hour.

#include <lbfgs.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "experiments/comparison.h"
#include "experiments/csv_table.h"
#include "experiments/start_comparison.h"
#include "problems/data_folders.h"
#include "problems/objective.h"

namespace batten {
namespace {

constexpr double kGap = 1e-6;
constexpr const char* kLibLbfgs = "libLBFGS";

[[noreturn]] void Fail(const std::string& why) {
  std::fprintf(stderr, "free_race_benchmark: %s\n", why.c_str());
  std::exit(2);
}

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

/// Where a run of a method from a start has led, and how soon.
struct Arrival {
  double seconds = std::numeric_limits<double>::infinity();  // to the gap
  BasinEnd basin;
};

Arrival RunOnce(const Problem& problem, const std::string& solver, double most_seconds) {
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
      Fail(solver + ": " + error);
    }
    for (const TraceRow& row : run.trace) {
      trace.seconds.push_back(row.seconds);
      trace.energies.push_back(row.energy);
    }
    start = run.start_energy;
    end = run.x;
  }
  for (double& value : trace.energies) value *= unit;
  constexpr double kPolishSeconds = 0.25;
  Arrival arrival;
  arrival.basin = Polish(problem, end, kPolishSeconds);
  if (trace.energies.empty()) return arrival;
  // A run that is far from where polishing leads has not reached its basin.
  const double minimum = arrival.basin.energy;
  if (trace.energies.back() - minimum <= 1e-3 * (start - minimum)) {
    arrival.seconds = SecondsToGap(trace, start, std::min(minimum, trace.energies.back()));
  }
  return arrival;
}

/// Closed outlines in the plane of at most so many points: 300 runs of a method on longer ones
/// would take hours, and the longer animals are these again.
std::vector<std::string> Outlines() {
  constexpr double kMostPoints = 200.0;
  std::ifstream file(DataRoot() + "/data/manifest.csv");
  std::stringstream text;
  text << file.rdbuf();
  CsvTable manifest;
  std::string error;
  if (!CsvTable::FromCsv(text.str(), &manifest, &error)) Fail("data/manifest.csv: " + error);
  const CsvTable closed = manifest.Where("kind", "closed").Where("dim", "2");
  std::vector<std::string> outlines;
  for (std::size_t row = 0; row < closed.num_rows(); ++row) {
    if (closed.Number(row, "points") <= kMostPoints) outlines.push_back(closed.Text(row, "file"));
  }
  return outlines;
}

std::unique_ptr<Problem> OutlineFit(const std::string& outline) {
  std::string error;
  std::optional<DataSet> data = ReadDataSet(DataRoot() + "/data/" + outline, &error);
  if (!data) Fail(error);
  FitSpec spec;
  spec.closed = true;
  spec.control_points = 12;
  spec.parameter_kind = ParameterKind::kFree;
  spec.start = "circle";
  std::unique_ptr<Problem> problem = MakeFitProblem(std::move(*data), spec, &error);
  if (problem == nullptr) Fail(outline + ": " + error);
  return problem;
}

/// Of the pairs of runs from one start whose ends are polished to one curve: how many there are,
/// and the median of the ratio of times. Pairs of which neither arrives say nothing.
struct PairedTimes {
  int pairs = 0;
  double ratio = std::numeric_limits<double>::quiet_NaN();
};

PairedTimes Pair(const std::vector<std::unique_ptr<Problem>>& problems,
                 const std::vector<Arrival>& of, const std::vector<Arrival>& ours) {
  std::vector<double> ratios;
  const std::size_t starts = of.size() / problems.size();
  for (std::size_t k = 0; k < of.size(); ++k) {
    const BasinEnd& a = of[k].basin;
    const BasinEnd& b = ours[k].basin;
    if (!a.polished || !b.polished) continue;
    if (std::isinf(of[k].seconds) && std::isinf(ours[k].seconds)) continue;
    const std::vector<int> basins = FindBasins(*problems[k / starts], {a, b});
    if (basins[0] == basins[1]) ratios.push_back(of[k].seconds / ours[k].seconds);
  }
  PairedTimes paired;
  paired.pairs = static_cast<int>(ratios.size());
  if (paired.pairs > 0) paired.ratio = Median(ratios);
  return paired;
}

double MedianSeconds(const std::vector<Arrival>& arrivals) {
  std::vector<double> seconds;
  for (const Arrival& arrival : arrivals) seconds.push_back(arrival.seconds);
  return Median(seconds);
}

/// `value`, or that it is above `most` where more than half of the runs do not arrive.
std::string Shown(double value, double most) {
  char text[32];
  const bool is_finite = std::isfinite(value);
  std::snprintf(text, sizeof text, is_finite ? "%.3g" : "over %.3g", is_finite ? value : most);
  return text;
}

/// `best`: median seconds of the method that the others are held against.
void PrintRow(const std::string& solver, const std::vector<Arrival>& arrivals, double best,
              double most_seconds, const std::vector<PairedTimes>& paired) {
  int reached = 0;
  double log_energy = 0.0;
  for (const Arrival& arrival : arrivals) {
    reached += std::isfinite(arrival.seconds) ? 1 : 0;
    log_energy += std::log(arrival.basin.energy_at_foot_points);
  }
  const double median = MedianSeconds(arrivals);
  std::printf("| `%s` | %d of %zu | %s | %s |", solver.c_str(), reached, arrivals.size(),
              Shown(1e3 * median, 1e3 * most_seconds).c_str(),
              Shown(median / best, most_seconds / best).c_str());
  for (const PairedTimes& times : paired) {
    if (times.pairs == 0) {
      std::printf(" 0 | - |");
    } else {
      std::printf(" %d | %.3g |", times.pairs, times.ratio);
    }
  }
  std::printf(" %.4g |\n", std::exp(log_energy / static_cast<double>(arrivals.size())));
}

void Race(int starts, double most_seconds) {
  // Ours first: the others are held against these.
  const std::vector<std::string> ours = {"foot_newton", "newton"};
  const std::vector<std::string> solvers = {"foot_newton",  "newton",
                                            "lm_schur",     "varpro",
                                            "sdm",          "tdm",
                                            "anderson:sdm", "anderson/window=3:pdm",
                                            "anderson:pdm", "anderson/window=10:pdm",
                                            "lbfgs",        "ceres_lbfgs",
                                            kLibLbfgs,      "ceres_lm"};
  std::vector<std::unique_ptr<Problem>> problems;
  for (const std::string& outline : Outlines()) problems.push_back(OutlineFit(outline));
  std::printf(
      "%zu outlines of at most 200 points.\n\n"
      "| method | reached | median ms | over that of `%s` | pairs with `%s` | times its time | "
      "pairs "
      "with `%s` | times its time | geometric mean of E at feet |\n"
      "|---|---|---|---|---|---|---|---|---|\n",
      problems.size(), ours[0].c_str(), ours[0].c_str(), ours[1].c_str());
  std::map<std::string, std::vector<Arrival>> arrivals;
  for (const std::string& solver : solvers) {
    std::fprintf(stderr, "%s\n", solver.c_str());
    for (const auto& problem : problems) {
      for (int k = 0; k < starts; ++k) {
        std::string error;
        const auto from = FromDisturbedCircle(*problem, 0.3, 1, k, &error);
        if (from == nullptr) Fail(error);
        arrivals[solver].push_back(RunOnce(*from, solver, most_seconds));
      }
    }
  }
  for (const std::string& solver : solvers) {
    std::vector<PairedTimes> paired;
    for (const std::string& one : ours) {
      paired.push_back(Pair(problems, arrivals[solver], arrivals[one]));
    }
    PrintRow(solver, arrivals[solver], MedianSeconds(arrivals[ours[0]]), most_seconds, paired);
  }
}

/// The value of "--name=VALUE", a number from `least` on; fails for any other.
double FlagValue(const std::string& argument, double least) {
  const std::string text = argument.substr(argument.find('=') + 1);
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !(value >= least) || !std::isfinite(value)) {
    Fail(argument + ": a number from " + std::to_string(least) + " on is needed");
  }
  return value;
}

}  // namespace
}  // namespace batten

int main(int argc, char** argv) {
  int starts = 20;
  double seconds = 0.4;
  for (int k = 1; k < argc; ++k) {
    const std::string argument = argv[k];
    if (argument.rfind("--starts=", 0) == 0) {
      starts = static_cast<int>(std::min(batten::FlagValue(argument, 1.0), 1e6));
    } else if (argument.rfind("--seconds=", 0) == 0) {
      seconds = batten::FlagValue(argument, 1e-3);
    } else {
      batten::Fail("unknown argument " + argument + "; known: --starts=N --seconds=S");
    }
  }
  std::printf(
      "# Free parameters\n\nClosed outlines, 12 control points, %d disturbed circles each, one "
      "thread. A run's time is that to a gap of 1e-6 to the minimum of its own basin, found by "
      "polishing its end; runs that do not arrive in %g s count as slowest. Two runs from one "
      "start "
      "are a pair where both ends are polished to one curve (1e-6 of the size), and *times its "
      "time* "
      "is the median over pairs of the ratio of their times. ",
      starts, seconds);
  batten::Race(starts, seconds);
  return 0;
}
