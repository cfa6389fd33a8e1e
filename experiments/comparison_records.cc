#include "experiments/comparison_records.h"

#include <cmath>

#include "cost_functions/options.h"
#include "experiments/build_info.h"
#include "experiments/comparison_tables.h"
#include "problems/fit_problem.h"
#include "solvers/plugin_loader.h"

namespace batten {
namespace {

using Json = nlohmann::ordered_json;  // writes NaN and infinity as null

void AddOutcome(const ComparisonRow& row, Json* json) {
  const RunResult& run = row.run;
  const bool ran = run.skipped.empty();
  (*json)["problem"] = row.problem;
  (*json)["solver"] = row.solver;
  (*json)["stop"] = ran ? Json(ToString(run.outcome.reason)) : Json("skipped");
  (*json)["message"] = ran ? run.outcome.message : run.skipped;
  (*json)["verified"] = nullptr;
  if (row.report.audited) (*json)["verified"] = row.report.verdict.holds;
  (*json)["failure"] = row.report.verdict.failure;
  (*json)["parameter_kind"] = ToString(row.parameter_kind);
}

void AddEffort(const ComparisonRow& row, Json* json) {
  const Counts& counts = row.run.counts;
  (*json)["iterations"] = row.run.iterations;
  (*json)["energy_calls"] = counts.energy_calls;
  (*json)["gradient_calls"] = counts.gradient_calls;
  (*json)["jacobian_calls"] = counts.jacobian_calls;
  (*json)["products"] = counts.products;
  (*json)["projections"] = counts.projections;
  (*json)["distinct_points"] = counts.distinct_points;
  (*json)["repetitions"] = row.repetitions;
  (*json)["setup_seconds"] = row.setup_seconds;
  (*json)["solve_seconds"] = row.solve_seconds;
  (*json)["seconds"] = row.seconds;
  (*json)["cpu_seconds"] = row.run.cpu_seconds;
  (*json)["times_cholesky"] = row.times_cholesky;
}

void AddShape(const ComparisonRow& row, Json* json) {
  (*json)["energy_at_foot_points"] = row.report.energy_at_foot_points;
  (*json)["basin"] = row.basin.has_value() ? Json(*row.basin) : Json(nullptr);
  const std::optional<CurveShape>& shape = row.report.shape;
  (*json)["length"] = shape.has_value() ? Json(shape->length) : Json(nullptr);
  (*json)["turning"] = shape.has_value() ? Json(shape->turning) : Json(nullptr);
  (*json)["num_free_loops"] = shape.has_value() ? Json(shape->num_free_loops) : Json(nullptr);
}

void AddAccuracy(const ComparisonRow& row, double minimum_energy, Json* json) {
  const RunResult& run = row.run;
  (*json)["start_energy"] = run.start_energy;
  (*json)["start_gradient_norm"] = run.start_gradient_norm;
  (*json)["energy"] = run.energy;
  (*json)["gradient_norm"] = run.gradient_norm;
  (*json)["gradient_floor"] = run.gradient_floor;
  (*json)["line_search_floor"] = run.line_search_floor;
  (*json)["minimum_energy"] = minimum_energy;
  (*json)["gap"] = row.gap;
  (*json)["distance_to_direct"] = row.distance_to_direct;
  (*json)["allowed_distance"] = row.allowed_distance;
  (*json)["unique_minimum"] = row.unique_minimum;
  (*json)["observed_rate"] = run.observed_rate;
  (*json)["rms"] = row.report.rms;
  (*json)["max"] = row.report.max;
  (*json)["rms_orthogonal"] = row.report.rms_orthogonal;
  (*json)["max_orthogonal"] = row.report.max_orthogonal;
  AddShape(row, json);
  const double nan = std::nan("");
  (*json)["audit_energy"] = row.report.audited ? row.report.audit.energy : nan;
  (*json)["audit_gradient_norm"] = row.report.audited ? row.report.audit.gradient_norm : nan;
}

/// Where a solver did not run there is no effort and no accuracy.
void ClearNumbers(std::size_t first, Json* json) {
  std::size_t index = 0;
  for (auto& [key, value] : json->items()) {
    if (index++ >= first) value = nullptr;
  }
}

void AddConditions(const RunSpec& spec, Json* json) {
  (*json)["mode"] = ToString(spec.mode);
  (*json)["gradient_tolerance"] = spec.gradient_tolerance;
  (*json)["max_iterations"] = spec.max_iterations;
  (*json)["max_seconds"] = spec.max_seconds;
  (*json)["native_step"] = spec.native_step;
  (*json)["native_gradient"] = spec.native_gradient;
  (*json)["seed"] = spec.seed;
  (*json)["threads"] = spec.threads;
  (*json)["compile"] = spec.compile;
}

void AddBuild(Json* json) {
  (*json)["version"] = kVersion;
  (*json)["commit"] = kGitCommit;
  for (const LoadedPlugin& plugin : LoadedPlugins()) {
    (*json)["plugins"][plugin.path] = plugin.sha256;
  }
  (*json)["compiler"] = kCompiler;
  (*json)["flags"] = kFlags;
}

Json RowJson(const ComparisonResult& result, const ComparisonRow& row) {
  const auto index = static_cast<std::size_t>(row.problem_index);
  const auto& minima = result.minimum_energies;
  return CellJson(row, index < minima.size() ? minima[index] : std::nan(""), result.spec.run);
}

/// RFC 4180.
std::string CsvField(const Json& value) {
  if (value.is_null()) return "";
  std::string text;
  if (value.is_number_float()) {
    if (!std::isfinite(value.get<double>())) return "";
    text = NumberText(value.get<double>());
  } else if (value.is_string()) {
    text = value.get<std::string>();
  } else if (value.is_object()) {
    for (const auto& [key, entry] : value.items()) {
      text += (text.empty() ? "" : " ") + key + "=" + entry.get<std::string>();
    }
  } else if (value.is_array()) {
    for (const Json& note : value) {
      text += (text.empty() ? "" : "; ") + note["name"].get<std::string>() + ": " +
              note["value"].get<std::string>();
    }
  } else {
    text = value.dump();
  }
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

}  // namespace

Json CellJson(const ComparisonRow& row, double minimum_energy, const RunSpec& spec) {
  Json json;
  json["format"] = "batten.cell/1";
  AddOutcome(row, &json);
  const std::size_t num_words = json.size();
  AddEffort(row, &json);
  AddAccuracy(row, minimum_energy, &json);
  if (!row.run.skipped.empty()) ClearNumbers(num_words, &json);
  AddConditions(spec, &json);
  json["options"] = row.run.options;
  json["notes"] = Json::array();
  for (const auto& [name, value] : row.run.notes) {
    json["notes"].push_back({{"name", name}, {"value", value}});
  }
  AddBuild(&json);
  return json;
}

std::string DumpJson(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

std::string ComparisonCsv(const ComparisonResult& result) {
  std::string header;
  std::string lines;
  const Json names = RowJson(result, ComparisonRow());
  for (const auto& [key, value] : names.items()) {
    header += (header.empty() ? "" : ",") + key;
  }
  for (const ComparisonRow& row : result.rows) {
    std::string line;
    const Json json = RowJson(result, row);
    for (const auto& [key, value] : json.items()) {
      line += (key == "format" ? "" : ",") + CsvField(value);
    }
    lines += line + "\n";
  }
  return header + "\n" + lines;
}

std::string ComparisonJson(const ComparisonResult& result) {
  Json json;
  json["format"] = "batten.comparison/1";
  json["problems"] = result.spec.problems;
  json["solvers"] = Json::array();
  for (const NameSpec& solver : result.spec.solvers) json["solvers"].push_back(solver.ToString());
  json["repetitions"] = result.spec.repetitions;
  AddConditions(result.spec.run, &json);
  AddBuild(&json);
  json["rows"] = Json::array();
  for (const ComparisonRow& row : result.rows) json["rows"].push_back(RowJson(result, row));
  json["disagreements"] = result.disagreements;
  json["interrupted"] = result.interrupted;
  return DumpJson(json, 1) + "\n";
}

std::string ComparisonJsonLines(const ComparisonResult& result) {
  std::string lines;
  for (const ComparisonRow& row : result.rows) lines += DumpJson(RowJson(result, row), -1) + "\n";
  return lines;
}

bool SomeClaimFailed(const ComparisonResult& result) {
  for (const ComparisonRow& row : result.rows) {
    if (row.report.audited && !row.report.verdict.holds) return true;
  }
  return false;
}

}  // namespace batten
