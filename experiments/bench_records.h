#ifndef BATTEN_EXPERIMENTS_BENCH_RECORDS_H_
#define BATTEN_EXPERIMENTS_BENCH_RECORDS_H_

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "experiments/bench_suite.h"
#include "experiments/run.h"

namespace batten {

/// Names of what a cell's process writes beside its row.
struct BenchRecords {
  std::string trace;     // of all iterations
  std::string iterates;  // only where the cell keeps them
  std::string curve;     // to draw them by; all cells of an instance share it
};

/// Names in the folder of a benchmark's results.
struct BenchFolder {
  std::string path;
  std::string operator/(const std::string& name) const { return path + "/" + name; }
  std::string log(const std::string& key) const { return path + "/logs/" + key + ".log"; }
  BenchRecords records(const std::string& key, const std::string& instance) const {
    return {path + "/traces/" + key + ".csv", path + "/iterates/" + key + ".jsonl",
            path + "/curves/" + instance + ".json"};
  }
};

/// How many iterates a cell on this problem keeps at most, of those `asked` for (kAllIterates, or
/// >= 2): all together at most 32 MiB, so that the memory of the solver is still seen, and 20,000.
/// A run with more iterations than that keeps them spread over it. 0, none, where control points
/// have more than 20,000 numbers, so that lines stay short, or where no two iterates fit.
std::size_t MostIterates(const Problem& problem, int asked);

/// Writes the trace and, where some were kept, the iterates with what they are drawn by, and sets
/// "trace_rows" and "iterate_rows" of the row, which says so that they are there. Not forced onto
/// the disk, which would take longer than a small cell. The file that cannot be written and why;
/// empty: all is well.
std::string WriteRecords(const Problem& problem, const RunResult& run, const BenchRecords& records,
                         nlohmann::ordered_json* row);

/// All that the row speaks of is there, whole: it may not have reached the disk when the machine
/// went off.
bool HasRecords(const nlohmann::json& row, const BenchRecords& records);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_BENCH_RECORDS_H_
