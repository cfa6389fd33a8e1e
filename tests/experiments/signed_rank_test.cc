#include "experiments/signed_rank.h"

#include <gmock/gmock.h>

#include "experiments/regression.h"

namespace batten {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;

TEST(SignedRank, IsExactWhereItCanBeCounted) {
  // Of the 8 subsets of the ranks {1, 2, 3} two have a sum of at least 5.
  const SignedRank three = TestSignedRank({-1.0, 2.0, 3.0});
  EXPECT_EQ(three.positive_sum, 5.0);
  EXPECT_DOUBLE_EQ(three.p_greater, 2.0 / 8.0);
  EXPECT_DOUBLE_EQ(TestSignedRank({1.0, 2.0, 3.0, 4.0, 5.0}).p_greater, 1.0 / 32.0);
  EXPECT_DOUBLE_EQ(TestSignedRank({-1.0, -2.0}).p_greater, 1.0);
}

// Hollander, Wolfe & Chicken, table of the signed-rank statistic, n = 10: 0.042 for 45, 0.024
// for 47.
TEST(SignedRank, AgreesWithTheTable) {
  // T+ = 55 - (1 + 9) and 55 - 8.
  const SignedRank first = TestSignedRank({-1, 2, 3, 4, 5, 6, 7, 8, -9, 10});
  EXPECT_EQ(first.positive_sum, 45.0);
  EXPECT_NEAR(first.p_greater, 0.042, 5e-4);
  const SignedRank second = TestSignedRank({1, 2, 3, 4, 5, 6, 7, -8, 9, 10});
  EXPECT_EQ(second.positive_sum, 47.0);
  EXPECT_NEAR(second.p_greater, 0.024, 5e-4);
}

TEST(SignedRank, SharesRanksAndLeavesZerosOut) {
  // Three ranks of 2: a sum of at least 4 are two or three of three signs.
  const SignedRank tied = TestSignedRank({1.0, 0.0, 1.0, -1.0, 0.0});
  EXPECT_EQ(tied.count, 3);
  EXPECT_EQ(tied.positive_sum, 4.0);
  EXPECT_DOUBLE_EQ(tied.p_greater, 4.0 / 8.0);
  EXPECT_EQ(TestSignedRank({0.0}).p_greater, 1.0);
}

// 500 differences are counted, 501 are not; the last and largest one is negative, and leaves a sum
// that the exact distribution of one less has too, within what one rank of 501 moves it.
TEST(SignedRank, OfManyIsNearTheExactOne) {
  std::vector<double> differences;
  for (int k = 1; k <= 500; ++k) differences.push_back(k % 2 == 0 || k % 25 == 1 ? k : -k);
  const double exact = TestSignedRank(differences).p_greater;
  EXPECT_GT(exact, 0.05);
  EXPECT_LT(exact, 0.45);
  differences.push_back(0.5);  // the smallest: rank 1, all others one up
  const double normal = TestSignedRank(differences).p_greater;
  constexpr double kApart = 0.02;
  EXPECT_THAT(normal, DoubleNear(exact, kApart));
}

TEST(HolmCorrected, MultipliesByTheTestsThatAreLeft) {
  // In order: 0.01 * 3, 0.02 * 2, 0.03 * 1, none below the one before.
  EXPECT_THAT(
      HolmCorrected({0.03, 0.01, 0.02}),
      ElementsAre(DoubleNear(0.04, 1e-12), DoubleNear(0.03, 1e-12), DoubleNear(0.04, 1e-12)));
}

}  // namespace
}  // namespace batten
