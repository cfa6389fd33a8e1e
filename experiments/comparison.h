#ifndef BATTEN_EXPERIMENTS_COMPARISON_H_
#define BATTEN_EXPERIMENTS_COMPARISON_H_

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "experiments/comparison_reference.h"
#include "experiments/fit_report.h"
#include "experiments/run.h"
#include "problems/catalogue.h"
#include "problems/fit_problem.h"

namespace batten {

struct ComparisonSpec {
  std::vector<std::string> problems;  // catalogue names or problem files
  std::vector<NameSpec> solvers;
  RunSpec run;
  int repetitions = 5;  // >= 1; interleaved: all solvers once, then all again, ...
  /// So many iterates of each run stay in its row, by KeptRows; none of a run whose iterates, at
  /// max_iterations, would need more than 256 MiB.
  int kept_iterates = 0;
  /// Told before each run: "rhino: lbfgs" is run done + 1 of total; may be empty.
  std::function<void(int done, int total, const std::string& running)> progress;
};

/// One problem x solver: a row of the table and of cells.jsonl (schema in docs/formats.md).
struct ComparisonRow {
  std::string problem;
  int problem_index = 0;       // in ComparisonResult::problems
  std::string solver;          // as written, NAME/OPTION=VALUE
  RunResult run;               // of the first repetition: trace and end
  double setup_seconds = 0.0;  // of the repetition with the median time
  double solve_seconds = 0.0;
  double seconds = 0.0;
  int repetitions = 0;          // really made: one where a run is skipped or cut by time
  double times_cholesky = 0.0;  // seconds / seconds of banded_cholesky on this problem; NaN
  double gap = 0.0;             // ||A (P - P*)||^2 / (E(start) - E*); NaN where not quadratic
  /// Largest distance of a control point from the direct answer's, over the data's size where the
  /// minimum is unique; else largest |A (P - P*)| of a row over the data's size.
  double distance_to_direct = 0.0;
  double allowed_distance = 0.0;  // what |g| at the end and the condition allow it to be
  bool unique_minimum = true;
  /// E - E* at each row of the trace, as ||A (P - P*)||^2, in the user's units. Where iterates
  /// would need too much memory: by subtraction as far as that is no noise, NaN from there on.
  std::vector<double> excess_energies;
  FitReport report;
  ParameterKind parameter_kind = ParameterKind::kFixed;
  /// Of moving parameters: which minimum the end leads to, 1 being the one of least energy at foot
  /// points that a run of this comparison on this problem leads to. Speed compares within one basin
  /// only. None where parameters are fixed or nothing ran.
  std::optional<int> basin;
};

struct ComparisonResult {
  ComparisonSpec spec;
  std::vector<ComparisonRow> rows;  // problem by problem, solvers in the order given
  std::vector<std::shared_ptr<const Problem>> problems;  // as in spec.problems
  std::vector<double> minimum_energies;                  // E* of each; NaN: no direct answer
  bool interrupted = false;
  /// Cross-check: rows that claim a minimum (race mode) yet are farther from the direct answer than
  /// the tolerance derived from |g| and the condition: one sentence each.
  std::vector<std::string> disagreements;
};

/// Runs everything. QR and banded_cholesky are run as references even if not asked for (then
/// without a row). False with one sentence in `error` for unknown names or unreadable problems,
/// found before anything runs.
bool Compare(const ComparisonSpec& spec, ComparisonResult* result, std::string* error);

/// Fills in what is measured at the end of row->run: gap, distances, report. Not what belongs to
/// several runs: times.
void MeasureEnd(const Problem& problem, const DirectReference& direct, const RunSpec& spec,
                ComparisonRow* row);
/// The sentence about a measured row that claims a minimum farther from the direct answer than |g|
/// and the condition allow; empty if it agrees or there is no direct answer.
std::string Disagreement(const DirectReference& direct, const RunSpec& spec,
                         const ComparisonRow& row);

/// The middle one, or the mean of both; NaN for none.
double Median(std::vector<double> values);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_COMPARISON_H_
