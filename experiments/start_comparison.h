#ifndef BATTEN_EXPERIMENTS_START_COMPARISON_H_
#define BATTEN_EXPERIMENTS_START_COMPARISON_H_

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "experiments/basins.h"
#include "experiments/csv_table.h"

namespace batten {

struct StartComparisonSpec {
  std::vector<NameSpec> solvers;
  RunSpec run;
  int starts = 100;  ///< >= 1.
  /// Control points of a circle around the data, each moved by up to this part of its radius.
  double disturbance = 0.3;
  /// Told before each run; may be empty.
  std::function<void(int done, int total, const std::string& running)> progress;
};

/// Which solver leads where from the same starts, on one problem with free parameters.
struct StartComparison {
  /// A row per solver: problem, solver, runs, reached (what was asked), best_found (ends in the
  /// best basin of all), basins (different ones), median_energy and best_energy (at foot points),
  /// median_length (unit of the data) and loop_share (0 to 1: ends with a free loop) of the curves
  /// of those basins, median_iterations, median_seconds.
  CsvTable solvers;
  /// A row per basin in the order of its energy: problem, basin, energy, energy_at_foot_points, its
  /// curve's length, turning, num_free_loops and max_distance_to_data (CurveShape), then for each
  /// solver how many of its runs end there and the median of their seconds.
  CsvTable basins;
  /// A row per run: problem, solver, start, status, iterations, seconds, energy, basin, polished.
  CsvTable runs;
  bool interrupted = false;
};

/// The problem of `problem`'s data and spec from disturbed start number `k` of `seed`.
std::unique_ptr<Problem> FromDisturbedCircle(const Problem& problem, double disturbance,
                                             std::uint64_t seed, int k, std::string* error);

/// The same from `control_points` (user units, n x d) instead of a circle.
std::unique_ptr<Problem> FromDisturbed(const Problem& problem, const Points& control_points,
                                       double disturbance, std::uint64_t seed, int k,
                                       std::string* error);

/// False with one sentence in `error`, as for fixed parameters.
bool CompareStarts(const Problem& problem, const StartComparisonSpec& spec,
                   StartComparison* comparison, std::string* error);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_START_COMPARISON_H_
