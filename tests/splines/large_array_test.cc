#include "splines/large_array.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <new>

namespace batten {
namespace {

constexpr std::size_t kLargeSize = kLargeBytes / sizeof(double);

bool IsZero(double number) { return number == 0.0; }

TEST(LargeArray, OfZerosIsZeroWhereverItsMemoryComesFrom) {
  for (const std::size_t size : {std::size_t(0), std::size_t(1), kLargeSize - 1, kLargeSize,
                                 kLargeSize + 1, 3 * kLargeSize}) {
    // What was written into memory given back must not come again.
    for (int round = 0; round < 2; ++round) {
      LargeArray zeros = LargeZeros(size);
      ASSERT_EQ(zeros.size(), size);
      EXPECT_TRUE(std::all_of(zeros.begin(), zeros.end(), IsZero));
      EXPECT_EQ(reinterpret_cast<std::uintptr_t>(zeros.data()) % kCacheLine, 0U);
      std::fill(zeros.begin(), zeros.end(), 1.0);
    }
  }
}

TEST(LargeArray, KeepsItsNumbersWhenItGrowsAndShrinks) {
  LargeArray numbers(kLargeSize - 1);
  std::fill(numbers.begin(), numbers.end(), 1.0);
  numbers.resize(2 * kLargeSize, 2.0);
  EXPECT_EQ(std::count(numbers.begin(), numbers.end(), 1.0), std::ptrdiff_t(kLargeSize) - 1);
  EXPECT_EQ(std::count(numbers.begin(), numbers.end(), 2.0), std::ptrdiff_t(kLargeSize) + 1);
  numbers.resize(10);
  numbers.shrink_to_fit();
  EXPECT_EQ(numbers, LargeArray(10, 1.0));
}

TEST(LargeArray, ThrowsWhereThereIsNoMemory) {
  constexpr std::size_t kTooMuch = std::size_t(1) << 59;
  EXPECT_THROW(LargeArray{}.reserve(kTooMuch), std::bad_alloc);
}

}  // namespace
}  // namespace batten
