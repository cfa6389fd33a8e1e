#include "tools/comparison_cells.h"

#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "experiments/atomic_file.h"
#include "experiments/comparison_tables.h"

namespace batten {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint64_t kHashBasis = 14695981039346656037ULL;

std::uint64_t Hash(const char* bytes, size_t count, std::uint64_t hash) {
  for (size_t i = 0; i < count; ++i) {  // FNV-1a
    hash = (hash ^ static_cast<unsigned char>(bytes[i])) * 1099511628211ULL;
  }
  return hash;
}

std::uint64_t HashFile(const std::string& path, std::uint64_t hash) {
  std::ifstream file(path, std::ios::binary);
  std::vector<char> bytes(1 << 16);
  while (file.good()) {
    file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    hash = Hash(bytes.data(), static_cast<size_t>(file.gcount()), hash);
  }
  return hash;
}

double Number(const Json& json, const char* key) {
  const Json& value = json.at(key);
  return value.is_null() ? std::nan("") : value.get<double>();
}

template <typename Integer>
Integer Whole(const Json& json, const char* key) {
  const Json& value = json.at(key);
  return value.is_null() ? Integer{0} : value.get<Integer>();
}

void ReadRun(const Json& json, RunResult* run) {
  run->iterations = Whole<int>(json, "iterations");
  run->counts.energy_calls = Whole<long>(json, "energy_calls");
  run->counts.gradient_calls = Whole<long>(json, "gradient_calls");
  run->counts.jacobian_calls = Whole<long>(json, "jacobian_calls");
  run->counts.products = Whole<long>(json, "products");
  run->counts.projections = Whole<long>(json, "projections");
  run->counts.distinct_points = Whole<long>(json, "distinct_points");
  run->cpu_seconds = Number(json, "cpu_seconds");
  run->start_energy = Number(json, "start_energy");
  run->start_gradient_norm = Number(json, "start_gradient_norm");
  run->energy = Number(json, "energy");
  run->gradient_norm = Number(json, "gradient_norm");
  run->gradient_floor = Number(json, "gradient_floor");
  run->observed_rate = Number(json, "observed_rate");
  for (const auto& [name, value] : json.at("options").items()) {
    run->options[name] = value.get<std::string>();
  }
  for (const Json& note : json.at("notes")) {
    run->notes.emplace_back(note.at("name").get<std::string>(),
                            note.at("value").get<std::string>());
  }
}

void ReadReport(const Json& json, FitReport* report) {
  report->rms = Number(json, "rms");
  report->max = Number(json, "max");
  report->rms_orthogonal = Number(json, "rms_orthogonal");
  report->max_orthogonal = Number(json, "max_orthogonal");
  report->audited = !json.at("verified").is_null();
  report->verdict.holds = report->audited && json.at("verified").get<bool>();
  report->verdict.failure = json.at("failure").get<std::string>();
  report->audit.energy = Number(json, "audit_energy");
  report->audit.gradient_norm = Number(json, "audit_gradient_norm");
}

/// The row that ComparisonJsonLines wrote, without its trace and end. Throws what nlohmann throws
/// at a line that is no such row.
ComparisonRow ReadRow(const Json& json) {
  ComparisonRow row;
  row.problem = json.at("problem").get<std::string>();
  row.solver = json.at("solver").get<std::string>();
  std::string ignored;
  ParseNameSpec(row.solver, &row.run.solver, &ignored);
  const auto stop = json.at("stop").get<std::string>();
  const auto message = json.at("message").get<std::string>();
  if (stop == "skipped") {
    row.run.skipped = message;
  } else {
    FromString(stop, &row.run.outcome.reason);
    row.run.outcome.message = message;
  }
  ReadRun(json, &row.run);
  ReadReport(json, &row.report);
  row.setup_seconds = row.run.setup_seconds = Number(json, "setup_seconds");
  row.solve_seconds = Number(json, "solve_seconds");
  row.seconds = row.run.seconds = Number(json, "seconds");
  row.repetitions = Whole<int>(json, "repetitions");
  row.times_cholesky = Number(json, "times_cholesky");
  row.gap = Number(json, "gap");
  row.distance_to_direct = Number(json, "distance_to_direct");
  row.allowed_distance = Number(json, "allowed_distance");
  row.unique_minimum = json.at("unique_minimum").is_null() || json.at("unique_minimum").get<bool>();
  return row;
}

/// The sentence about this row; null if solvers agree.
Json DisagreementOf(const std::string& problem, const std::string& solver,
                    const std::vector<std::string>& disagreements) {
  const std::string begin = problem + ": " + solver + " ";
  for (const std::string& sentence : disagreements) {
    if (sentence.compare(0, begin.size(), begin) == 0) return sentence;
  }
  return nullptr;
}

}  // namespace

std::string CellKey(const CatalogueEntry& entry, const NameSpec& solver,
                    const ComparisonSpec& spec) {
  static const std::uint64_t program = HashFile("/proc/self/exe", kHashBasis);
  const std::uint64_t files = HashFile(entry.data_path, HashFile(entry.path, program));
  const RunSpec& run = spec.run;
  std::ostringstream text;
  text << entry.name << ' ' << solver.ToString() << ' ' << ToString(run.mode) << ' '
       << NumberText(run.gradient_tolerance) << ' ' << run.max_iterations << ' '
       << NumberText(run.max_seconds) << ' ' << NumberText(run.native_step) << ' '
       << NumberText(run.native_gradient) << ' ' << run.seed << ' ' << run.threads << ' '
       << run.compile << ' ' << spec.repetitions;
  char digits[17];
  std::snprintf(digits, sizeof(digits), "%016llx",
                static_cast<unsigned long long>(Hash(text.str().data(), text.str().size(), files)));
  return digits;
}

void ComparisonCells::Read() {
  std::ifstream file(path_);
  for (std::string line; std::getline(file, line);) {
    const Json json = Json::parse(line, nullptr, /*allow_exceptions=*/false);
    if (!json.is_object() || !json.contains("key") || !json["key"].is_string()) continue;
    Put(json["key"].get<std::string>(), line);
  }
}

bool ComparisonCells::Find(const CatalogueEntry& entry, const ComparisonSpec& spec,
                           ComparisonResult* result) const {
  std::vector<ComparisonRow> rows;
  std::vector<std::string> disagreements;
  double minimum_energy = std::nan("");
  for (const NameSpec& solver : spec.solvers) {
    const auto line = line_of_key_.find(CellKey(entry, solver, spec));
    if (line == line_of_key_.end()) return false;
    try {
      const Json json = Json::parse(line->second);
      rows.push_back(ReadRow(json));
      if (json.at("disagreement").is_string()) disagreements.push_back(json["disagreement"]);
      if (!json.at("minimum_energy").is_null()) minimum_energy = json["minimum_energy"];
    } catch (const Json::exception&) {
      return false;  // somebody edited the file: the row is computed again
    }
  }
  result->rows = std::move(rows);
  result->disagreements = std::move(disagreements);
  result->minimum_energies = {minimum_energy};
  return true;
}

bool ComparisonCells::Append(const CatalogueEntry& entry, const ComparisonResult& result,
                             std::string* error) {
  std::istringstream rows(ComparisonJsonLines(result));
  size_t index = 0;
  for (std::string row; std::getline(rows, row); ++index) {
    Json json = Json::parse(row);
    const std::string key = CellKey(entry, result.spec.solvers.at(index), result.spec);
    json["key"] = key;
    json["disagreement"] =
        DisagreementOf(result.rows[index].problem, result.rows[index].solver, result.disagreements);
    Put(key, json.dump());
  }
  std::string text;
  for (const std::string& key : keys_) text += line_of_key_.at(key) + "\n";
  return WriteFileAtomically(path_, text, error);
}

void ComparisonCells::Put(const std::string& key, const std::string& line) {
  if (line_of_key_.emplace(key, line).second) {
    keys_.push_back(key);
  } else {
    line_of_key_[key] = line;
  }
}

}  // namespace batten
