#ifndef BATTEN_EXPERIMENTS_BENCH_RESULTS_H_
#define BATTEN_EXPERIMENTS_BENCH_RESULTS_H_

#include <array>
#include <string>
#include <vector>

#include "experiments/bench_data.h"
#include "experiments/bench_profiles.h"

namespace batten {

/// What is counted: calls of E, g, J and products; seconds over those of one evaluation of E on
/// this problem; the solver's seconds.
enum class BenchCost { kEvaluations, kWorkUnits, kSeconds };
inline constexpr std::array<BenchCost, 3> kBenchCosts = {
    BenchCost::kEvaluations, BenchCost::kWorkUnits, BenchCost::kSeconds};
const char* ToString(BenchCost cost);

/// What is to be reached: a gap to the minimum, or E of the truth where the data's noise is known.
struct BenchTarget {
  std::string label;  // "gap 0.001", "noise floor"
  double gap = 0.0;   // 0: the noise floor
};

struct BenchInstance {
  std::string label;  // "rhino | own | start 2"
  std::string problem;
  std::string terms;
  std::string kind;  ///< Of its parameters: "fixed", "free", "projected".
  double num_variables = 0.0;
  double unit_seconds = 0.0;       // NaN: not known
  double reference_seconds = 0.0;  // what ReferenceSeconds() gave beside; NaN: not known
  double start_energy = 0.0;
  double minimum_energy = 0.0;         // E*: the direct answer, or the best basin's
  bool has_basins = false;             // no direct answer
  double truth_energy = 0.0;           // NaN: not known
  std::vector<double> basin_energies;  // in the order of energies at foot points
};

/// One solver (with one seed) on one instance, over its repetitions.
struct BenchRun {
  std::size_t instance = 0;
  std::size_t solver = 0;
  int solver_seed = 1;
  const nlohmann::json* first = nullptr;    // the row of the first repetition that is there
  std::vector<const nlohmann::json*> rows;  // of all repetitions
  int num_failed = 0;                       // repetitions whose process gave no result
  /// Of those that did not overlap others; infinity: failed.
  std::vector<double> seconds;
  int basin = 0;                    // 0: the best; -1: not known, or no end
  bool ran = false;                 // it gave a result
  bool repetitions_differ = false;  // their ends or counts
  /// By target and cost; infinity: not reached, NaN: times that are not known.
  std::vector<std::array<double, 3>> to_target;
  /// The same to the minimum of the run's own basin.
  std::vector<std::array<double, 3>> to_own_target;
};

struct BenchResults {
  std::string suite;
  std::vector<std::string> solvers;
  std::vector<BenchTarget> targets;
  std::vector<BenchInstance> instances;
  std::vector<BenchRun> runs;  // instance by instance
  std::size_t num_cells = 0, num_finished = 0;
  std::string part;         // "2/3": the folder is that of one part; empty: of all, or of several
  bool overlapped = false;  // some times are left out
  /// One sentence each: failures with their reason, claims that fail, solvers that disagree,
  /// repetitions that differ, solvers that are one method, targets below the rounding of E.
  std::vector<std::string> notes;
  bool some_claim_failed = false;
  bool some_failed = false;  // crashed, ran out of something, or did not reach what was asked
};

/// `data` must outlive the result. Reads the traces of the folder.
BenchResults CollectResults(const BenchData& data);

/// Where there are several minima: whose a gap is taken to.
enum class BenchGoal { kBestBasin, kOwnBasin };

/// Costs of one target, a row per instance that has it, a column per solver (several seeds of a
/// solver: their median); infinity where a solver does not reach it or does not apply, NaN where it
/// was not run (excluded, not finished) or its time is not known.
/// `rows_of`, if not null, receives which instance each row is.
CostTable CostsOf(const BenchResults& results, std::size_t target, BenchCost cost,
                  std::vector<std::size_t>* rows_of, BenchGoal goal = BenchGoal::kBestBasin);

/// Costs of two solvers on instances to which both apply and on which they end in one basin: a fast
/// way to another minimum is neither won nor lost, nor is an end of unknown basin. Costs that are
/// not known are left out.
CostTable PairCosts(const BenchResults& results, std::size_t target, BenchCost cost,
                    std::size_t first, std::size_t second);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_BENCH_RESULTS_H_
