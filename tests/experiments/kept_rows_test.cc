#include "experiments/kept_rows.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
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

}  // namespace
}  // namespace batten
