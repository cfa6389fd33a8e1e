#include "experiments/bench_profiles.h"

#include <gmock/gmock.h>

#include <cmath>

namespace batten {
namespace {

using ::testing::ElementsAre;

constexpr double kNever = HUGE_VAL;

// Two solvers, four problems; nobody solves the last one.
const CostTable kTable = {{1.0, 2.0}, {4.0, 2.0}, {3.0, kNever}, {kNever, kNever}};

TEST(PerformanceProfiles, AreSharesOfAllProblemsWithinAFactorOfTheBest) {
  // Ratios to the best: 1, 2, 1, none; and 2, 1, none, none.
  const std::vector<Steps> profiles = PerformanceProfiles(kTable);
  ASSERT_EQ(profiles.size(), 2u);
  EXPECT_THAT(profiles[0].x, ElementsAre(1.0, 2.0));
  EXPECT_THAT(profiles[0].y, ElementsAre(0.5, 0.75));
  EXPECT_THAT(profiles[1].x, ElementsAre(1.0, 2.0));
  EXPECT_THAT(profiles[1].y, ElementsAre(0.25, 0.5));
  EXPECT_EQ(profiles[0].At(0.99), 0.0);
  EXPECT_EQ(profiles[0].At(1.99), 0.5);
  EXPECT_EQ(profiles[0].At(1e9), 0.75);
}

TEST(PerformanceProfiles, OfThreeAreNoOrderOfTwo) {
  // With the third solver the first is within a factor 2 of the best on problems 1 and 4, the
  // second on problem 3; without it the first on 1, 2 and 4, the second on all.
  const CostTable table = {{2.0, 4.0, 1.0}, {5.0, 4.0, 1.0}, {3.0, 1.0, 10.0}, {2.0, 3.0, 1.0}};
  const std::vector<Steps> all = PerformanceProfiles(table);
  EXPECT_EQ(all[0].At(2.0), 0.5);
  EXPECT_EQ(all[1].At(2.0), 0.25);
  const std::vector<Steps> pair = PairProfiles(table, 0, 1);
  EXPECT_EQ(pair[0].At(2.0), 0.75);
  EXPECT_EQ(pair[1].At(2.0), 1.0);
}

TEST(DataProfiles, CountInUnitsOfEachProblem) {
  const std::vector<Steps> profiles = DataProfiles(kTable, {1.0, 2.0, 3.0, 1.0});
  // In their units: 1, 2, 1, none; and 2, 1, none, none.
  EXPECT_EQ(profiles[0].At(1.0), 0.5);
  EXPECT_EQ(profiles[0].At(2.0), 0.75);
  EXPECT_EQ(profiles[1].At(1.0), 0.25);
  EXPECT_EQ(profiles[1].At(2.0), 0.5);
}

TEST(Distribution, IsTheShareThatIsReached) {
  const Steps steps = Distribution({3.0, 1.0, kNever, 1.0});
  EXPECT_THAT(steps.x, ElementsAre(1.0, 3.0));
  EXPECT_THAT(steps.y, ElementsAre(0.5, 0.75));
}

TEST(ShiftedGeometricMean, TakesZeros) {
  EXPECT_DOUBLE_EQ(ShiftedGeometricMean({0.0, 8.0}, 1.0), 2.0);  // root of 1 * 9, less 1
  EXPECT_TRUE(std::isnan(ShiftedGeometricMean({}, 1.0)));
}

TEST(ChargeFailures, TakesTheLargestCostOfTheProblem) {
  const CostTable charged = ChargeFailures(kTable, 10.0);
  EXPECT_THAT(charged,
              ElementsAre(ElementsAre(1.0, 2.0), ElementsAre(4.0, 2.0), ElementsAre(3.0, 30.0)));
}

TEST(BootstrapMedian, HoldsTheMedianAndIsTheSameAgain) {
  // Resamples of two have the medians 0, 0.5, 1 with probabilities 1/4, 1/2, 1/4.
  const MedianWithInterval two = BootstrapMedian({0.0, 1.0}, 1);
  EXPECT_EQ(two.median, 0.5);
  EXPECT_EQ(two.low, 0.0);
  EXPECT_EQ(two.high, 1.0);
  const MedianWithInterval one = BootstrapMedian({7.0}, 1);
  EXPECT_EQ(one.low, 7.0);
  EXPECT_EQ(one.high, 7.0);
  const std::vector<double> sample = {3.0, 1.0, 4.0, 1.5, 9.0, 2.6, 5.0};
  EXPECT_EQ(BootstrapMedian(sample, 2).low, BootstrapMedian(sample, 2).low);
}

// Of an odd sample a resample's median is at most the k-th value x_(k) exactly if more than half of
// its draws are: binomially distributed. For 7 values, P(median <= x_(2)) = P(B(7, 2/7) >= 4) = 0.1
// and P(median <= x_(1)) = P(B(7, 1/7) >= 4) = 0.0098: the 2.5 % percentile is x_(2), the 97.5 %
// one x_(6) by symmetry.
TEST(BootstrapMedian, HasThePercentilesOfTheBinomialDistribution) {
  const MedianWithInterval interval = BootstrapMedian({1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0}, 3);
  EXPECT_EQ(interval.median, 4.0);
  EXPECT_EQ(interval.low, 2.0);
  EXPECT_EQ(interval.high, 6.0);
}

}  // namespace
}  // namespace batten
