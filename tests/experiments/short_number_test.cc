#include "experiments/short_number.h"

#include <gtest/gtest.h>

#include <limits>

namespace batten {
namespace {

TEST(ShortNumber, KeepsTheDigitsThatAreAskedFor) {
  EXPECT_EQ(ShortNumber(0.0123456, 3), "0.0123");
  EXPECT_EQ(ShortNumber(1.23456, 3), "1.23");
  EXPECT_EQ(ShortNumber(45123.4, 3), "45123");
  EXPECT_EQ(ShortNumber(9.996, 3), "10.0");
  EXPECT_EQ(ShortNumber(1.2345e-10, 2), "1.2e-10");
  EXPECT_EQ(ShortNumber(-3.14159, 3), "-3.14");
  EXPECT_EQ(ShortNumber(1e9, 2), "1.0e+09");
  EXPECT_EQ(ShortNumber(0.0, 3), "0");
  EXPECT_EQ(ShortNumber(std::numeric_limits<double>::quiet_NaN(), 3), "-");
}

}  // namespace
}  // namespace batten
