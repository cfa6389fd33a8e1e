#include "experiments/comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "experiments/basins.h"
#include "experiments/comparison_reference.h"
#include "experiments/kept_rows.h"
#include "solvers/solver_registry.h"

namespace batten {
namespace {

constexpr char kCholesky[] = "banded_cholesky";

/// Times of one solver over the repetitions.
struct Times {
  std::vector<double> setup;
  std::vector<double> all;

  void Add(const RunResult& run) {
    setup.push_back(run.setup_seconds);
    all.push_back(run.seconds);
  }
  /// The repetition of median time, of an even number the faster one in the middle: its set-up and
  /// solve add up, as medians of their own need not. -1: there is none.
  int MedianRepetition() const {
    if (all.empty()) return -1;
    std::vector<int> order(all.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [this](int a, int b) { return all[a] < all[b]; });
    return order[(order.size() - 1) / 2];
  }
  double MedianSeconds() const { return all.empty() ? NAN : all[MedianRepetition()]; }
};

/// The comparison on one problem.
class ProblemComparison {
 public:
  ProblemComparison(const ComparisonSpec& spec, const Problem& problem, int index)
      : spec_(spec),
        problem_(problem),
        index_(index),
        direct_(problem),
        rows_(spec.solvers.size()),
        times_(spec.solvers.size()) {}

  double minimum_energy() const { return direct_.minimum_energy(); }
  void RunAll();
  void AddTo(ComparisonResult* result);

 private:
  void RunOnce(int repetition, std::size_t solver);
  void RunReference();
  bool NeedsReference() const;
  RunSpec FirstRunSpec() const;
  void MeasureTrace(ComparisonRow* row) const;
  void Measure(std::size_t solver);
  void FindRowBasins();

  const ComparisonSpec& spec_;
  const Problem& problem_;
  int index_;
  DirectReference direct_;
  int runs_ = 0;
  std::vector<ComparisonRow> rows_;
  std::vector<Times> times_;
  Times cholesky_;
};

void ProblemComparison::RunAll() {
  for (int repetition = 0; repetition < spec_.repetitions; ++repetition) {
    if (!InterruptRequested() && NeedsReference()) RunReference();
    for (std::size_t k = 0; k < spec_.solvers.size(); ++k) {
      if (InterruptRequested()) return;
      RunOnce(repetition, k);
    }
  }
}

/// Not where banded_cholesky itself is asked for and applies; with compilation off it does not.
bool ProblemComparison::NeedsReference() const {
  if (!direct_.known()) return false;
  const bool has_row =
      std::any_of(spec_.solvers.begin(), spec_.solvers.end(),
                  [](const NameSpec& solver) { return solver.ToString() == kCholesky; });
  return !has_row || !spec_.run.compile;
}

void ProblemComparison::RunReference() {
  RunSpec run_spec = spec_.run;
  run_spec.compile = true;
  run_spec.keep_trace = run_spec.keep_iterates = false;
  run_spec.progress = nullptr;
  RunResult run;
  std::string error;
  NameSpec name;
  name.name = kCholesky;
  if (Run(problem_, name, run_spec, &run, &error) && run.skipped.empty()) cholesky_.Add(run);
}

/// The first repetition is the one whose trace is kept, with iterates as far as they fit, for the
/// exact gap along it.
RunSpec ProblemComparison::FirstRunSpec() const {
  constexpr double kMostBytes = 256.0 * 1024 * 1024;
  RunSpec run_spec = spec_.run;
  const double bytes = static_cast<double>(problem_.num_variables()) *
                       (1.0 + run_spec.max_iterations) * sizeof(double);
  const bool uses_iterates = spec_.kept_iterates > 0 || (run_spec.keep_trace && direct_.known());
  run_spec.keep_iterates = run_spec.keep_iterates || (uses_iterates && bytes <= kMostBytes);
  return run_spec;
}

void ProblemComparison::RunOnce(int repetition, std::size_t solver) {
  const NameSpec& name = spec_.solvers[solver];
  if (spec_.progress) {
    const int runs_each = static_cast<int>(spec_.solvers.size()) * spec_.repetitions;
    spec_.progress(index_ * runs_each + runs_, static_cast<int>(spec_.problems.size()) * runs_each,
                   problem_.name() + ": " + name.ToString());
  }
  ++runs_;
  ComparisonRow& row = rows_[solver];
  RunSpec run_spec = FirstRunSpec();
  if (repetition > 0) {
    // Repeating what does not apply, or what takes all the time allowed, tells nothing new.
    if (!row.run.skipped.empty() || row.run.outcome.reason == StopReason::kTimeLimit) return;
    run_spec.keep_trace = run_spec.keep_iterates = false;
    run_spec.progress = nullptr;
  }
  RunResult run;
  std::string error;
  if (!Run(problem_, name, run_spec, &run, &error)) run.skipped = error;
  const bool complete = run.outcome.reason != StopReason::kInterrupted;
  if (run.skipped.empty() && (complete || repetition == 0)) {
    times_[solver].Add(run);
    if (name.ToString() == kCholesky && spec_.run.compile) cholesky_.Add(run);
  }
  if (repetition > 0) return;
  row.problem = problem_.name();
  row.problem_index = index_;
  row.solver = name.ToString();
  row.run = std::move(run);
  MeasureTrace(&row);
}

void ProblemComparison::MeasureTrace(ComparisonRow* row) const {
  const RunResult& run = row->run;
  // A difference of sums over all points; 1000 of their roundings are left to see.
  constexpr double kNoise = 1000 * std::numeric_limits<double>::epsilon();
  const double minimum = direct_.minimum_energy();
  for (std::size_t k = 0; k < run.trace.size(); ++k) {
    double excess = NAN;
    if (k < run.iterates.size()) {
      excess = direct_.Excess(run.iterates[k].x);
    } else if (run.trace[k].energy - minimum > kNoise * run.trace[k].energy) {
      excess = run.trace[k].energy - minimum;
    }
    row->excess_energies.push_back(excess);
  }
  if (spec_.run.keep_iterates) return;
  std::vector<Iterate> kept;
  if (spec_.kept_iterates > 0) {
    const auto most = static_cast<std::size_t>(spec_.kept_iterates);
    for (const std::size_t k : KeptRows(run.iterates.size(), most)) {
      kept.push_back(run.iterates[k]);
    }
  }
  row->run.iterates = std::move(kept);
}

void ProblemComparison::Measure(std::size_t solver) {
  ComparisonRow& row = rows_[solver];
  const Times& times = times_[solver];
  row.repetitions = static_cast<int>(times.all.size());
  const int median = times.MedianRepetition();
  row.seconds = times.MedianSeconds();
  row.setup_seconds = median < 0 ? NAN : times.setup[median];
  row.solve_seconds = row.seconds - row.setup_seconds;
  row.times_cholesky = row.seconds / cholesky_.MedianSeconds();
  MeasureEnd(problem_, direct_, spec_.run, &row);
}

/// Follows every end to the rounding floor, off the clock.
void ProblemComparison::FindRowBasins() {
  std::vector<ComparisonRow*> rows;
  std::vector<BasinEnd> ends;
  for (ComparisonRow& row : rows_) {
    const bool has_end = !row.solver.empty() && row.run.skipped.empty() && row.run.x.allFinite();
    if (!has_end || InterruptRequested()) continue;
    rows.push_back(&row);
    ends.push_back(Polish(problem_, row.run.x));
  }
  const std::vector<int> basins = FindBasins(problem_, ends);
  for (std::size_t k = 0; k < rows.size(); ++k) rows[k]->basin = basins[k] + 1;
}

void ProblemComparison::AddTo(ComparisonResult* result) {
  if (MayHaveSeveralMinima(problem_)) FindRowBasins();
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    if (rows_[k].solver.empty()) continue;  // interrupted before its first run
    Measure(k);
    std::string sentence = Disagreement(direct_, spec_.run, rows_[k]);
    if (!sentence.empty()) result->disagreements.push_back(std::move(sentence));
    result->rows.push_back(std::move(rows_[k]));
  }
}

/// Everything that can be wrong with a specification, before anything runs.
bool Load(const ComparisonSpec& spec, ComparisonResult* result, std::string* error) {
  if (spec.repetitions < 1) {
    *error = "repetitions is " + std::to_string(spec.repetitions) + "; allowed: 1 or more";
    return false;
  }
  if (spec.problems.empty() || spec.solvers.empty()) {
    *error = "a comparison needs at least one problem and one solver";
    return false;
  }
  for (const NameSpec& solver : spec.solvers) {
    if (SolverRegistry::Global().Make(solver, nullptr, error) == nullptr) return false;
  }
  for (const std::string& name : spec.problems) {
    CatalogueEntry entry;
    if (!FindProblem(name, &entry, error)) return false;
    std::shared_ptr<const Problem> problem = LoadProblem(entry, error);
    if (problem == nullptr) return false;
    result->problems.push_back(std::move(problem));
  }
  return true;
}

}  // namespace

bool Compare(const ComparisonSpec& spec, ComparisonResult* result, std::string* error) {
  *result = ComparisonResult();
  result->spec = spec;
  if (!Load(spec, result, error)) return false;
  for (std::size_t i = 0; i < spec.problems.size() && !InterruptRequested(); ++i) {
    ProblemComparison comparison(spec, *result->problems[i], static_cast<int>(i));
    comparison.RunAll();
    comparison.AddTo(result);
    result->minimum_energies.push_back(comparison.minimum_energy());
  }
  result->minimum_energies.resize(spec.problems.size(), NAN);
  result->interrupted = InterruptRequested();
  return true;
}

void MeasureEnd(const Problem& problem, const DirectReference& direct, const RunSpec& spec,
                ComparisonRow* row) {
  if (const CurveFit* fit = problem.curve_fit()) row->parameter_kind = fit->spec().parameter_kind;
  row->unique_minimum = direct.unique();
  row->gap = row->distance_to_direct = row->allowed_distance = NAN;
  if (!row->run.skipped.empty()) return;
  row->gap = direct.Gap(row->run.x);
  row->distance_to_direct = direct.Distance(row->run.x);
  row->allowed_distance = direct.AllowedDistance(row->run);
  row->report = MeasureFit(problem, row->run, spec);
}

std::string Disagreement(const DirectReference& direct, const RunSpec& spec,
                         const ComparisonRow& row) {
  if (!row.run.skipped.empty() || !direct.known() || !ClaimOf(row.run, spec).minimum) return "";
  if (row.distance_to_direct <= row.allowed_distance) return "";
  return row.problem + ": " + row.solver + " claims a minimum (" +
         ToString(row.run.outcome.reason) + "), but " +
         (row.unique_minimum ? "a control point" : "A P") + " is " +
         NumberText(row.distance_to_direct) +
         " of the data's size away from the direct answer; |g| at its end allows " +
         NumberText(row.allowed_distance);
}

double Median(std::vector<double> values) {
  if (values.empty()) return NAN;
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

}  // namespace batten
