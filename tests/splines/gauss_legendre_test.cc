#include "splines/gauss_legendre.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/splines/example_splines.h"

namespace batten {
namespace {

TEST(GaussLegendre, HasTheKnownNodesOfTwoAndThreePoints) {
  const GaussRule two = GaussLegendreRule(2);
  EXPECT_DOUBLE_EQ(two.nodes[0], -1.0 / std::sqrt(3.0));
  EXPECT_DOUBLE_EQ(two.weights[1], 1.0);
  const GaussRule three = GaussLegendreRule(3);
  EXPECT_EQ(three.nodes[1], 0.0);
  EXPECT_DOUBLE_EQ(three.nodes[2], std::sqrt(0.6));
  EXPECT_DOUBLE_EQ(three.weights[0], 5.0 / 9.0);
  EXPECT_DOUBLE_EQ(three.weights[1], 8.0 / 9.0);
}

TEST(GaussLegendre, IntegratesPowersUpToDegreeTwiceTheNumberOfPointsLessOne) {
  for (int n = 1; n <= 12; ++n) {
    const GaussRule rule = GaussLegendreRule(n);
    for (int power = 0; power <= 2 * n; ++power) {
      double sum = 0.0;
      for (int g = 0; g < n; ++g) sum += rule.weights[g] * std::pow(rule.nodes[g], power);
      const double exact = power % 2 == 0 ? 2.0 / (power + 1) : 0.0;
      // Weights sum up to 2; nodes and powers carry a rounding each and one per factor.
      const double tolerance = 2.0 * (power + 2) * kEpsilon;
      if (power < 2 * n) {
        EXPECT_NEAR(sum, exact, tolerance) << n << " points, power " << power;
      } else {
        EXPECT_GT(std::abs(sum - exact), 1e3 * tolerance) << n << " points, power " << power;
      }
    }
  }
}

}  // namespace
}  // namespace batten
