#include "cost_functions/ordered_parameters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "tests/roundoff.h"

namespace batten {
namespace {

Eigen::VectorXd Vector(std::initializer_list<double> values) {
  return Eigen::Map<const Eigen::VectorXd>(values.begin(),
                                           static_cast<Eigen::Index>(values.size()));
}

/// The isotonic regression by its min-max formula (Robertson, Wright & Dykstra, Order Restricted
/// Statistical Inference, 1988, theorem 1.4.4).
Eigen::VectorXd MinMax(const Eigen::VectorXd& s) {
  Eigen::VectorXd t(s.size());
  for (Eigen::Index i = 0; i < s.size(); ++i) {
    double highest = -std::numeric_limits<double>::infinity();
    for (Eigen::Index a = 0; a <= i; ++a) {
      double lowest = std::numeric_limits<double>::infinity();
      for (Eigen::Index b = i; b < s.size(); ++b) {
        lowest = std::min(lowest, s.segment(a, b - a + 1).mean());
      }
      highest = std::max(highest, lowest);
    }
    t[i] = highest;
  }
  return t;
}

Eigen::VectorXd RandomVector(int size, std::mt19937* random) {
  std::normal_distribution<double> normal;
  Eigen::VectorXd v(size);
  for (double& entry : v) entry = normal(*random);
  return v;
}

TEST(OrderedParameters, LeavesThoseInOrderToTheLastBit) {
  const Eigen::VectorXd s = Vector({0.1, 0.3, 0.3, 0.3, 0.7, 1.1});
  EXPECT_EQ(OrderedParameters(s, 0.0).t, s);
  EXPECT_EQ(OrderedParameters(s, 1.0).t, s);
  EXPECT_EQ(OrderedParameters(s, 0.0).block_begins, (std::vector<int>{0, 1, 4, 5, 6}));
}

TEST(OrderedParameters, MayBeNoneAtAll) {
  const OrderedParameters none(Eigen::VectorXd(0), 0.0);
  EXPECT_EQ(none.t.size(), 0);
  EXPECT_EQ(none.SteepestAscent(Eigen::VectorXd(0)).size(), 0);
}

TEST(OrderedParameters, PoolsThoseThatPassEachOther) {
  const OrderedParameters order(Vector({0.2, 0.6, 0.4, 0.9}), 0.0);
  EXPECT_LT((order.t - Vector({0.2, 0.5, 0.5, 0.9})).norm(), 4 * kEpsilon);
  EXPECT_EQ(order.block_begins, (std::vector<int>{0, 1, 3, 4}));
}

TEST(OrderedParameters, AreTheNearestOrderedOnes) {
  std::mt19937 random(71);
  for (int size = 1; size <= 12; ++size) {
    const Eigen::VectorXd s = RandomVector(size, &random);
    EXPECT_LT((OrderedParameters(s, 0.0).t - MinMax(s)).norm(), 64 * kEpsilon);
  }
}

TEST(OrderedParameters, StayBetweenTheEndsOfAnOpenCurve) {
  const OrderedParameters order(Vector({-0.3, 0.1, -0.4, 0.5, 1.5, 0.9, 1.2}), 0.0, 1.0);
  // 0.1 and -0.4 pool to -0.15; 1.5, 0.9 and 1.2 to 1.2.
  EXPECT_EQ(order.t, Vector({0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0}));
  EXPECT_EQ(order.block_begins, (std::vector<int>{0, 3, 4, 7}));
  EXPECT_TRUE(order.first_at_end && order.last_at_end);
  EXPECT_EQ(OrderedParameters(order.t, 0.0, 1.0).t, order.t);
  EXPECT_EQ(order.Apply(Vector({1, 2, 3, 4, 5, 6, 7})), Vector({0, 0, 0, 4, 0, 0, 0}));

  std::mt19937 random(75);
  for (int size = 1; size <= 12; ++size) {
    const Eigen::VectorXd s = RandomVector(size, &random);
    const Eigen::VectorXd nearest = MinMax(s).cwiseMax(-0.5).cwiseMin(0.5);
    EXPECT_LT((OrderedParameters(s, -0.5, 0.5).t - nearest).norm(), 64 * kEpsilon);
  }
}

TEST(OrderedParameters, GoInwardsOnlyFromTheEndsOfAnOpenCurve) {
  const OrderedParameters order(Vector({-1.0, 0.0, 0.0, 0.5, 1.0, 2.0}), 0.0, 1.0);
  // E falls by g = -3 as the third goes in, and by -1 as the second does; the first would go out.
  EXPECT_EQ(order.SteepestAscent(Vector({2, -1, -3, 7, 0, 0})), Vector({0, -1, -3, 7, 0, 0}));
  // Where the third would hold the second back, both stay: the mean goes out.
  EXPECT_EQ(order.SteepestAscent(Vector({0, -1, 3, 0, 0, 0})), Vector({0, 0, 0, 0, 0, 0}));
  // At the other end the former may go in before the latter.
  EXPECT_EQ(order.SteepestAscent(Vector({0, 0, 0, 0, 2, -5})), Vector({0, 0, 0, 0, 2, 0}));
}

TEST(OrderedParameters, KeepTogetherWhatTheGradientKeeps) {
  const OrderedParameters order(Vector({0.0, 0.0, 0.4, 0.4, 0.4, 0.9}), 0.0, 1.0);
  // The first stays at the end, the second goes in, two of three go together.
  const Eigen::VectorXd ascent = Vector({0, -1, 3, 3, -2, 5});
  EXPECT_EQ(order.KeptTogether(ascent, Vector({7, 1, 2, 4, 9, 6})), Vector({0, 1, 3, 3, 9, 6}));
  // Across the seam the last and the first are at one place.
  const OrderedParameters around(Vector({0.0, 0.4, 1.0, 1.0}), 1.0);
  EXPECT_EQ(around.KeptTogether(Vector({2, 0, 1, 2}), Vector({1, 5, 9, 3})), Vector({2, 5, 9, 2}));
}

TEST(OrderedParameters, PoolTheLastAndTheFirstAroundTheSeam) {
  // The last two pool to 1.25, a quarter after the first: (0 + 2 / 4) / 3 = 1 / 6 of three.
  const OrderedParameters order(Vector({0.0, 0.4, 1.3, 1.2}), 1.0);
  EXPECT_LT((order.t - Vector({1.0 / 6, 0.4, 7.0 / 6, 7.0 / 6})).norm(), 4 * kEpsilon);
  EXPECT_EQ(order.num_cut, 2);
  EXPECT_EQ(order.BlockOf(), (std::vector<int>{0, 1, 0, 0}));
  // The first then passes the second: (0 + 0.1 + 2 / 4) / 4.
  const OrderedParameters on(Vector({0.0, 0.1, 1.3, 1.2}), 1.0);
  EXPECT_LT((on.t - Vector({0.15, 0.15, 1.15, 1.15})).norm(), 4 * kEpsilon);
  EXPECT_EQ(on.BlockOf(), (std::vector<int>{0, 0, 0, 0}));
}

TEST(OrderedParameters, StayWhereTheyAreAtTheSeam) {
  for (const double begin : {0.0, 0.3, -17.7}) {
    const OrderedParameters order(
        Vector({begin, begin + 0.4, begin + 1.0, begin + 1.0 + 4 * kEpsilon}), 1.0);
    EXPECT_EQ(order.t, Vector({begin, begin + 0.4, begin + 1.0, begin + 1.0}));
    EXPECT_EQ(order.num_cut, 2);
    EXPECT_EQ(OrderedParameters(order.t, 1.0).t, order.t);
  }
}

/// The nearest ordered ones within a period, by cutting the circle open between every two points in
/// turn: where what is found is in order there, too, it is they.
Eigen::VectorXd NearestAround(const Eigen::VectorXd& s, double period) {
  const auto m = s.size();
  for (Eigen::Index k = 0; k < m; ++k) {
    Eigen::VectorXd rotated(m);
    rotated << s.tail(m - k), s.head(k).array() + period;
    const Eigen::VectorXd found = MinMax(rotated);
    if (found[m - 1] > found[0] + period) continue;
    Eigen::VectorXd t(m);
    t << found.tail(k).array() - period, found.head(m - k);
    return t;
  }
  ADD_FAILURE() << "in order nowhere";
  return s;
}

TEST(OrderedParameters, AreTheNearestOrderedOnesWithinAPeriod) {
  std::mt19937 random(74);
  int across = 0;
  for (int size = 1; size <= 12; ++size) {
    for (int k = 0; k < 50; ++k) {
      // About in order over 0.5 to 1.5 periods.
      Eigen::VectorXd s = 0.2 * RandomVector(size, &random);
      s += Eigen::VectorXd::LinSpaced(size, 0.0, 0.5 + 0.02 * k);
      const OrderedParameters order(s, 1.0);
      EXPECT_LT((order.t - NearestAround(s, 1.0)).norm(), 64 * kEpsilon) << size;
      across += order.num_cut > 0 ? 1 : 0;
    }
  }
  EXPECT_GT(across, 100);
}

TEST(OrderedParameters, HaveTheDerivativeOfDifferences) {
  std::mt19937 random(72);
  for (const double period : {0.0, 1.5}) {
    const Eigen::VectorXd s = RandomVector(9, &random), v = RandomVector(9, &random);
    constexpr double kStep = 1e-7;  // shorter than any distance between neighbours here
    const OrderedParameters order(s, period);
    const Eigen::VectorXd difference =
        (OrderedParameters(s + kStep * v, period).t - OrderedParameters(s - kStep * v, period).t) /
        (2.0 * kStep);
    EXPECT_LT((order.Apply(v) - difference).norm(), 100 * kEpsilon / kStep);
    const Eigen::VectorXd w = RandomVector(9, &random);
    EXPECT_NEAR(order.Apply(v).dot(w), v.dot(order.Apply(w)), 64 * kEpsilon);
  }
}

TEST(OrderedParameters, DescendWhereOrderAllowsIt) {
  const OrderedParameters order(Vector({0.3, 0.5, 0.5, 0.9}), 0.0);
  // E falls as the second goes back and the third on: they part.
  const Eigen::VectorXd apart = Vector({0.0, 1.0, -3.0, 0.0});
  EXPECT_EQ(order.SteepestAscent(apart), apart);
  // E would fall if they passed each other: they stay, at a minimum.
  EXPECT_TRUE(order.SteepestAscent(Vector({0.0, -2.0, 2.0, 0.0})).isZero(0.0));
  // Two points of which one is a period on: they may part if it goes back.
  const OrderedParameters around(Vector({0.0, 0.4, 1.0}), 1.0);
  EXPECT_EQ(around.num_cut, 1);
  EXPECT_EQ(around.BlockOf(), (std::vector<int>{0, 1, 0}));
  EXPECT_EQ(around.SteepestAscent(Vector({-1.0, 0.5, 2.0})), Vector({-1.0, 0.5, 2.0}));
  EXPECT_EQ(around.SteepestAscent(Vector({1.0, 0.5, -1.0})), Vector({0.0, 0.5, 0.0}));
  EXPECT_EQ(around.SteepestAscent(Vector({3.0, 0.5, -1.0})), Vector({1.0, 0.5, 1.0}));
  // They go on together.
  EXPECT_EQ(order.SteepestAscent(Vector({0.0, -3.0, 1.0, 0.0})), Vector({0.0, -1.0, -1.0, 0.0}));
}

}  // namespace
}  // namespace batten
