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
      GuardedVector x(values); bool yes = *x.vector() == values; x.SetNumberBehind(7.0);
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

TEST(GuardedVector, WorksForWholePagesOnly) {
  EXPECT_CHILD_SAYS_YES(const bool yes = GuardedVector(Eigen::VectorXd::Zero(1533)).works(););
  EXPECT_CHILD_SAYS_YES(const bool yes = !GuardedVector(Eigen::VectorXd::Zero(500)).works(););
}
#endif

}  // namespace
}  // namespace batten
