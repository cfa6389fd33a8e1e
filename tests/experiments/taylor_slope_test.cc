#include "experiments/taylor_slope.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/roundoff.h"

namespace batten {
namespace {

/// Of f = exp at 0 with f' taken to be `derivative`, which is 1.
TaylorSlope SlopeOfExp(double derivative) {
  return MeasureTaylorSlope([derivative](double h) { return std::expm1(h) - h * derivative; },
                            1e3 * kEpsilon);
}

TEST(TaylorSlope, IsTwoWhereTheDerivativeIsRight) {
  const TaylorSlope slope = SlopeOfExp(1.0);
  // R = h^2 / 2 (1 + h / 3 + ...), h = 2^-12 and less: the bend is below 1e-4.
  EXPECT_NEAR(slope.slope, 2.0, 1e-3);
  EXPECT_TRUE(IsRightDerivative(slope));
}

TEST(TaylorSlope, IsOneWhereTheDerivativeIsWrong) {
  for (const double wrong : {2.0, 1.01, 0.999}) {
    EXPECT_FALSE(IsRightDerivative(SlopeOfExp(wrong))) << wrong;
  }
  EXPECT_NEAR(SlopeOfExp(2.0).slope, 1.0, 1e-3);
}

TEST(TaylorSlope, IsNoneWhereThereIsNoRemainder) {
  const TaylorSlope linear = MeasureTaylorSlope([](double) { return 1e-20; }, 1e-16);
  EXPECT_TRUE(std::isnan(linear.slope));
  EXPECT_TRUE(IsRightDerivative(linear));
}

TEST(TaylorSlope, RefusesRemaindersThatAreNoNumbers) {
  EXPECT_FALSE(IsRightDerivative(
      MeasureTaylorSlope([](double h) { return h < 1e-3 ? std::nan("") : h; }, 1e-16)));
}

}  // namespace
}  // namespace batten
