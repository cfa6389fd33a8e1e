#include "solvers/cg.h"

#include <gtest/gtest.h>

#include "tests/solvers/circulant_fit.h"
#include "tests/solvers/contract_cases.h"

namespace batten {
namespace {

TEST(Cg, EndsAfterAsManyStepsAsThereAreEigenvalues) {
  for (const int n : {5, 8, 13}) {
    // Eigenvalues of a symmetric circulant come in pairs but for k = 0 and k = n / 2.
    const int num_distinct = n / 2 + 1;
    const auto problem = MakeCirculantFit(n, 1);
    TestContextOptions options;
    options.gradient_tolerance = 1e-12;
    const SolverTrial trial(*problem, "cg", options);
    EXPECT_LE(trial.iterations(), num_distinct) << n;
    EXPECT_TRUE(IsSuccess(trial.outcome.reason));
  }
}

TEST(Cg, FirstStepIsTheSteepestDescent) {
  const auto problem = MakeFit(MakeNoisyLoop(50, 2, 1), MakeSpec(3, true, 17));
  const DenseFit dense(*problem);
  const SolverTrial trial(*problem, "cg", {1});
  const Points start = dense.PointsOf(problem->start());
  const Points r = dense.a.transpose() * (dense.q - dense.a * start);
  const double step = r.squaredNorm() / (dense.a * r).squaredNorm();
  const Points move = dense.PointsOf(trial.context.iterates()[1]) - start;
  EXPECT_LT((move - step * r).norm(), 64 * kEpsilon);
}

TEST(Cg, EachIterateIsTheBestOfItsKrylovSpace) {
  const auto problem = MakeFit(MakeNoisyLoop(50, 1, 2), MakeSpec(3, true, 17));
  const DenseFit dense(*problem);
  const SolverTrial trial(*problem, "cg", {5});
  const Eigen::VectorXd start = problem->start();
  const Eigen::MatrixXd normal = dense.a.transpose() * dense.a;
  Eigen::MatrixXd basis(17, 5);
  basis.col(0) = (dense.a.transpose() * (dense.q - dense.a * start)).normalized();
  for (int k = 1; k < 5; ++k) {
    Eigen::VectorXd next = normal * basis.col(k - 1);
    for (int pass = 0; pass < 2; ++pass) {
      next -= basis.leftCols(k) * (basis.leftCols(k).transpose() * next);
    }
    basis.col(k) = next.normalized();
  }
  for (int k = 1; k <= 5; ++k) {
    const Eigen::MatrixXd part = dense.a * basis.leftCols(k);
    const Eigen::VectorXd y = part.colPivHouseholderQr().solve(dense.q - dense.a * start);
    const Eigen::VectorXd best = start + basis.leftCols(k) * y;
    EXPECT_LT((trial.context.iterates()[k] - best).norm(), 1e-12) << k;
  }
}

TEST(Cg, AnIterationIsOneProduct) {
  const auto problem = MakeFit(MakeNoisyLoop(50, 2, 1), MakeSpec(3, true, 17));
  const SolverTrial trial(*problem, "cg");
  EXPECT_EQ(trial.context.count(Evaluation::kProduct), 1 + trial.iterations());
  EXPECT_EQ(trial.context.count(Evaluation::kEnergy), 0);
  EXPECT_EQ(trial.context.count(Evaluation::kGradient), 0);
}

TEST(Cg, ReachesTheRoundingFloor) {
  // Its recursive residual alone would stop short of it.
  TestContextOptions options;
  options.gradient_tolerance = -1.0;
  for (const char* name : {"animals/rhino_100.csv", "animals/cat_110.csv"}) {
    for (const int n : {30, 90}) {
      const auto problem = MakeFileFit(name, MakeSpec(3, true, n));
      EXPECT_EQ(SolverTrial(*problem, "cg", options).outcome.reason, StopReason::kRoundingFloor);
    }
  }
}

}  // namespace
}  // namespace batten
