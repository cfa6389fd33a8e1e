#ifndef BATTEN_EXPERIMENTS_BENCH_CELL_H_
#define BATTEN_EXPERIMENTS_BENCH_CELL_H_

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "experiments/bench_matrix.h"
#include "experiments/bench_records.h"
#include "experiments/child_process.h"

namespace batten {

/// What the process of a cell does: makes the problem anew, runs the solver from its start (warm-up
/// runs first, thrown away), measures the end, and writes its records. Returns the row for
/// cells.jsonl without what only the parent knows, or kCannotWrite and the name of a record, which
/// is no fault of the solver.
inline constexpr char kCannotWrite[] = "cannot write ";
std::string RunBenchCell(const BenchSuite& suite, const BenchCell& cell,
                         const BenchRecords& records);

/// What is measured once per instance, in a process too: the work unit (seconds of one evaluation
/// of E), E* where there is a direct answer, E of the truth where it is known. One line of
/// instances.jsonl.
std::string MeasureInstance(const BenchSuite& suite, const BenchCell& cell);

/// The row of a cell whose process gave none: all numbers are null.
nlohmann::ordered_json FailedRow(const BenchSuite& suite, const BenchCell& cell,
                                 const ChildEnd& end);

/// Limits of a cell's process, with what the suite leaves open filled in.
ChildLimits LimitsOf(const BenchSuite& suite);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_BENCH_CELL_H_
