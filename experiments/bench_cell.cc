#include "experiments/bench_cell.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "experiments/basins.h"
#include "experiments/comparison_records.h"
#include "experiments/content_hash.h"
#include "experiments/identity_card.h"
#include "experiments/machine_speed.h"
#include "experiments/plugin_faults.h"
#include "experiments/sparse_run.h"

namespace batten {
namespace {

using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// In a process of its own nothing can be handed back but what it says.
std::unique_ptr<Problem> ProblemOf(const BenchSuite& suite, const BenchCell& cell) {
  std::string error;
  std::unique_ptr<Problem> problem =
      MakeBenchProblem(suite.problems[cell.problem], suite.terms[cell.terms], cell.seeds, &error);
  if (problem == nullptr) throw std::runtime_error(error);
  return problem;
}

RunSpec RuleOf(const BenchSuite& suite, const BenchCell& cell) {
  RunSpec spec = suite.run;
  spec.seed = static_cast<std::uint64_t>(cell.seeds.solver);
  return spec;
}

/// Code and memory are met for the first time off the record; a long run needs no whole one.
void WarmUp(const Problem& problem, const NameSpec& solver, RunSpec spec, int runs) {
  constexpr double kLongest = 0.25;  // seconds, of all of them
  spec.keep_trace = false;
  double left = kLongest;
  for (int i = 0; i < runs && left > 0.0; ++i) {
    spec.max_seconds = std::min(spec.max_seconds, left);
    RunResult ignored;
    std::string error;
    if (!Run(problem, solver, spec, &ignored, &error) || !ignored.skipped.empty()) return;
    left -= std::max(ignored.seconds, 1e-9);
  }
}

/// Claims of a minimum whose |g| the audit does not cover are held against what run control found:
/// |g| at the end as the problem's own terms give it.
bool ClaimIsBelied(const ComparisonRow& row, const RunSpec& spec) {
  if (row.report.audited && !row.report.verdict.holds) return true;
  if (row.report.audited && row.report.audit.covers_gradient) return false;
  const Claim claim = ClaimOf(row.run, spec);
  if (!claim.minimum) return false;
  const double allowed = std::max(claim.gradient_target, row.run.gradient_floor);
  return !(row.run.gradient_norm <= allowed * (1.0 + 1e-9));
}

/// None is allowed (docs/plugins.md). A library that books where it stands once it has returned
/// makes one, a method around it one more: nothing of them changes the result.
constexpr long kMostCallsPastStop = 2;

std::vector<std::string> FlagsOf(const ComparisonRow& row, const RunSpec& spec) {
  std::vector<std::string> flags;
  if (ClaimIsBelied(row, spec)) flags.emplace_back("claim_fails");
  if (row.run.calls_past_stop > kMostCallsPastStop) flags.emplace_back("ignores_stop");
  if (!std::isfinite(row.run.energy)) flags.emplace_back("no_finite_end");
  return flags;
}

/// Where a run on a problem without direct answer leads: its curve, to be compared with others'.
void AddEnd(const Problem& problem, const RunResult& run, const RunSpec& spec, Json* json) {
  constexpr Eigen::Index kMostNumbers = 20'000;  // a line has to stay below 1 MiB
  // What is not on a solver's clock is not to take far longer than what is.
  constexpr double kTimesTheRun = 2.0;
  const BasinEnd end =
      Polish(problem, run.x, std::min(kMostPolishing, kTimesTheRun * spec.max_seconds));
  if (!end.control_points.allFinite() || end.control_points.size() > kMostNumbers) return;
  (*json)["polished"] = end.polished;
  (*json)["polished_energy"] = end.energy;
  (*json)["polished_energy_at_foot_points"] = end.energy_at_foot_points;
  Json points = Json::array();
  for (const double value : end.control_points.reshaped<Eigen::RowMajor>()) points.push_back(value);
  (*json)["polished_control_points"] = std::move(points);
}

/// `identity`: the solver with its options.
void AddPlace(const BenchSuite& suite, const BenchCell& cell, const std::string& identity,
              Json* json) {
  (*json)["terms"] = suite.terms[cell.terms].label;
  (*json)["parameter_kind"] = ToString(suite.problems[cell.problem].entry.spec.parameter_kind);
  (*json)["data_seed"] = cell.seeds.data;
  (*json)["start_seed"] = cell.seeds.start;
  (*json)["repetition"] = cell.repetition;
  (*json)["identity"] = identity;
  ContentHash hash;
  hash.Add(InstanceKey(suite, cell));  // program, plugins, problem, data, terms
  hash.Add(identity);
  (*json)["identity_hash"] = hash.Digits();
}

void AddTruthChecks(const ComparisonRow& row, const RunSpec& spec, Json* json) {
  (*json)["stream"] = HexDigits(row.run.stream_hash);
  (*json)["stream_points"] = row.run.stream_points;
  Json prefixes = Json::array();
  for (const std::uint64_t hash : row.run.stream_prefixes) prefixes.push_back(HexDigits(hash));
  (*json)["stream_prefixes"] = std::move(prefixes);
  (*json)["calls_past_stop"] = row.run.calls_past_stop;
  (*json)["findings"] = FlagsOf(row, spec);
  const std::string other = OptionsThatDiffer(row.run);
  if (other.empty()) return;
  (*json)["findings"].push_back("other_options");
  (*json)["other_options"] = other;
}

/// Off the solver's clock, within a part of the seconds that the process has left.
void AddPluginChecks(const Problem& problem, const RunResult& run, const RunSpec& spec,
                     double seconds_left, Json* json) {
  constexpr double kPart = 0.25;
  constexpr double kMostSeconds = 5.0;
  const double most = std::min(kMostSeconds, kPart * seconds_left);
  const auto wrong = TermsWithWrongGradient(problem, {problem.start(), run.x}, most);
  if (wrong.has_value() && !wrong->empty()) {
    (*json)["wrong_gradients"] = *wrong;
    (*json)["findings"].push_back("wrong_gradient");
  }
  if (!IsOfPlugin(run.solver) || most <= 0.0) return;
  const std::optional<bool> reads = ReadsPastX(problem, run.solver, spec, most);
  if (reads.value_or(false)) (*json)["findings"].push_back("reads_past_x");
  // Most runs end before a limit tells them to stop; one that went on when told is known already.
  if (run.calls_past_stop > kMostCallsPastStop) return;
  const int calls = CallsPastStop(problem, run.solver, spec, most).value_or(0);
  if (calls <= kMostCallsPastStop) return;
  (*json)["findings"].push_back("ignores_stop");
  (*json)["calls_past_early_stop"] = calls;
}

ComparisonRow RunOnce(const Problem& problem, const NameSpec& solver, const RunSpec& spec,
                      std::size_t most_iterates, const std::string& label) {
  ComparisonRow row;
  std::string error;
  if (!RunKeepingSome(problem, solver, spec, most_iterates, &row.run, &error)) {
    throw std::runtime_error(error);
  }
  row.problem = label;
  row.solver = solver.ToString();
  row.repetitions = row.run.skipped.empty() ? 1 : 0;
  row.setup_seconds = row.run.setup_seconds;
  row.seconds = row.run.seconds;
  row.solve_seconds = row.seconds - row.setup_seconds;
  row.times_cholesky = std::nan("");
  return row;
}

/// Seconds of one evaluation of E: the median of batches, each long enough for the clock.
double EvaluationSeconds(const Problem& problem, bool compile) {
  constexpr int kBatches = 7;
  constexpr double kShortest = 1e-3;
  constexpr double kLongest = 0.2;  // of all
  Objective objective(&problem, nullptr, Objective::Options{compile});
  Eigen::VectorXd x = objective.start();
  double energy = 0.0;
  if (x.size() == 0 || objective.Energy(x, &energy) != Status::kOk) return std::nan("");
  const auto Batch = [&](int count) {
    const Clock::time_point begin = Clock::now();
    for (int i = 0; i < count; ++i) {
      // Another point each time: nothing may be remembered of the last.
      x[0] = std::nextafter(x[0], HUGE_VAL);
      objective.Energy(x, &energy);
    }
    return SecondsSince(begin);
  };
  int count = 1;
  double seconds = Batch(count);
  while (seconds < kShortest) seconds = Batch(count *= 2);
  std::vector<double> batches;
  for (double all = 0.0; batches.size() < kBatches && all < kLongest; all += seconds) {
    seconds = Batch(count);
    batches.push_back(seconds / count);
  }
  return Median(batches);
}

/// E of the problem at the truth its data were made from; NaN where none is known.
double TruthEnergy(const BenchProblem& bench, const BenchCell& cell, const Problem& problem) {
  if (!bench.truth.has_value()) return std::nan("");
  const CurveFit& fit = *problem.curve_fit();
  const Points points = TruthControlPoints(*bench.truth, bench.entry.spec);
  const DataSet data = SyntheticData(*bench.truth, bench.entry.spec, cell.seeds.data);
  const Eigen::VectorXd x =
      fit.has_free_parameters() ? fit.Variables(points, *data.parameters) : fit.Variables(points);
  Objective objective(&problem, nullptr);
  double sum = 0.0;
  for (const double energy : objective.TermEnergies(problem.elimination().FreeVariables(x))) {
    sum += energy;
  }
  return sum * problem.units().energy;
}

}  // namespace

std::string RunBenchCell(const BenchSuite& suite, const BenchCell& cell,
                         const BenchRecords& records) {
  const Clock::time_point begin = Clock::now();
  const std::unique_ptr<Problem> problem = ProblemOf(suite, cell);
  const NameSpec& solver = suite.solvers[cell.solver];
  const RunSpec spec = RuleOf(suite, cell);
  const std::size_t most_iterates =
      KeepsIterates(suite, cell) ? MostIterates(*problem, suite.keep_iterates) : 0;
  WarmUp(*problem, solver, spec, suite.warm_up);
  ComparisonRow row =
      RunOnce(*problem, solver, spec, most_iterates, suite.problems[cell.problem].label);
  const DirectReference direct(*problem);
  MeasureEnd(*problem, direct, spec, &row);
  const bool ran = row.run.skipped.empty();
  Json json = CellJson(row, direct.minimum_energy(), spec);
  AddPlace(suite, cell, EffectiveIdentity(row.run), &json);
  AddTruthChecks(row, spec, &json);
  AllowLargeFiles();
  const std::string not_written = WriteRecords(*problem, row.run, records, &json);
  if (!not_written.empty()) return kCannotWrite + not_written;
  const std::string disagreement = Disagreement(direct, spec, row);
  json["disagreement"] = disagreement.empty() ? Json() : Json(disagreement);
  // Repetitions end alike, which is checked by their energies; one is polished.
  const bool is_first = cell.repetition == 1;
  if (ran && is_first && !direct.known() && row.run.x.allFinite()) {
    AddEnd(*problem, row.run, spec, &json);
  }
  if (ran && is_first) {
    AddPluginChecks(*problem, row.run, spec, LimitsOf(suite).wall_seconds - SecondsSince(begin),
                    &json);
  }
  return DumpJson(json, -1);
}

std::string MeasureInstance(const BenchSuite& suite, const BenchCell& cell) {
  const std::unique_ptr<Problem> problem = ProblemOf(suite, cell);
  const BenchProblem& bench = suite.problems[cell.problem];
  const DirectReference direct(*problem);
  Json json;
  json["format"] = "batten.instance/1";
  json["problem"] = bench.label;
  json["terms"] = suite.terms[cell.terms].label;
  json["data_seed"] = cell.seeds.data;
  json["start_seed"] = cell.seeds.start;
  json["num_variables"] = Objective(problem.get(), nullptr).num_variables();
  json["num_points"] = problem->curve_fit()->parameters().size();
  json["evaluation_seconds"] = EvaluationSeconds(*problem, suite.run.compile);
  json["reference_seconds"] = ReferenceSeconds();
  json["minimum_energy"] = direct.minimum_energy();
  json["truth_energy"] = TruthEnergy(bench, cell, *problem);
  const CurveFit& fit = *problem->curve_fit();
  json["size"] = fit.size();
  if (!direct.known()) {
    // To compare the curves that runs end at.
    json["degree"] = fit.basis().degree();
    json["periodic"] = fit.basis().periodic();
    json["knots"] = fit.basis().knots();
  }
  json["noise"] = bench.truth.has_value() ? Json(bench.truth->noise) : Json();
  return DumpJson(json, -1);
}

Json FailedRow(const BenchSuite& suite, const BenchCell& cell, const ChildEnd& end) {
  ComparisonRow row;
  row.problem = suite.problems[cell.problem].label;
  row.solver = suite.solvers[cell.solver].ToString();
  row.run.skipped = end.message;  // so that all numbers are null
  Json json = CellJson(row, std::nan(""), RuleOf(suite, cell));
  json["stop"] = ToString(end.how);
  AddPlace(suite, cell, SolverIdentity(suite.solvers[cell.solver]), &json);
  json["stream"] = HexDigits(0);
  json["stream_points"] = 0;
  json["calls_past_stop"] = 0;
  json["findings"] = {ToString(end.how)};
  json["trace_rows"] = 0;
  json["iterate_rows"] = 0;
  json["disagreement"] = nullptr;
  return json;
}

ChildLimits LimitsOf(const BenchSuite& suite) {
  constexpr double kTimes = 3.0;  // the seconds of the rule: warm-up, polishing and measuring too
  constexpr double kRest = 30.0;
  ChildLimits limits;
  limits.memory_mb = suite.limits.memory_mb;
  limits.wall_seconds = suite.limits.wall_seconds > 0.0 ? suite.limits.wall_seconds
                                                        : kTimes * suite.run.max_seconds + kRest;
  limits.cpu_seconds = suite.limits.cpu_seconds > 0.0
                           ? suite.limits.cpu_seconds
                           : 2.0 * limits.wall_seconds * suite.run.threads;
  return limits;
}

}  // namespace batten
