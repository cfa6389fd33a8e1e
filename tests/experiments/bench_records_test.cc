#include "experiments/bench_records.h"

#include <gtest/gtest.h>

#include "tests/solvers/test_fits.h"

namespace batten {
namespace {

TEST(MostIterates, AreThoseThatFit) {
  // 9 control points in the plane: 18 variables.
  const auto small = MakeFit(MakeNoisyLoop(60, 2, 1), MakeSpec(3, true, 9));
  EXPECT_EQ(MostIterates(*small, 7), 7u);
  EXPECT_EQ(MostIterates(*small, kAllIterates), 20'000u);
  // 32 MiB are 33,554,432 bytes, an iterate of 2,000 doubles has 16,000: 2,097.2 of them.
  const auto large = MakeFit(MakeNoisyLoop(1'000, 2, 1), MakeSpec(3, true, 1'000));
  EXPECT_EQ(MostIterates(*large, kAllIterates), 2'097u);
  EXPECT_EQ(MostIterates(*large, 1'000), 1'000u);
  const auto too_large = MakeFit(MakeNoisyLoop(10'001, 2, 1), MakeSpec(3, true, 10'001));
  EXPECT_EQ(MostIterates(*too_large, 20), 0u);
}

}  // namespace
}  // namespace batten
