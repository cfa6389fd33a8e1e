#ifndef BATTEN_EXPERIMENTS_EXPERIMENT_RUNS_H_
#define BATTEN_EXPERIMENTS_EXPERIMENT_RUNS_H_

#include <memory>
#include <string>
#include <vector>

#include "experiments/comparison_reference.h"
#include "experiments/csv_table.h"
#include "experiments/run.h"
#include "experiments/run_recorder.h"
#include "problems/fit_problem.h"

namespace batten {

/// The columns that ProblemRuns::Run fills.
std::vector<std::string> RunColumns();
/// `first`, then RunColumns().
std::vector<std::string> RunColumnsBehind(const std::vector<std::string>& first);
/// Adds the rows of `rows` (RunColumns()), each behind the cells `first`, to `table`.
void AddRowsBehind(const std::vector<std::string>& first, const CsvTable& rows, CsvTable* table);
/// The columns of a table of traces, one row per iteration.
std::vector<std::string> TraceColumns();

/// A stop rule with the name that it has in tables.
struct StopRule {
  const char* name;
  RunSpec spec;
};
inline constexpr const char* kPaperRule = "step or |g| < 1e-6";
inline constexpr const char* kStrictRule = "|g| < 1e-10";
inline constexpr const char* kRaceRule = "race";
/// The paper's two, native, and |g| <= 1e-10 |g(start)| for all.
std::vector<StopRule> PaperRules();
/// False for a geometric iteration under kStrictRule, which the paper has for L-BFGS alone.
bool RuleConcerns(const StopRule& rule, const std::string& solver);

/// Runs of several solvers on one problem, as rows of an experiment's tables.
class ProblemRuns {
 public:
  /// Times are medians of `repetitions` runs behind one that is not counted. `label` stands in the
  /// column "problem". `recorder`, if not null, keeps the runs.
  ProblemRuns(std::string label, std::shared_ptr<const Problem> problem, int repetitions,
              RunRecorder* recorder = nullptr);

  const Problem& problem() const { return *problem_; }
  const DirectReference& reference() const { return reference_; }
  /// Median time of banded_cholesky, measured at the first call; NaN where it does not apply.
  double cholesky_seconds();

  /// Runs `solver` (NAME/OPTION=VALUE) and adds a row to `table` (RunColumns()) and, if not null,
  /// its trace to `traces` (TraceColumns()). A solver that does not apply gives a row that says so.
  RunResult Run(const std::string& solver, const RunSpec& spec, CsvTable* table,
                CsvTable* traces = nullptr);

 private:
  double Gap(const Eigen::VectorXd& x, const RunSpec& spec) const;
  double MedianSeconds(const NameSpec& solver, const RunSpec& spec, double first) const;
  void Record(const std::string& solver, const RunSpec& spec, double seconds, double cholesky,
              RunResult* result) const;

  std::string label_;
  std::shared_ptr<const Problem> problem_;
  int repetitions_;
  RunRecorder* recorder_;
  DirectReference reference_;
  double cholesky_seconds_ = -1.0;
};

/// The paper's rules: largest control-point step below 1e-6 for geometric iterations, |g| below
/// `gradient` for the others; with a trace.
RunSpec NativeSpec(double gradient);
/// One rule for all: |g| <= tolerance |g(start)|; with a trace.
RunSpec RaceSpec(double tolerance);

/// A problem of the catalogue. Null with one sentence in `error`.
std::shared_ptr<const Problem> CatalogueProblem(const std::string& name, std::string* error);

/// The fit of `data` that an experiment has put together itself; one that cannot be made is our
/// bug: CHECK.
std::shared_ptr<const Problem> CheckedFit(DataSet data, FitSpec spec);
/// The fit of `outline` with its points at parameters t in [0, 1].
std::shared_ptr<const Problem> AtParameters(const Problem& outline, const Eigen::VectorXd& t);

/// For sentences: rounded to so many decimals, without zeros at the end.
std::string Rounded(double value, int decimals);

/// m points of a closed curve without symmetry, with noise of 1 % of its size from a fixed seed;
/// its longest side is `size`. Uniform parameters, closed uniform cubic with n control points.
std::shared_ptr<const Problem> LoopProblem(int m, int n, double size);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_EXPERIMENT_RUNS_H_
