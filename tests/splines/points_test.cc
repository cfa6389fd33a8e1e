#include "splines/points.h"

#include <gtest/gtest.h>

namespace batten {
namespace {

TEST(BoundingBox, FindsTheExtremesWhereverTheyStand) {
  for (const int d : {1, 2, 3, 4, 5}) {
    for (int m = 1; m <= 11; ++m) {
      for (int extreme = 0; extreme < m; ++extreme) {
        Points points = Points::Zero(m, d);
        Eigen::RowVectorXd expected_low = Eigen::RowVectorXd::Zero(d);
        Eigen::RowVectorXd expected_high = Eigen::RowVectorXd::Zero(d);
        // The extreme row is greatest in even coordinates and least in odd ones.
        for (int c = 0; c < d; ++c) {
          points(extreme, c) = c % 2 == 0 ? 1.0 + c : -1.0 - c;
          (c % 2 == 0 ? expected_high : expected_low)[c] = points(extreme, c);
          // With one row it is both.
          if (m == 1) (c % 2 == 0 ? expected_low : expected_high)[c] = points(extreme, c);
        }
        Eigen::RowVectorXd low;
        Eigen::RowVectorXd high;
        FindBoundingBox(points, &low, &high);
        EXPECT_EQ(low, expected_low) << d << " coordinates, row " << extreme << " of " << m;
        EXPECT_EQ(high, expected_high) << d << " coordinates, row " << extreme << " of " << m;
      }
    }
  }
}

}  // namespace
}  // namespace batten
