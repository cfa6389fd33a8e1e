#ifndef BATTEN_EXPERIMENTS_BENCH_TARGETS_H_
#define BATTEN_EXPERIMENTS_BENCH_TARGETS_H_

#include <array>
#include <string>
#include <vector>

#include "experiments/bench_results.h"

namespace batten {

/// The columns of a trace that targets need.
struct ShortTrace {
  std::vector<double> evaluations;  // calls of E, g, J and products so far
  std::vector<double> seconds;
  std::vector<double> energies;
};
/// Empty where the file cannot be read.
ShortTrace ReadShortTrace(const std::string& path);

/// E that is to be reached; NaN where the target means nothing: no E* known, a start that is the
/// minimum, a gap that is rounding of E.
double TargetEnergy(const BenchInstance& instance, const BenchTarget& target,
                    double minimum_energy);

/// Costs of a run up to the first row of its trace with E at most `energy`: medians over its
/// repetitions, of which one that does not reach it, or whose trace is empty since it failed, is
/// infinity. Evaluations count from 1, so that ratios can be formed. Times are of the timed
/// repetitions; NaN: not known.
std::array<double, 3> CostsTo(double energy, const std::vector<ShortTrace>& traces,
                              const std::vector<bool>& is_timed, double unit_seconds);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_BENCH_TARGETS_H_
