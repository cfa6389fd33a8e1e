#include "solvers/basic_solution.h"

#include <gtest/gtest.h>

namespace batten {
namespace {

TEST(BasicSolution, GivesNothingToColumnsThatDependOnOthers) {
  // The third column is the first plus 1e-12 of another direction.
  Eigen::MatrixXd a(4, 3);
  a << 2, 0, 2, 0, 1, 0, 0, 0, 1e-12, 0, 0, 0;
  const Eigen::Vector4d b(4, 3, 1, 5);
  const Eigen::VectorXd x = BasicSolution(a, b, 1e-10);
  EXPECT_LT(x.cwiseAbs().maxCoeff(), 4.0);
  EXPECT_TRUE(x[0] == 0.0 || x[2] == 0.0);
  EXPECT_NEAR(x[0] + x[2], 2.0, 1e-11);
  EXPECT_NEAR(x[1], 3.0, 1e-14);
  // Below the threshold it is a column like others.
  EXPECT_NEAR(BasicSolution(a, b, 1e-13)[2], 1e12, 1e3);
}

TEST(BasicSolution, IsZeroForColumnsOfNothing) {
  EXPECT_TRUE(
      BasicSolution(Eigen::MatrixXd::Zero(3, 2), Eigen::Vector3d(1, 2, 3), 1e-10).isZero(0.0));
}

}  // namespace
}  // namespace batten
