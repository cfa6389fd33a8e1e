#ifndef BATTEN_BENCHMARKS_FREE_RACE_TABLE_H_
#define BATTEN_BENCHMARKS_FREE_RACE_TABLE_H_

#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "experiments/basins.h"
#include "experiments/comparison.h"

namespace batten {

/// Where a run of a method from a start has led, and how soon.
struct Arrival {
  double seconds = std::numeric_limits<double>::infinity();  // to the gap
  BasinEnd basin;
};

/// Of the pairs of runs from one start whose ends are polished to one curve: how many there are,
/// and the median of the ratio of times. Pairs of which neither arrives say nothing.
struct PairedTimes {
  int pairs = 0;
  double ratio = std::numeric_limits<double>::quiet_NaN();
};

inline PairedTimes Pair(const std::vector<std::unique_ptr<Problem>>& starts,
                        const std::vector<Arrival>& of, const std::vector<Arrival>& ours) {
  std::vector<double> ratios;
  for (std::size_t k = 0; k < of.size(); ++k) {
    const BasinEnd& a = of[k].basin;
    const BasinEnd& b = ours[k].basin;
    if (!a.polished || !b.polished) continue;
    if (std::isinf(of[k].seconds) && std::isinf(ours[k].seconds)) continue;
    const std::vector<int> basins = FindBasins(*starts[k], {a, b});
    if (basins[0] == basins[1]) ratios.push_back(of[k].seconds / ours[k].seconds);
  }
  PairedTimes paired;
  paired.pairs = static_cast<int>(ratios.size());
  if (paired.pairs > 0) paired.ratio = Median(ratios);
  return paired;
}

inline double MedianSeconds(const std::vector<Arrival>& arrivals) {
  std::vector<double> seconds;
  for (const Arrival& arrival : arrivals) seconds.push_back(arrival.seconds);
  return Median(seconds);
}

/// `value`, or that it is above `most` where more than half of the runs do not arrive.
inline std::string Shown(double value, double most) {
  char text[32];
  const bool is_finite = std::isfinite(value);
  std::snprintf(text, sizeof text, is_finite ? "%.3g" : "over %.3g", is_finite ? value : most);
  return text;
}

inline void PrintHead(const std::vector<std::string>& ours) {
  std::printf("| method | reached | median ms | over that of `%s` |", ours[0].c_str());
  for (const std::string& one : ours)
    std::printf(" pairs with `%s` | times its time |", one.c_str());
  std::printf(" geometric mean of E at feet |\n|---|---|---|---|");
  for (std::size_t k = 0; k < ours.size(); ++k) std::printf("---|---|");
  std::printf("---|\n");
}

/// `best`: median seconds of the method that the others are held against.
inline void PrintRow(const std::string& solver, const std::vector<Arrival>& arrivals, double best,
                     double most_seconds, const std::vector<PairedTimes>& paired) {
  int reached = 0;
  double log_energy = 0.0;
  for (const Arrival& arrival : arrivals) {
    reached += std::isfinite(arrival.seconds) ? 1 : 0;
    log_energy += std::log(arrival.basin.energy_at_foot_points);
  }
  const double median = MedianSeconds(arrivals);
  std::printf("| `%s` | %d of %zu | %s | %s |", solver.c_str(), reached, arrivals.size(),
              Shown(1e3 * median, 1e3 * most_seconds).c_str(),
              Shown(median / best, most_seconds / best).c_str());
  for (const PairedTimes& times : paired) {
    if (times.pairs == 0) {
      std::printf(" 0 | - |");
    } else {
      std::printf(" %d | %.3g |", times.pairs, times.ratio);
    }
  }
  std::printf(" %.4g |\n", std::exp(log_energy / static_cast<double>(arrivals.size())));
}

}  // namespace batten

#endif  // BATTEN_BENCHMARKS_FREE_RACE_TABLE_H_
