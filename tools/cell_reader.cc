#include "tools/cell_reader.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "problems/fit_problem.h"
#include "solvers/solver_registry.h"

namespace batten {
namespace {

/// The fields of a row; one that is missing or wrong makes all of it bad.
class RowFields {
 public:
  explicit RowFields(const std::string& line)
      : json_(nlohmann::json::parse(line, nullptr, /*allow_exceptions=*/false)),
        is_good_(json_.is_object()) {}

  bool is_good() const { return is_good_; }
  void Require(bool condition) { is_good_ = is_good_ && condition; }

  const nlohmann::json& At(const std::string& key) {
    static const nlohmann::json& none = *new nlohmann::json(nlohmann::json::value_t::discarded);
    const auto found = is_good_ ? json_.find(key) : json_.end();
    Require(found != json_.end());
    return is_good_ ? *found : none;
  }
  bool IsNull(const std::string& key) { return At(key).is_null(); }

  std::string TextOf(const nlohmann::json& value) {
    Require(value.is_string());
    std::string text = is_good_ ? value.get<std::string>() : "";
    Require(
        std::none_of(text.begin(), text.end(), [](unsigned char c) { return c < 32 || c == 127; }));
    return text;
  }
  std::string Text(const std::string& key) { return TextOf(At(key)); }

  /// null: no finite number.
  double Number(const std::string& key) {
    const nlohmann::json& value = At(key);
    Require(value.is_null() || value.is_number());
    return is_good_ && value.is_number() ? value.get<double>() : std::nan("");
  }

  /// null: 0, where a solver did not run.
  template <typename Integer>
  Integer Whole(const std::string& key, Integer highest = std::numeric_limits<Integer>::max()) {
    const nlohmann::json& value = At(key);
    if (value.is_null()) return 0;
    Require(value.is_number_unsigned() &&
            value.get<std::uint64_t>() <= static_cast<std::uint64_t>(highest));
    return is_good_ ? value.get<Integer>() : 0;
  }

  bool Flag(const std::string& key, bool if_null) {
    const nlohmann::json& value = At(key);
    Require(value.is_null() || value.is_boolean());
    return is_good_ && value.is_boolean() ? value.get<bool>() : if_null;
  }

 private:
  nlohmann::json json_;
  bool is_good_;
};

void ReadOutcome(RowFields* fields, RunResult* run) {
  const std::string stop = fields->Text("stop");
  const std::string message = fields->Text("message");
  if (stop == "skipped") {
    fields->Require(!message.empty());
    run->skipped = message;
    return;
  }
  StopReason* const reason = &run->outcome.reason;
  // A run that was interrupted or never began is no row.
  fields->Require(FromString(stop, reason) && *reason != StopReason::kNotRun &&
                  *reason != StopReason::kInterrupted && !fields->IsNull("iterations"));
  run->outcome.message = message;
}

void ReadRun(RowFields* fields, RunResult* run) {
  run->iterations = fields->Whole<int>("iterations");
  run->counts.energy_calls = fields->Whole<long>("energy_calls");
  run->counts.gradient_calls = fields->Whole<long>("gradient_calls");
  run->counts.jacobian_calls = fields->Whole<long>("jacobian_calls");
  run->counts.products = fields->Whole<long>("products");
  run->counts.projections = fields->Whole<long>("projections");
  run->counts.distinct_points = fields->Whole<long>("distinct_points");
  run->setup_seconds = fields->Number("setup_seconds");
  run->seconds = fields->Number("seconds");
  run->cpu_seconds = fields->Number("cpu_seconds");
  run->start_energy = fields->Number("start_energy");
  run->start_gradient_norm = fields->Number("start_gradient_norm");
  run->energy = fields->Number("energy");
  run->gradient_norm = fields->Number("gradient_norm");
  run->gradient_floor = fields->Number("gradient_floor");
  run->line_search_floor = fields->Number("line_search_floor");
  run->observed_rate = fields->Number("observed_rate");
  OptionValues options;
  std::string ignored;
  fields->Require(SolverRegistry::Global().Make(run->solver, &options, &ignored) != nullptr);
  run->options = options.ToText();
  fields->Require(fields->At("options") == nlohmann::json(run->options));
  fields->Require(fields->At("notes").is_array());
  for (const nlohmann::json& note : fields->At("notes")) {
    fields->Require(note.is_object() && note.contains("name") && note.contains("value"));
    if (!fields->is_good()) return;
    run->notes.emplace_back(fields->TextOf(note["name"]), fields->TextOf(note["value"]));
  }
}

void ReadReport(RowFields* fields, FitReport* report) {
  report->rms = fields->Number("rms");
  report->max = fields->Number("max");
  report->rms_orthogonal = fields->Number("rms_orthogonal");
  report->max_orthogonal = fields->Number("max_orthogonal");
  report->energy_at_foot_points = fields->Number("energy_at_foot_points");
  if (!fields->IsNull("num_free_loops")) {
    CurveShape shape;
    shape.length = fields->Number("length");
    shape.turning = fields->Number("turning");
    shape.num_free_loops = fields->Whole<int>("num_free_loops");
    report->shape = shape;
  }
  report->audited = !fields->IsNull("verified");
  report->verdict.holds = fields->Flag("verified", false);
  report->verdict.failure = fields->Text("failure");
  // The sentence is there exactly where the claim does not hold.
  fields->Require(report->verdict.failure.empty() == (!report->audited || report->verdict.holds));
  report->audit.energy = fields->Number("audit_energy");
  report->audit.gradient_norm = fields->Number("audit_gradient_norm");
  report->audit.covers_gradient =
      fields->IsNull("audit_energy") || !fields->IsNull("audit_gradient_norm");
}

}  // namespace

bool ReadCell(const std::string& line, const std::string& problem, const NameSpec& solver,
              const ComparisonSpec& spec, Cell* cell) {
  RowFields fields(line);
  *cell = Cell();
  ComparisonRow* const row = &cell->row;
  row->problem = problem;
  row->solver = solver.ToString();
  row->run.solver = solver;
  fields.Require(fields.Text("format") == "batten.cell/1");
  fields.Require(fields.Text("problem") == row->problem && fields.Text("solver") == row->solver);
  ReadOutcome(&fields, &row->run);
  ReadRun(&fields, &row->run);
  ReadReport(&fields, &row->report);
  row->setup_seconds = row->run.setup_seconds;
  row->solve_seconds = fields.Number("solve_seconds");
  row->seconds = row->run.seconds;
  row->repetitions = fields.Whole<int>("repetitions", spec.repetitions);
  row->times_cholesky = fields.Number("times_cholesky");
  row->gap = fields.Number("gap");
  row->distance_to_direct = fields.Number("distance_to_direct");
  row->allowed_distance = fields.Number("allowed_distance");
  row->unique_minimum = fields.Flag("unique_minimum", true);
  fields.Require(FromString(fields.Text("parameter_kind"), &row->parameter_kind));
  if (!fields.IsNull("basin")) row->basin = fields.Whole<int>("basin");
  cell->minimum_energy = fields.Number("minimum_energy");
  if (!fields.IsNull("disagreement")) {
    cell->disagreement = fields.Text("disagreement");
    fields.Require(cell->disagreement.rfind(problem + ": " + row->solver + " ", 0) == 0);
  }
  return fields.is_good();
}

}  // namespace batten
