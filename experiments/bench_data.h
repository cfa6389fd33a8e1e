#ifndef BATTEN_EXPERIMENTS_BENCH_DATA_H_
#define BATTEN_EXPERIMENTS_BENCH_DATA_H_

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace batten {

/// A folder of `bench` or `merge`, read back.
struct BenchData {
  std::string folder;
  nlohmann::json manifest;
  std::vector<nlohmann::json> rows;  // of the manifest's cells, in its order, as far as finished
  std::map<std::string, nlohmann::json> instances;  // by key
  std::size_t num_cells = 0;                        // that there are to be
  std::vector<std::string> bad_lines;  // one sentence each, FILE:LINE first, of what was left out
};

/// Whether a line of cells.jsonl says how its cell ended.
bool IsFinishedRow(const nlohmann::json& row);

/// Whether a line of instances.jsonl stands: not where its process failed, or another program
/// measured at the same time.
bool IsMeasured(const nlohmann::json& instance);

/// False with one sentence in `error` for a folder without results of this format.
bool ReadBenchData(const std::string& folder, BenchData* data, std::string* error);

// Fields of rows, which somebody may have edited: what has another type is as if it were not there.

/// NaN where there is no number.
double NumberAt(const nlohmann::json& row, const char* key);
std::string TextAt(const nlohmann::json& row, const char* key);
bool FlagAt(const nlohmann::json& row, const char* key);
std::vector<std::string> TextsAt(const nlohmann::json& row, const char* key);
/// Whether the runner found this ("claim_fails", ...) in the row's run.
bool HasFinding(const nlohmann::json& row, const char* finding);
std::vector<double> NumbersAt(const nlohmann::json& row, const char* key);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_BENCH_DATA_H_
