// Free parameters: time of each method from the same starts to a gap of 1e-6 to the minimum of the
// basin it ends in, beside ours in the pairs of runs that end in one basin: from starts around the
// best minimum, where most runs share their basin, of short outlines, long ones and open curves;
// and from circles, where few do. Prints a Markdown page.
//   free_race_benchmark [--starts=20] [--seconds=0.4] [--table=NAME]
// starts per curve, most seconds per run (five times as many for long outlines), and one of the
// tables near, long, open, circle instead of all, which take about 50 minutes.

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

#include "benchmarks/free_race_table.h"
#include "experiments/csv_table.h"
#include "experiments/fit_report.h"
#include "experiments/start_comparison.h"
#include "problems/data_folders.h"
#include "problems/objective.h"
#include "splines/closest_point.h"

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

enum class CurveKind { kShort, kLong, kOpen };

/// Files of data/: closed outlines in the plane of up to 200 points, of up to 4,000, and open
/// curves of up to 400 in any dimension. 20 runs of every method on longer ones would take hours.
std::vector<std::string> CurveFiles(CurveKind kind) {
  constexpr double kShort = 200.0, kLong = 4000.0, kOpen = 400.0;
  std::ifstream file(DataRoot() + "/data/manifest.csv");
  std::stringstream text;
  text << file.rdbuf();
  CsvTable manifest;
  std::string error;
  if (!CsvTable::FromCsv(text.str(), &manifest, &error)) Fail("data/manifest.csv: " + error);
  const bool is_open = kind == CurveKind::kOpen;
  CsvTable rows = manifest.Where("kind", is_open ? "open" : "closed");
  if (!is_open) rows = rows.Where("dim", "2");
  std::vector<std::string> files;
  for (std::size_t row = 0; row < rows.num_rows(); ++row) {
    const double points = rows.Number(row, "points");
    const bool is_in = is_open                    ? points <= kOpen
                       : kind == CurveKind::kLong ? points > kShort && points <= kLong
                                                  : points <= kShort;
    if (is_in) files.push_back(rows.Text(row, "file"));
  }
  return files;
}

/// What one table is of.
struct RaceSpec {
  std::string name;
  std::string title;
  CurveKind curves = CurveKind::kShort;
  int control_points = 8;
  /// Disturbance of the best minimum that is known, in parts of its radius; 0: of a circle.
  double near = 0.05;
  double slower = 1.0;  ///< Factor of the most seconds per run.
  std::vector<std::string> solvers;
};

/// What the command line says.
struct RaceFlags {
  int starts = 20;  // per curve
  double seconds = 0.4;
  std::string table;  // empty: all
};

std::unique_ptr<Problem> CurveFitOf(const std::string& file, CurveKind kind, int control_points) {
  std::string error;
  std::optional<DataSet> data = ReadDataSet(DataRoot() + "/data/" + file, &error);
  if (!data) Fail(error);
  FitSpec spec;
  spec.closed = kind != CurveKind::kOpen;
  spec.control_points = control_points;
  spec.parameter_kind = ParameterKind::kFree;
  if (spec.closed) {
    spec.start = "circle";
  } else {
    spec.parameters = Parameterization::kChordLength;
  }
  std::unique_ptr<Problem> problem = MakeFitProblem(std::move(*data), spec, &error);
  if (problem == nullptr) Fail(file + ": " + error);
  return problem;
}

std::unique_ptr<Problem> Disturbed(const Problem& problem, const Points& control_points,
                                   double disturbance, int k) {
  std::string error;
  auto from = FromDisturbed(problem, control_points, disturbance, 1, k, &error);
  if (from == nullptr) Fail(error);
  return from;
}

/// From a circle, an open curve from points on the polyline through the data.
std::unique_ptr<Problem> DisturbedFarStart(const Problem& problem, int k) {
  constexpr double kOfCircle = 0.3, kOfData = 0.1;
  const CurveFit& fit = *problem.curve_fit();
  if (!fit.spec().closed) {
    return Disturbed(problem, fit.ControlPoints(problem.start()), kOfData, k);
  }
  std::string error;
  auto from = FromDisturbedCircle(problem, kOfCircle, 1, k, &error);
  if (from == nullptr) Fail(error);
  return from;
}

/// Loops of a curve that no data point is near.
int NumFreeLoops(const CurveFit& fit, const Points& control_points) {
  const BsplineCurve curve(fit.basis(), control_points);
  Eigen::VectorXd feet = fit.parameters();
  ClosestPoint(curve).FindAll(fit.data().points, 1, &feet, nullptr);
  return ShapeBesideData(fit, curve, feet)->num_free_loops;
}

/// A loop that no data hold, or control points far from the data: around such a minimum a
/// disturbance leads anywhere.
bool IsLoose(const CurveFit& fit, const Points& control_points) {
  const Points& data = fit.data().points;
  const Eigen::RowVectorXd middle = data.colwise().mean();
  const double far = (data.colwise().maxCoeff() - data.colwise().minCoeff()).norm();
  return (control_points.rowwise() - middle).rowwise().norm().maxCoeff() > far ||
         NumFreeLoops(fit, control_points) > 0;
}

/// Control points of the lowest minimum that is found from a number of far starts, of those that
/// are not loose if there are any.
Points BestMinimum(const Problem& problem) {
  constexpr int kTries = 100;
  BasinEnd best;
  bool best_is_loose = true;
  for (int k = 0; k < kTries; ++k) {
    const Arrival arrival = RunOnce(*DisturbedFarStart(problem, k), "foot_newton", 1.0);
    if (!arrival.basin.polished) continue;
    const Points& found = arrival.basin.control_points;
    const bool is_loose = IsLoose(*problem.curve_fit(), found);
    const bool is_lower = arrival.basin.energy_at_foot_points < best.energy_at_foot_points;
    const bool is_first = best.control_points.size() == 0;
    if (!is_first && (is_loose != best_is_loose ? is_loose : !is_lower)) continue;
    best = arrival.basin;
    best_is_loose = is_loose;
  }
  if (best.control_points.size() == 0) Fail(problem.name() + ": no minimum was found");
  return best.control_points;
}

/// All problems of a table, `count` of each curve one after the other.
std::vector<std::unique_ptr<Problem>> Starts(const RaceSpec& race, int count) {
  std::vector<std::unique_ptr<Problem>> starts;
  for (const std::string& file : CurveFiles(race.curves)) {
    const std::unique_ptr<Problem> problem = CurveFitOf(file, race.curves, race.control_points);
    const Points minimum = race.near > 0.0 ? BestMinimum(*problem) : Points();
    for (int k = 0; k < count; ++k) {
      starts.push_back(race.near > 0.0 ? Disturbed(*problem, minimum, race.near, k)
                                       : DisturbedFarStart(*problem, k));
    }
  }
  return starts;
}

/// The tables. Ours are first among the solvers: the others are held against these.
const std::vector<std::string> kOurs = {"foot_newton", "newton"};
std::vector<RaceSpec> Races() {
  const std::vector<std::string> all = {"foot_newton",
                                        "newton",
                                        "lm_schur",
                                        "varpro",
                                        "sdm",
                                        "tdm",
                                        "anderson:sdm",
                                        "anderson/window=3:pdm",
                                        "anderson:pdm",
                                        "anderson/window=10:pdm",
                                        "anderson/window=20:pdm",
                                        "lbfgs",
                                        "ceres_lbfgs",
                                        kLibLbfgs,
                                        "ceres_lm"};
  const std::vector<std::string> peers = {"foot_newton",
                                          "newton",
                                          "lm_schur",
                                          "anderson:pdm",
                                          "anderson/window=10:pdm",
                                          "anderson/window=20:pdm",
                                          "lbfgs",
                                          "ceres_lbfgs",
                                          kLibLbfgs,
                                          "ceres_lm"};
  const std::string near = "From a disturbed best minimum, 8 control points, ";
  // With as few control points two runs from one start mostly end in one basin.
  return {
      {"near", near + "closed outlines of up to 200 points", CurveKind::kShort, 8, 0.05, 1.0, all},
      {"long", near + "closed outlines of 201 to 4,000 points", CurveKind::kLong, 8, 0.05, 5.0,
       peers},
      {"open", near + "open curves of up to 400 points", CurveKind::kOpen, 8, 0.05, 1.0, peers},
      {"circle", "From a disturbed circle, 12 control points, closed outlines of up to 200 points",
       CurveKind::kShort, 12, 0.0, 1.0, all}};
}

void Race(const RaceSpec& race, const RaceFlags& flags) {
  const double most_seconds = race.slower * flags.seconds;
  std::printf("\n## %s\n\n%zu curves, at most %g s a run.\n\n", race.title.c_str(),
              CurveFiles(race.curves).size(), most_seconds);
  PrintHead(kOurs);
  const std::vector<std::unique_ptr<Problem>> starts = Starts(race, flags.starts);
  std::map<std::string, std::vector<Arrival>> arrivals;
  for (const std::string& solver : race.solvers) {
    std::fprintf(stderr, "%s, %s\n", race.name.c_str(), solver.c_str());
    for (const auto& start : starts) {
      arrivals[solver].push_back(RunOnce(*start, solver, most_seconds));
    }
  }
  for (const std::string& solver : race.solvers) {
    std::vector<PairedTimes> paired;
    for (const std::string& one : kOurs) {
      paired.push_back(Pair(starts, arrivals[solver], arrivals[one]));
    }
    PrintRow(solver, arrivals[solver], MedianSeconds(arrivals[kOurs[0]]), most_seconds, paired);
  }
  std::fflush(stdout);
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
  batten::RaceFlags flags;
  const std::vector<batten::RaceSpec> races = batten::Races();
  for (int k = 1; k < argc; ++k) {
    const std::string argument = argv[k];
    if (argument.rfind("--starts=", 0) == 0) {
      flags.starts = static_cast<int>(std::min(batten::FlagValue(argument, 1.0), 1e6));
    } else if (argument.rfind("--seconds=", 0) == 0) {
      flags.seconds = batten::FlagValue(argument, 1e-3);
    } else if (argument.rfind("--table=", 0) == 0) {
      flags.table = argument.substr(argument.find('=') + 1);
    } else {
      batten::Fail("unknown argument " + argument + "; known: --starts=N --seconds=S --table=NAME");
    }
  }
  const auto is_asked = [&](const batten::RaceSpec& race) {
    return flags.table.empty() || race.name == flags.table;
  };
  if (std::none_of(races.begin(), races.end(), is_asked)) {
    batten::Fail("--table: found \"" + flags.table + "\"; allowed: near, long, open, circle");
  }
  std::printf(
      "# Free parameters\n\n%d starts of each curve, one thread. A run's time is that to a gap of "
      "1e-6 to the minimum of its own basin, found by polishing its end; runs that do not arrive "
      "in "
      "time count as slowest. Two runs from one start are a pair where both ends are polished to "
      "one curve (1e-6 of the size), and *times its time* is the median over pairs of the ratio of "
      "their times.\n",
      flags.starts);
  for (const batten::RaceSpec& race : races) {
    if (is_asked(race)) batten::Race(race, flags);
  }
  return 0;
}
