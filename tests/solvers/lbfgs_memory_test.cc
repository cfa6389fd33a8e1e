#include "solvers/lbfgs_memory.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "tests/splines/example_splines.h"

namespace batten {
namespace {

constexpr int kSize = 6;

Eigen::VectorXd RandomVector(std::mt19937* random) { return RandomPoints(kSize, 1, random); }

struct StepAndChange {
  Eigen::VectorXd s;
  Eigen::VectorXd y;
};

/// Pairs of a quadratic whose Hessian has eigenvalues 1..kSize.
std::vector<StepAndChange> RandomPairs(int count, std::mt19937* random) {
  const Eigen::MatrixXd square = RandomPoints(kSize, kSize, random);
  const Eigen::MatrixXd q = square.householderQr().householderQ();
  const Eigen::VectorXd eigenvalues = Eigen::VectorXd::LinSpaced(kSize, 1.0, kSize);
  const Eigen::MatrixXd hessian = q * eigenvalues.asDiagonal() * q.transpose();
  std::vector<StepAndChange> pairs;
  for (int k = 0; k < count; ++k) {
    const Eigen::VectorXd s = RandomVector(random);
    pairs.push_back({s, hessian * s});
  }
  return pairs;
}

/// The inverse Hessian of BFGS written out: H+ = (I - rho s y') H (I - rho y s') + rho s s'
/// (Nocedal & Wright, eq. 6.17) from H0 = s'y / y'y of the newest pair, over pairs first..end - 1.
Eigen::MatrixXd ExplicitInverse(const std::vector<StepAndChange>& pairs, std::size_t first) {
  const StepAndChange& newest = pairs.back();
  Eigen::MatrixXd h =
      Eigen::MatrixXd::Identity(kSize, kSize) * newest.s.dot(newest.y) / newest.y.squaredNorm();
  for (std::size_t k = first; k < pairs.size(); ++k) {
    const double rho = 1.0 / pairs[k].s.dot(pairs[k].y);
    const Eigen::MatrixXd left =
        Eigen::MatrixXd::Identity(kSize, kSize) - rho * pairs[k].s * pairs[k].y.transpose();
    h = left * h * left.transpose() + rho * pairs[k].s * pairs[k].s.transpose();
  }
  return h;
}

TEST(LbfgsMemory, DirectionIsThatOfTheExplicitBfgsMatrix) {
  std::mt19937 random(20240601);
  for (const int capacity : {1, 3, 5, 20}) {
    for (const int count : {1, 3, 4, 5, 9}) {
      const std::vector<StepAndChange> pairs = RandomPairs(count, &random);
      LbfgsMemory memory(capacity);
      for (const StepAndChange& pair : pairs) ASSERT_TRUE(memory.Add(pair.s, pair.y));
      EXPECT_EQ(memory.size(), std::min(capacity, count));
      const Eigen::MatrixXd h =
          ExplicitInverse(pairs, static_cast<std::size_t>(std::max(0, count - capacity)));
      const Eigen::VectorXd gradient = RandomVector(&random);
      Eigen::VectorXd direction;
      memory.Direction(gradient, &direction);
      // Each pair rounds some 4 kSize times; random pairs grow H by up to 1e4.
      const double tolerance = count * 4 * kSize * kEpsilon * h.norm() * gradient.norm() * 10;
      EXPECT_LT((direction + h * gradient).norm(), tolerance) << capacity << " of " << count;
    }
  }
}

TEST(LbfgsMemory, IsThePlainGradientWithoutPairs) {
  std::mt19937 random(20240602);
  LbfgsMemory memory(4);
  const Eigen::VectorXd gradient = RandomVector(&random);
  Eigen::VectorXd direction;
  memory.Direction(gradient, &direction);
  EXPECT_EQ(direction, -gradient);
  const std::vector<StepAndChange> pairs = RandomPairs(2, &random);
  memory.Add(pairs[0].s, pairs[0].y);
  memory.Clear();
  EXPECT_EQ(memory.size(), 0);
  memory.Direction(gradient, &direction);
  EXPECT_EQ(direction, -gradient);
}

TEST(LbfgsMemory, KeepsNoPairWithoutCurvature) {
  LbfgsMemory memory(4);
  const Eigen::VectorXd s = Eigen::VectorXd::Unit(kSize, 0);
  EXPECT_FALSE(memory.Add(s, -s));
  EXPECT_FALSE(memory.Add(s, Eigen::VectorXd::Unit(kSize, 1)));
  EXPECT_FALSE(memory.Add(s, Eigen::VectorXd::Zero(kSize)));
  EXPECT_FALSE(memory.Add(s, 1e-17 * s + Eigen::VectorXd::Unit(kSize, 1)));
  EXPECT_FALSE(memory.Add(s, std::nan("") * s));
  EXPECT_EQ(memory.size(), 0);
  EXPECT_TRUE(memory.Add(s, 1e-13 * s + Eigen::VectorXd::Unit(kSize, 1)));
}

TEST(LbfgsMemory, KnowsNoUnits) {
  std::mt19937 random(20240603);
  const std::vector<StepAndChange> pairs = RandomPairs(5, &random);
  const Eigen::VectorXd gradient = RandomVector(&random);
  LbfgsMemory plain(5), scaled(5);
  for (const StepAndChange& pair : pairs) {
    EXPECT_TRUE(plain.Add(pair.s, pair.y));
    EXPECT_TRUE(scaled.Add(pair.s, 0x1p120 * pair.y));  // E in a unit 2^120 times smaller
  }
  Eigen::VectorXd direction, same;
  plain.Direction(gradient, &direction);
  scaled.Direction(0x1p120 * gradient, &same);
  EXPECT_EQ(direction, same);
}

TEST(LbfgsMemory, ComesBackFromItsNumbers) {
  std::mt19937 random(20240604);
  for (const int count : {0, 2, 7}) {
    LbfgsMemory memory(4);
    for (const StepAndChange& pair : RandomPairs(count, &random)) memory.Add(pair.s, pair.y);
    LbfgsMemory copy(4);
    copy.FromNumbers(memory.ToNumbers(), kSize);
    EXPECT_EQ(copy.size(), memory.size());
    const Eigen::VectorXd gradient = RandomVector(&random);
    Eigen::VectorXd direction, same;
    memory.Direction(gradient, &direction);
    copy.Direction(gradient, &same);
    EXPECT_EQ(direction, same);
  }
}

}  // namespace
}  // namespace batten
