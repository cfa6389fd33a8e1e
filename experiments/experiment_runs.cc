#include "experiments/experiment_runs.h"

#include <glog/logging.h>

#include <cmath>
#include <limits>
#include <utility>

#include "experiments/comparison.h"
#include "problems/catalogue.h"
#include "solvers/lanczos.h"

namespace batten {
namespace {

/// Seconds from which on a run is not warmed up: cold caches are no part of its time.
constexpr double kLongRun = 0.5;

}  // namespace

std::vector<StopRule> PaperRules() {
  return {{kPaperRule, NativeSpec(1e-6)},
          {kStrictRule, NativeSpec(1e-10)},
          {kRaceRule, RaceSpec(1e-10)}};
}

bool RuleConcerns(const StopRule& rule, const std::string& solver) {
  const bool by_gradient = solver.rfind("lbfgs", 0) == 0 || solver == "cg";
  return by_gradient || std::string(rule.name) != kStrictRule;
}

std::vector<std::string> RunColumns() {
  return {"problem",    "points",   "control_points", "mode",           "solver", "status",
          "iterations", "products", "seconds",        "times_cholesky", "energy", "gradient_norm",
          "gap",        "rate"};
}

std::vector<std::string> RunColumnsBehind(const std::vector<std::string>& first) {
  std::vector<std::string> columns = first;
  for (std::string& column : RunColumns()) columns.push_back(std::move(column));
  return columns;
}

void AddRowsBehind(const std::vector<std::string>& first, const CsvTable& rows, CsvTable* table) {
  for (std::size_t row = 0; row < rows.num_rows(); ++row) {
    std::vector<std::string> cells = first;
    for (const std::string& column : rows.columns()) cells.push_back(rows.Text(row, column));
    table->AddRow(std::move(cells));
  }
}

std::vector<std::string> TraceColumns() {
  return {"problem", "mode", "solver", "iteration", "energy", "gradient_norm", "step_norm", "gap"};
}

ProblemRuns::ProblemRuns(std::string label, std::shared_ptr<const Problem> problem, int repetitions,
                         RunRecorder* recorder)
    : label_(std::move(label)),
      problem_(std::move(problem)),
      repetitions_(repetitions),
      recorder_(recorder),
      reference_(*problem_) {}

double ProblemRuns::cholesky_seconds() {
  if (cholesky_seconds_ >= 0.0 || std::isnan(cholesky_seconds_)) return cholesky_seconds_;
  CsvTable unused(RunColumns());
  cholesky_seconds_ = std::numeric_limits<double>::quiet_NaN();
  RunSpec spec;
  spec.keep_trace = false;
  // A measure of time and no run of the experiment.
  RunRecorder* const recorder = std::exchange(recorder_, nullptr);
  const RunResult run = Run("banded_cholesky", spec, &unused);
  recorder_ = recorder;
  if (run.skipped.empty()) cholesky_seconds_ = unused.Number(0, "seconds");
  return cholesky_seconds_;
}

/// Over what the run itself started with.
double ProblemRuns::Gap(const Eigen::VectorXd& x, const RunSpec& spec) const {
  const double gap = reference_.Gap(x);
  return spec.start.size() > 0 ? gap / reference_.Gap(spec.start) : gap;
}

double ProblemRuns::MedianSeconds(const NameSpec& solver, const RunSpec& spec, double first) const {
  // The first run has found caches cold, and has kept a trace.
  std::vector<double> seconds;
  RunSpec again = spec;
  again.keep_trace = again.keep_iterates = false;
  const int repetitions = first > kLongRun ? repetitions_ - 1 : repetitions_;
  for (int k = 0; k < repetitions && !InterruptRequested(); ++k) {
    RunResult repeated;
    std::string error;
    batten::Run(*problem_, solver, again, &repeated, &error);
    seconds.push_back(repeated.seconds);
  }
  return seconds.empty() ? first : Median(seconds);
}

void ProblemRuns::Record(const std::string& solver, const RunSpec& spec, double seconds,
                         double cholesky, RunResult* result) const {
  if (recorder_ == nullptr) return;
  RecordedRun run;
  run.label = label_;
  run.problem = problem_;
  run.reference = &reference_;
  run.solver = solver;
  run.spec = spec;
  run.seconds = seconds;
  run.times_cholesky = seconds / cholesky;
  run.repetitions = repetitions_;
  recorder_->Add(run, result);
}

RunResult ProblemRuns::Run(const std::string& solver, const RunSpec& spec, CsvTable* table,
                           CsvTable* traces) {
  NameSpec name;
  std::string error;
  CHECK(ParseNameSpec(solver, &name, &error)) << error;
  RunSpec first = spec;
  const bool is_kept = recorder_ != nullptr && RunRecorder::WantsIterates(*problem_, spec);
  first.keep_iterates = spec.keep_iterates || traces != nullptr || is_kept;
  first.keep_trace = spec.keep_trace || traces != nullptr;
  RunResult result;
  CHECK(batten::Run(*problem_, name, first, &result, &error)) << error;
  const CurveFit& fit = *problem_->curve_fit();
  const std::vector<std::string> head = {label_, std::to_string(fit.parameters().size()),
                                         std::to_string(fit.basis().num_control_points()),
                                         ToString(spec.mode), solver};
  std::vector<std::string> row = head;
  if (!result.skipped.empty()) {
    row.emplace_back("skipped");
    row.resize(RunColumns().size());
    table->AddRow(row);
    Record(solver, spec, NAN, NAN, &result);
    return result;
  }
  const double median = MedianSeconds(name, spec, result.seconds);
  const double cholesky = solver == "banded_cholesky" ? median : cholesky_seconds();
  row.insert(row.end(), {ToString(result.outcome.reason), std::to_string(result.iterations),
                         std::to_string(result.counts.products + result.counts.gradient_calls),
                         NumberText(median), NumberText(median / cholesky),
                         NumberText(result.energy), NumberText(result.gradient_norm),
                         NumberText(Gap(result.x, spec)), NumberText(result.observed_rate)});
  table->AddRow(row);
  Record(solver, spec, median, cholesky, &result);
  if (traces == nullptr) return result;
  for (std::size_t k = 0; k < result.trace.size(); ++k) {
    const TraceRow& at = result.trace[k];
    traces->AddRow({label_, ToString(spec.mode), solver, std::to_string(at.iteration),
                    NumberText(at.energy), NumberText(at.gradient_norm), NumberText(at.step_norm),
                    NumberText(Gap(result.iterates[k].x, spec))});
  }
  return result;
}

RunSpec NativeSpec(double gradient) {
  RunSpec spec;
  spec.mode = Mode::kNative;
  spec.native_step = 1e-6;
  spec.native_gradient = gradient;
  return spec;
}

RunSpec RaceSpec(double tolerance) {
  RunSpec spec;
  spec.gradient_tolerance = tolerance;
  return spec;
}

std::shared_ptr<const Problem> CatalogueProblem(const std::string& name, std::string* error) {
  CatalogueEntry entry;
  if (!FindProblem(name, &entry, error)) return nullptr;
  return LoadProblem(entry, error);
}

std::shared_ptr<const Problem> CheckedFit(DataSet data, FitSpec spec) {
  std::string error;
  std::shared_ptr<const Problem> problem = MakeFitProblem(std::move(data), std::move(spec), &error);
  CHECK(problem != nullptr) << error;
  return problem;
}

std::shared_ptr<const Problem> AtParameters(const Problem& outline, const Eigen::VectorXd& t) {
  DataSet data = outline.curve_fit()->data();
  data.parameters = t;
  FitSpec spec = outline.curve_fit()->spec();
  spec.parameters.reset();
  spec.domain = {0.0, 1.0};
  return CheckedFit(std::move(data), std::move(spec));
}

std::string Rounded(double value, int decimals) {
  const double scale = std::pow(10.0, decimals);
  return NumberText(std::round(scale * value) / scale + 0.0);  // + 0.0: no negative zero
}

std::shared_ptr<const Problem> LoopProblem(int m, int n, double size) {
  constexpr double kNoise = 0.01;
  constexpr std::uint64_t kSeed = 20161201;
  const Eigen::VectorXd noise = RandomStart(2 * static_cast<Eigen::Index>(m), kSeed);
  DataSet data;
  data.name = "loop";
  data.points.resize(m, 2);
  for (int i = 0; i < m; ++i) {
    const double a = 2.0 * M_PI * i / m;
    data.points(i, 0) = std::cos(a) + 0.3 * std::cos(3.0 * a + 0.7) + kNoise * noise[2 * i];
    data.points(i, 1) = std::sin(a) + 0.2 * std::sin(2.0 * a) + kNoise * noise[2 * i + 1];
  }
  const Eigen::RowVector2d low = data.points.colwise().minCoeff();
  const Eigen::RowVector2d high = data.points.colwise().maxCoeff();
  data.points *= size / (high - low).maxCoeff();
  FitSpec spec;
  spec.name = "loop";
  spec.closed = true;
  spec.control_points = n;
  return CheckedFit(std::move(data), std::move(spec));
}

}  // namespace batten
