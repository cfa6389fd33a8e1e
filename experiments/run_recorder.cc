#include "experiments/run_recorder.h"

#include <algorithm>
#include <filesystem>

#include "cost_functions/options.h"
#include "experiments/atomic_file.h"
#include "experiments/comparison.h"
#include "experiments/comparison_records.h"
#include "experiments/curve_records.h"
#include "experiments/kept_rows.h"
#include "experiments/report_cells.h"

namespace batten {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostTraceRows = 500;
constexpr std::size_t kMostIterates = 20;
// To measure and audit the end of a run on more data points takes longer than the run.
constexpr Eigen::Index kMostMeasured = 200'000;

/// The conditions under which runs are one comparison.
std::string RuleText(const RunSpec& spec) {
  const RunSpec usual;
  std::string text = ToString(spec.mode);
  text += spec.mode == Mode::kRace ? " " + NumberText(spec.gradient_tolerance)
                                   : " |g| " + NumberText(spec.native_gradient);
  if (spec.max_iterations != usual.max_iterations) {
    text += ", at most " + std::to_string(spec.max_iterations) + " iterations";
  }
  if (!spec.compile) text += ", not compiled";
  if (spec.start.size() > 0) text += ", warm start";
  return text;
}

FitReport NotMeasured() {
  FitReport report;
  report.rms = report.max = report.rms_orthogonal = report.max_orthogonal =
      report.energy_at_foot_points = NAN;
  return report;
}

bool IsMeasured(const Problem& problem) {
  const CurveFit* const fit = problem.curve_fit();
  return fit == nullptr || fit->data().points.rows() <= kMostMeasured;
}

/// The audit knows the constraints of a fit's specification. Those that an experiment has put on
/// the problem itself it does not, and would refute whoever keeps them.
bool AuditKnowsConstraints(const Problem& problem) {
  const CurveFit* const fit = problem.curve_fit();
  const bool has_own =
      fit != nullptr && (!fit->spec().constraints.empty() || fit->spec().hold_ends);
  return has_own || problem.elimination().trivial();
}

void MeasureRecorded(const RecordedRun& run, ComparisonRow* row) {
  if (IsMeasured(*run.problem)) {
    MeasureEnd(*run.problem, *run.reference, run.spec, row);
    if (AuditKnowsConstraints(*run.problem)) return;
    row->report.audited = false;
    row->report.verdict = Verdict();
    return;
  }
  row->parameter_kind = run.problem->curve_fit()->spec().parameter_kind;
  row->unique_minimum = run.reference->unique();
  row->gap = run.reference->Gap(row->run.x);
  row->distance_to_direct = row->allowed_distance = NAN;
  row->report = NotMeasured();
}

std::string ThinnedTrace(const Problem& problem, const std::vector<TraceRow>& trace) {
  RunResult kept;
  for (const std::size_t k : KeptRows(trace.size(), kMostTraceRows)) kept.trace.push_back(trace[k]);
  return RunTraceCsv(problem, kept);
}

std::string FourDigits(std::size_t number) {
  const std::string digits = std::to_string(number);
  return std::string(4 - std::min<std::size_t>(4, digits.size()), '0') + digits;
}

/// The rows of other experiments; none where there is no file.
std::vector<std::string> RowsOfOthers(const std::string& path, const std::string& experiment) {
  std::vector<std::string> rows;
  std::string unused;
  const auto take = [&](std::string_view line, long /*number*/, bool /*is_torn*/) {
    const OrderedJson row = OrderedJson::parse(line, nullptr, /*allow_exceptions=*/false);
    if (row.is_object() && TextField(row, "experiment") != experiment) rows.emplace_back(line);
    return true;
  };
  std::error_code ignored;
  if (fs::exists(path, ignored)) ReadLines(path, take, &unused);
  return rows;
}

}  // namespace

bool RunRecorder::WantsIterates(const Problem& problem, const RunSpec& spec) {
  const CurveFit* const fit = problem.curve_fit();
  return spec.keep_trace && fit != nullptr &&
         fit->basis().num_control_points() * fit->dimension() <= kMostCoordinates;
}

/// Of the problem and the rule: E* and profiles are those of runs with one name.
std::string RunRecorder::NameOf(const RecordedRun& run) {
  std::string& known = names_[run.problem];
  if (known.empty()) {
    known = experiment_ + ": " + run.label;
    if (const CurveFit* const fit = run.problem->curve_fit()) {
      known += ", " + std::to_string(fit->data().points.rows()) + " points, " +
               std::to_string(fit->basis().num_control_points()) + " control points";
    }
    const int number = ++num_named_[known];
    if (number > 1) known += ", no. " + std::to_string(number);
  }
  const std::string name = known + ", " + RuleText(run.spec);
  const int time = ++num_named_[name + "\n" + run.solver];
  return time > 1 ? name + ", run " + std::to_string(time) : name;
}

std::string RunRecorder::InstanceOf(const RecordedRun& run) {
  std::string& instance = instances_[run.problem];
  if (instance.empty()) {
    instance = experiment_ + "-" + FourDigits(instances_.size());
    files_["curves/" + instance + ".json"] = CurveJson(*run.problem->curve_fit());
  }
  return instance;
}

void RunRecorder::AddIterates(const std::string& key, const RecordedRun& run,
                              const RunResult& result) {
  std::string lines;
  for (const std::size_t k : KeptRows(result.iterates.size(), kMostIterates)) {
    lines += ControlPointsJsonLine(*run.problem->curve_fit(), result.iterates[k]);
  }
  files_["iterates/" + key + ".jsonl"] = lines;
}

void RunRecorder::Add(const RecordedRun& run, RunResult* result) {
  const std::string key = experiment_ + "-" + FourDigits(rows_.size() + 1);
  ComparisonRow row;
  row.problem = NameOf(run);
  row.solver = run.solver;
  row.seconds = run.seconds;
  row.setup_seconds = run.setup_seconds;
  row.solve_seconds = run.seconds - run.setup_seconds;
  row.times_cholesky = run.times_cholesky;
  row.repetitions = run.repetitions;
  row.run = std::move(*result);  // with its iterates, which may be large
  MeasureRecorded(run, &row);
  OrderedJson json = CellJson(row, run.reference->minimum_energy(), run.spec);
  const std::string disagreement =
      IsMeasured(*run.problem) ? Disagreement(*run.reference, run.spec, row) : "";
  json["disagreement"] = disagreement.empty() ? OrderedJson() : OrderedJson(disagreement);
  json["experiment"] = experiment_;
  json["key"] = key;
  // Of a run without them older files go.
  files_["traces/" + key + ".csv"] =
      row.run.trace.empty() ? "" : ThinnedTrace(*run.problem, row.run.trace);
  files_["iterates/" + key + ".jsonl"] = "";
  if (!row.run.iterates.empty() && WantsIterates(*run.problem, run.spec)) {
    AddIterates(key, run, row.run);
    json["instance"] = InstanceOf(run);
  }
  rows_.push_back(DumpJson(json, -1));
  *result = std::move(row.run);
}

bool RunRecorder::Commit(std::string* error) const {
  const auto path = [this](const std::string& name) { return (fs::path(folder_) / name).string(); };
  std::error_code ignored;
  if (rows_.empty() && !fs::exists(path("cells.jsonl"), ignored)) return true;
  for (const char* folder : {"traces", "iterates", "curves"}) {
    if (!rows_.empty() && !CreateDirectories(path(folder), error)) return false;
  }
  for (const auto& [name, text] : files_) {
    if (text.empty()) {
      fs::remove(path(name), ignored);
    } else if (!WriteFileAtomically(path(name), text, error)) {
      return false;
    }
  }
  std::string text;
  for (const std::string& row : RowsOfOthers(path("cells.jsonl"), experiment_)) text += row + "\n";
  for (const std::string& row : rows_) text += row + "\n";
  return WriteFileAtomically(path("cells.jsonl"), text, error);
}

}  // namespace batten
