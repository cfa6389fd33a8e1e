#include "experiments/bench_data.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>

#include "cost_functions/options.h"
#include "problems/strict_json.h"

namespace batten {
namespace {

const nlohmann::json* Find(const nlohmann::json& row, const char* key) {
  const auto found = row.is_object() ? row.find(key) : row.end();
  return found == row.end() ? nullptr : &*found;
}

/// Objects of a file of lines by their "key", of those with one key the last. Lines that are none,
/// but for a torn last one, are said in `bad_lines`.
std::map<std::string, nlohmann::json> ReadLines(
    const std::string& path, const std::function<bool(const nlohmann::json&)>& is_good,
    std::vector<std::string>* bad_lines) {
  constexpr std::size_t kMostShown = 40;
  std::map<std::string, nlohmann::json> lines;
  std::ifstream file(path, std::ios::binary);
  long number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    nlohmann::json json = nlohmann::json::parse(line, nullptr, /*allow_exceptions=*/false);
    if (is_good(json)) {
      std::string key = TextAt(json, "key");
      lines[std::move(key)] = std::move(json);
    } else if (!file.eof() && !line.empty()) {
      bad_lines->push_back(path + ":" + std::to_string(number) + ": found " +
                           Quoted(line, kMostShown) +
                           "; allowed: a row as bench writes it; it counts as not finished");
    }
  }
  return lines;
}

bool HasKey(const nlohmann::json& json) { return !TextAt(json, "key").empty(); }

}  // namespace

bool ReadBenchData(const std::string& folder, BenchData* data, std::string* error) {
  *data = BenchData();
  data->folder = folder;
  if (!ReadJsonFile(folder + "/manifest.json", &data->manifest, error)) return false;
  if (TextAt(data->manifest, "format") != "batten.manifest/1") {
    *error = folder + "/manifest.json: found format \"" + TextAt(data->manifest, "format") +
             "\"; allowed: batten.manifest/1, as batten bench writes it";
    return false;
  }
  std::map<std::string, nlohmann::json> rows =
      ReadLines(folder + "/cells.jsonl", &IsFinishedRow, &data->bad_lines);
  data->instances = ReadLines(folder + "/instances.jsonl", &HasKey, &data->bad_lines);
  for (const std::string& key : TextsAt(data->manifest, "cells")) {
    ++data->num_cells;
    const auto found = rows.find(key);
    if (found != rows.end()) data->rows.push_back(std::move(found->second));
  }
  return true;
}

bool IsFinishedRow(const nlohmann::json& row) {
  return HasKey(row) && TextAt(row, "format") == "batten.cell/1" && !TextAt(row, "stop").empty();
}

bool IsMeasured(const nlohmann::json& instance) {
  return Find(instance, "failure") == nullptr && !FlagAt(instance, "overlapped");
}

double NumberAt(const nlohmann::json& row, const char* key) {
  const nlohmann::json* const value = Find(row, key);
  return value != nullptr && value->is_number() ? value->get<double>() : std::nan("");
}

std::string TextAt(const nlohmann::json& row, const char* key) {
  const nlohmann::json* const value = Find(row, key);
  return value != nullptr && value->is_string() ? value->get<std::string>() : "";
}

bool FlagAt(const nlohmann::json& row, const char* key) {
  const nlohmann::json* const value = Find(row, key);
  return value != nullptr && value->is_boolean() && value->get<bool>();
}

std::vector<std::string> TextsAt(const nlohmann::json& row, const char* key) {
  std::vector<std::string> texts;
  const nlohmann::json* const value = Find(row, key);
  if (value == nullptr || !value->is_array()) return texts;
  for (const nlohmann::json& entry : *value) {
    if (entry.is_string()) texts.push_back(entry.get<std::string>());
  }
  return texts;
}

bool HasFinding(const nlohmann::json& row, const char* finding) {
  const std::vector<std::string> findings = TextsAt(row, "findings");
  return std::find(findings.begin(), findings.end(), finding) != findings.end();
}

std::vector<double> NumbersAt(const nlohmann::json& row, const char* key) {
  std::vector<double> numbers;
  const nlohmann::json* const value = Find(row, key);
  if (value == nullptr || !value->is_array()) return numbers;
  for (const nlohmann::json& entry : *value) {
    if (entry.is_number()) numbers.push_back(entry.get<double>());
  }
  return numbers;
}

}  // namespace batten
