#include "experiments/bench_data.h"

#include <algorithm>
#include <cmath>
#include <fstream>

#include "problems/input_file.h"
#include "problems/strict_json.h"

namespace batten {
namespace {

const nlohmann::json* Find(const nlohmann::json& row, const char* key) {
  const auto found = row.is_object() ? row.find(key) : row.end();
  return found == row.end() ? nullptr : &*found;
}

/// Objects of a file of lines by their "key", of those with one key the last.
std::map<std::string, nlohmann::json> ReadLines(const std::string& path) {
  std::map<std::string, nlohmann::json> lines;
  std::ifstream file(path, std::ios::binary);
  LineReader reader(&file);
  for (std::string_view line; reader.Next(&line);) {
    nlohmann::json json = nlohmann::json::parse(line, nullptr, /*allow_exceptions=*/false);
    std::string key = TextAt(json, "key");
    if (!key.empty()) lines[std::move(key)] = std::move(json);
  }
  return lines;
}

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
  std::map<std::string, nlohmann::json> rows = ReadLines(folder + "/cells.jsonl");
  data->instances = ReadLines(folder + "/instances.jsonl");
  for (const std::string& key : TextsAt(data->manifest, "cells")) {
    ++data->num_cells;
    const auto found = rows.find(key);
    if (found != rows.end()) data->rows.push_back(std::move(found->second));
  }
  return true;
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
