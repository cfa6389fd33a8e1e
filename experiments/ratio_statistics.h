#ifndef BATTEN_EXPERIMENTS_RATIO_STATISTICS_H_
#define BATTEN_EXPERIMENTS_RATIO_STATISTICS_H_

#include <vector>

namespace batten {

/// The median of a sample and an interval that holds the median of what it was drawn from with 95 %
/// confidence, whatever the distribution: the order statistics n / 2 -+ 0.98 sqrt(n) (Conover,
/// Practical Nonparametric Statistics, sec. 3.2). NaN for no numbers.
struct MedianWithInterval {
  double median = 0.0;
  double low = 0.0;
  double high = 0.0;
};
MedianWithInterval MedianOf(std::vector<double> sample);

/// How often a ratio is below 1, equal to it, and above.
struct WinCounts {
  int wins = 0;
  int ties = 0;
  int losses = 0;
};
WinCounts CountWins(const std::vector<double>& ratios);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_RATIO_STATISTICS_H_
