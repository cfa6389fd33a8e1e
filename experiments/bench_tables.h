#ifndef BATTEN_EXPERIMENTS_BENCH_TABLES_H_
#define BATTEN_EXPERIMENTS_BENCH_TABLES_H_

#include <string>
#include <vector>

#include "experiments/atomic_file.h"
#include "experiments/bench_results.h"
#include "experiments/csv_table.h"
#include "experiments/gnuplot.h"

namespace batten {

// Columns that begin with `seconds` or `work_units` are times; all others are the same in every
// run.

/// A row per instance, solver and seed: what came of it.
CsvTable RunTable(const BenchResults& results);
/// A row per target, kind of parameters and solver that applies to some instance of that kind:
/// instances, those of them on which it was not run, those solved, how often the best basin was
/// found, shifted geometric means of each cost (shift 10; of seconds 1 ms) with failures charged 10
/// times the largest cost of their instance.
CsvTable SolverTable(const BenchResults& results);
/// A row per target, kind of parameters, cost and pair of solvers: on how many instances of that
/// kind both end in one basin, who needs less how often, and both profiles at the ratios 1, 2, 10.
CsvTable PairTable(const BenchResults& results);

/// Adds table, solvers and pairs (.csv with all digits, .md and .tex with four) and notes.md to
/// `batch`.
bool WriteBenchTables(const BenchResults& results, const std::string& folder, FileBatch* batch,
                      std::string* error);

/// For each kind of parameters performance profiles, data profiles and runtime distributions by
/// each cost, to the best basin and to each run's own, and of every pair where at most four solvers
/// apply. Those of time are not drawn where all cells overlapped.
std::vector<FigureResult> DrawBenchFigures(const BenchResults& results, const std::string& folder,
                                           FileBatch* batch);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_BENCH_TABLES_H_
