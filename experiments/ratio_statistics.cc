#include "experiments/ratio_statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace batten {

MedianWithInterval MedianOf(std::vector<double> sample) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  if (sample.empty()) return {kNan, kNan, kNan};
  std::sort(sample.begin(), sample.end());
  const auto n = static_cast<double>(sample.size());
  const std::size_t middle = sample.size() / 2;
  const double median =
      sample.size() % 2 == 1 ? sample[middle] : 0.5 * (sample[middle - 1] + sample[middle]);
  constexpr double kHalfWidth = 0.98;  // 1.96 standard deviations of a count with p = 1/2
  const double reach = kHalfWidth * std::sqrt(n);
  // Order statistics are counted from 1.
  const auto low = static_cast<std::size_t>(std::max(1.0, std::floor(0.5 * n - reach)));
  const auto high = static_cast<std::size_t>(std::min(n, std::ceil(0.5 * n + reach) + 1.0));
  return {median, sample[low - 1], sample[high - 1]};
}

WinCounts CountWins(const std::vector<double>& ratios) {
  WinCounts counts;
  for (const double ratio : ratios) {
    ++(ratio < 1.0 ? counts.wins : ratio > 1.0 ? counts.losses : counts.ties);
  }
  return counts;
}

}  // namespace batten
