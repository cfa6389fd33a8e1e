#include "tools/comparison_cells.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "experiments/comparison_tables.h"
#include "experiments/content_hash.h"
#include "problems/input_file.h"
#include "solvers/plugin_loader.h"
#include "tools/cell_reader.h"

namespace batten {
namespace {

using Json = nlohmann::ordered_json;

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
  ContentHash hash;
  hash.Add(ProgramDigits());
  hash.Add(FileDigits(entry.path));
  hash.Add(FileDigits(entry.data_path));
  const RunSpec& run = spec.run;
  std::ostringstream text;
  text << entry.name << ' ' << solver.ToString() << ' ' << ToString(run.mode) << ' '
       << NumberText(run.gradient_tolerance) << ' ' << run.max_iterations << ' '
       << NumberText(run.max_seconds) << ' ' << NumberText(run.native_step) << ' '
       << NumberText(run.native_gradient) << ' ' << run.seed << ' ' << run.threads << ' '
       << run.compile << ' ' << spec.repetitions;
  // Any of them may be what the problem, its terms or the solver come from.
  for (const LoadedPlugin& plugin : LoadedPlugins()) text << ' ' << plugin.sha256;
  hash.Add(text.str());
  return hash.Digits();
}

void ComparisonCells::Read() {
  std::ifstream file(path_);
  LineReader reader(&file);
  for (std::string_view line; reader.Next(&line);) {
    const Json json = Json::parse(line, nullptr, /*allow_exceptions=*/false);
    const auto text_at = [&json](const char* key) {
      const bool is_there = json.is_object() && json.contains(key) && json[key].is_string();
      return is_there ? json[key].get<std::string>() : "";
    };
    if (text_at("key").empty()) continue;
    Put({text_at("key"), text_at("problem"), std::string(line)});
  }
}

bool ComparisonCells::AreLast(const CatalogueEntry& entry, const ComparisonSpec& spec) const {
  std::size_t missing = spec.solvers.size();
  for (auto line = lines_.rbegin(); line != lines_.rend() && missing > 0; ++line) {
    if (line->problem != entry.name) continue;
    --missing;
    if (line->key != CellKey(entry, spec.solvers[missing], spec)) return false;
  }
  return missing == 0;
}

bool ComparisonCells::Find(const CatalogueEntry& entry, const ComparisonSpec& spec,
                           ComparisonResult* result) const {
  std::vector<ComparisonRow> rows;
  std::vector<std::string> disagreements;
  double minimum_energy = std::nan("");
  for (const NameSpec& solver : spec.solvers) {
    const Line* const line = FindLine(CellKey(entry, solver, spec));
    Cell cell;
    if (line == nullptr || !ReadCell(line->text, entry.name, solver, spec, &cell)) return false;
    rows.push_back(std::move(cell.row));
    if (!cell.disagreement.empty()) disagreements.push_back(cell.disagreement);
    if (!std::isnan(cell.minimum_energy)) minimum_energy = cell.minimum_energy;
  }
  result->rows = std::move(rows);
  result->disagreements = std::move(disagreements);
  result->minimum_energies = {minimum_energy};
  return true;
}

bool ComparisonCells::Append(const CatalogueEntry& entry, const ComparisonResult& result,
                             FileBatch* batch, std::string* error) {
  std::istringstream rows(ComparisonJsonLines(result));
  size_t index = 0;
  for (std::string row; std::getline(rows, row); ++index) {
    Json json = Json::parse(row);
    const std::string key = CellKey(entry, result.spec.solvers.at(index), result.spec);
    json["key"] = key;
    json["disagreement"] =
        DisagreementOf(result.rows[index].problem, result.rows[index].solver, result.disagreements);
    Put({key, entry.name, json.dump()});
  }
  std::string text;
  for (const Line& line : lines_) text += line.text + "\n";
  return batch->Write(path_, text, error) != nullptr;
}

const ComparisonCells::Line* ComparisonCells::FindLine(const std::string& key) const {
  const auto found = std::find_if(lines_.begin(), lines_.end(),
                                  [&key](const Line& line) { return line.key == key; });
  return found == lines_.end() ? nullptr : &*found;
}

void ComparisonCells::Put(Line line) {
  const auto has_key = [&line](const Line& other) { return other.key == line.key; };
  lines_.erase(std::remove_if(lines_.begin(), lines_.end(), has_key), lines_.end());
  lines_.push_back(std::move(line));
}

}  // namespace batten
