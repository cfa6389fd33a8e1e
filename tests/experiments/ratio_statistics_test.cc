#include "experiments/ratio_statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace batten {
namespace {

TEST(RatioStatistics, TheIntervalOfAHundredNumbersIsThatOfTheBinomialTable) {
  // 1 to 100: order statistics 40 and 61 hold the median with 95 % (n / 2 -+ 0.98 sqrt(n)).
  std::vector<double> sample;
  for (int k = 100; k >= 1; --k) sample.push_back(k);
  const MedianWithInterval median = MedianOf(sample);
  EXPECT_EQ(median.median, 50.5);
  EXPECT_EQ(median.low, 40.0);
  EXPECT_EQ(median.high, 61.0);
}

TEST(RatioStatistics, SmallSamplesHaveTheirEndsAsInterval) {
  const MedianWithInterval one = MedianOf({3.0});
  EXPECT_EQ(one.median, 3.0);
  EXPECT_EQ(one.low, 3.0);
  EXPECT_EQ(one.high, 3.0);
  const MedianWithInterval three = MedianOf({5.0, 1.0, 2.0});
  EXPECT_EQ(three.median, 2.0);
  EXPECT_EQ(three.low, 1.0);
  EXPECT_EQ(three.high, 5.0);
  EXPECT_TRUE(std::isnan(MedianOf({}).median));
}

TEST(RatioStatistics, CountsWinsTiesAndLosses) {
  const WinCounts counts = CountWins({0.5, 1.0, 1.5, 0.9});
  EXPECT_EQ(counts.wins, 2);
  EXPECT_EQ(counts.ties, 1);
  EXPECT_EQ(counts.losses, 1);
}

}  // namespace
}  // namespace batten
