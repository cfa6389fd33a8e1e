#include "experiments/guarded_vector.h"

#include <gtest/gtest.h>
#include <sys/mman.h>

#include <cmath>
#include <cstdlib>

namespace batten {
namespace {

constexpr Eigen::Index kSize = 509;

double Read(const Eigen::VectorXd& vector, Eigen::Index place) {
  return static_cast<const volatile double*>(vector.data())[place];
}

/// Each in a process of its own: a GuardedVector changes how memory is handed out.
#define EXPECT_CHILD_SAYS_YES(statement) \
  EXPECT_EXIT(                           \
      {                                  \
        statement;                       \
        std::_Exit(yes ? 0 : 1);         \
      },                                 \
      ::testing::ExitedWithCode(0), "")

TEST(GuardedVector, IsAVectorLikeAnother) {
  EXPECT_CHILD_SAYS_YES(
      const Eigen::VectorXd values = Eigen::VectorXd::LinSpaced(kSize, 0.0, 1.0);
      GuardedVector x(values); bool yes = *x.vector() == values; x.SetNumbersBehind(7.0);
      yes = yes && *x.vector() == values && (!x.works() || Read(*x.vector(), kSize) == 7.0););
}

#if !defined(__SANITIZE_ADDRESS__)
TEST(GuardedVector, HasAPageBehindItThatMustNotBeTouched) {
  EXPECT_EXIT(
      {
        GuardedVector x(Eigen::VectorXd::Zero(kSize));
        if (!x.works()) std::_Exit(1);
        static_cast<void>(Read(*x.vector(), kSize + 1));
        std::_Exit(2);
      },
      ::testing::KilledBySignal(SIGSEGV), "");
}

TEST(GuardedVector, WorksForAnySize) {
  for (const Eigen::Index size : {1, 20, 500, 510, 511, 1533}) {
    EXPECT_CHILD_SAYS_YES(GuardedVector x(Eigen::VectorXd::Zero(size)); x.SetNumbersBehind(7.0);
                          const bool yes = x.works() && x.vector()->isZero(0.0););
  }
}

TEST(GuardedVector, FillsAllNumbersUpToThePageBehindIt) {
  // A page holds the allocator's header of 16 bytes, 500 numbers, and 10 more.
  EXPECT_CHILD_SAYS_YES(GuardedVector x(Eigen::VectorXd::Zero(500)); x.SetNumbersBehind(7.0);
                        const bool yes =
                            Read(*x.vector(), 500) == 7.0 && Read(*x.vector(), 509) == 7.0;);
  EXPECT_EXIT(
      {
        GuardedVector x(Eigen::VectorXd::Zero(500));
        static_cast<void>(Read(*x.vector(), 510));
        std::_Exit(2);
      },
      ::testing::KilledBySignal(SIGSEGV), "");
}
#endif

}  // namespace
}  // namespace batten
