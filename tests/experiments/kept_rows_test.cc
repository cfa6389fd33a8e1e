#include "experiments/kept_rows.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace batten {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(KeptRows, KeepsAllThatFit) {
  EXPECT_THAT(KeptRows(0, 5), IsEmpty());
  EXPECT_THAT(KeptRows(1, 5), ElementsAre(0));
  EXPECT_THAT(KeptRows(5, 5), ElementsAre(0, 1, 2, 3, 4));
}

TEST(KeptRows, FollowsItsFormula) {
  // max(j, round(100 (j / 4)^2)), j = 0..4.
  EXPECT_THAT(KeptRows(101, 5), ElementsAre(0, 6, 25, 56, 100));
  EXPECT_THAT(KeptRows(7, 2), ElementsAre(0, 6));
}

TEST(KeptRows, IncreaseFromTheFirstToTheLast) {
  for (const std::size_t most : {2u, 3u, 7u, 64u}) {
    for (std::size_t count = 1; count < 2000; count += 13) {
      const std::vector<std::size_t> kept = KeptRows(count, most);
      ASSERT_EQ(kept.size(), std::min(count, most));
      EXPECT_EQ(kept.front(), 0u);
      EXPECT_EQ(kept.back(), count - 1);
      for (std::size_t j = 1; j < kept.size(); ++j) {
        EXPECT_LT(kept[j - 1], kept[j]) << count << ' ' << most;
      }
    }
  }
}

TEST(LeastMissed, IsTheOneWhoseNeighboursAreNearestInRatio) {
  // Ratios: (1 + 3) / 1, (1 + 7) / 2, (1 + 8) / 4, so that 7 goes.
  EXPECT_EQ(LeastMissed({0, 1, 3, 7, 8}), 3u);
  EXPECT_EQ(LeastMissed({0, 1, 2}), 1u);
  // Ratios: 3, 3, 2, though all three gaps of the last four are 3.
  EXPECT_EQ(LeastMissed({1, 2, 5, 8, 11}), 3u);
}

TEST(LeastMissed, LeavesARunSpreadGeometrically) {
  constexpr std::size_t kMost = 20;
  std::vector<double> kept;
  for (int k = 0; k <= 10'000; ++k) {
    kept.push_back(k);
    if (kept.size() > kMost) kept.erase(kept.begin() + static_cast<long>(LeastMissed(kept)));
    ASSERT_EQ(kept.front(), 0);
    ASSERT_EQ(kept.back(), k);
  }
  ASSERT_EQ(kept.size(), kMost);
  // Without rounding to whole numbers all ratios of neighbours would be 10001^(1 / 19) = 1.62.
  const double square = std::pow(10'001.0, 2.0 / (kMost - 1));
  for (std::size_t k = 1; k < kept.size(); ++k) {
    EXPECT_LT(kept[k - 1], kept[k]);
    EXPECT_LT((1.0 + kept[k]) / (1.0 + kept[k - 1]), square) << k;
  }
}

}  // namespace
}  // namespace batten
