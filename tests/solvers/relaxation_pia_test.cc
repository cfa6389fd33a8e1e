// Jacobi, Gauss-Seidel, successive over-relaxation and random blocks, against dense algebra.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "tests/solvers/circulant_fit.h"
#include "tests/solvers/contract_cases.h"

namespace batten {
namespace {

using ::testing::HasSubstr;

/// What the dense algebra of one step needs.
struct NormalFit {
  explicit NormalFit(const Problem& problem)
      : fit(problem),
        n(fit.a.transpose() * fit.a),
        start(fit.PointsOf(problem.start())),
        residual(fit.a.transpose() * (fit.q - fit.a * start)) {}
  Points Move(const SolverTrial& trial, int k = 0) const {
    const auto at = static_cast<std::size_t>(k);
    return fit.PointsOf(trial.context.iterates()[at + 1] - trial.context.iterates()[at]);
  }
  DenseFit fit;
  Eigen::MatrixXd n;
  Points start;
  Points residual;  // A'(Q - A P) at the start
};

std::vector<std::unique_ptr<Problem>> OpenAndClosed() {
  std::vector<std::unique_ptr<Problem>> problems;
  problems.push_back(MakeFit(MakeNoisyLoop(50, 2, 41), MakeSpec(3, false, 14)));
  problems.push_back(MakeFit(MakeNoisyLoop(50, 3, 42), MakeSpec(4, true, 13)));
  return problems;
}

TEST(JacobiPia, StepsByTheInverseDiagonalOfTheNormalMatrix) {
  for (const auto& problem : OpenAndClosed()) {
    const NormalFit dense(*problem);
    const Points full = dense.n.diagonal().cwiseInverse().asDiagonal() * dense.residual;
    for (const double w : {1.0, 0.35}) {
      const SolverTrial trial(*problem, "jacobi_pia/w=" + NumberText(w), {1});
      EXPECT_LT((dense.Move(trial) - w * full).norm(), kRoundingOfStep) << w;
    }
    // w = 0: one over the largest row sum of the scaled matrix.
    const Eigen::VectorXd root = dense.n.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd scaled = root.asDiagonal() * dense.n * root.asDiagonal();
    const double certified = 1.0 / scaled.cwiseAbs().rowwise().sum().maxCoeff();
    const SolverTrial trial(*problem, "jacobi_pia", {1});
    EXPECT_NEAR(Noted(trial, "w"), certified, 1e-14);
    EXPECT_LT((dense.Move(trial) - certified * full).norm(), kRoundingOfStep);
    // The note's largest eigenvalue is estimated from above, to 1e-3.
    const double l1 =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled).eigenvalues().maxCoeff();
    const double largest_w = Noted(trial, "largest w that converges");
    EXPECT_LE(largest_w, 2.0 / l1 * (1.0 + 1e-12));
    EXPECT_GT(largest_w, 2.0 / l1 * (1.0 - 3e-3));
  }
}

TEST(JacobiPia, WithoutRelaxationDivergesOnAClosedUniformCubicAndSaysWhy) {
  for (const int per_span : {4, 7}) {
    const auto problem = MakeCirculantFit(20, per_span);
    const NormalFit dense(*problem);
    // Circulant: the constant vector's eigenvalue of N is its row sum, and per_span.
    ASSERT_GT(per_span / dense.n(0, 0), 2.0);
    TestContextOptions options;
    options.divergence = 1e10;
    const SolverTrial trial(*problem, "jacobi_pia/w=1", options);
    EXPECT_EQ(trial.outcome.reason, StopReason::kDiverged);
    const std::string why = "w = 1 is not below";
    EXPECT_THAT(trial.outcome.message, HasSubstr(why));
    EXPECT_THAT(trial.context.notes().at("may not converge"), HasSubstr(why));
    // The certified weight converges where w = 1 does not.
    const SolverTrial safe(*problem, "jacobi_pia", {5000});
    EXPECT_EQ(safe.outcome.reason, StopReason::kGradientSmall);
    EXPECT_EQ(safe.context.notes().count("may not converge"), 0U);
  }
}

TEST(JacobiPia, SaysWhyWhereTheStallGuardEndsIt) {
  const SolverTrial trial(*MakeCirculantFit(20, 4), "jacobi_pia/w=1", {3000});
  EXPECT_EQ(trial.outcome.reason, StopReason::kStalled);
  EXPECT_THAT(trial.outcome.message, HasSubstr("w = 1 is not below"));
}

TEST(JacobiPia, WithoutRelaxationConvergesWithOnePointPerSpan) {
  // N has rows 1/36, 8/36, 18/36, 8/36, 1/36: row sum over diagonal 2 (the constant vector); every
  // other eigenvalue is below. At exactly 2 the constant part turns about for ever.
  const auto problem = MakeCirculantFit(20, 1);
  EXPECT_EQ(SolverTrial(*problem, "jacobi_pia/w=0.99", {5000}).outcome.reason,
            StopReason::kGradientSmall);
}

/// (L + D / w)^-1 (B - N P), D and L diagonal and strictly lower triangle of N.
Points SweepMove(const NormalFit& dense, double w, const Points& residual) {
  Eigen::MatrixXd triangle = dense.n.triangularView<Eigen::StrictlyLower>();
  triangle.diagonal() = dense.n.diagonal() / w;
  return triangle.triangularView<Eigen::Lower>().solve(Eigen::MatrixXd(residual));
}

TEST(SweepingPia, ASweepIsASolveWithTheLowerTriangle) {
  for (const auto& problem : OpenAndClosed()) {
    const NormalFit dense(*problem);
    for (const auto& [solver, w] : {std::pair("gauss_seidel_pia", 1.0),
                                    {"sor_pia", 1.3},
                                    {"sor_pia/w=0.4", 0.4},
                                    {"sor_pia/w=1.9", 1.9}}) {
      const SolverTrial trial(*problem, solver, {3, -1.0, false});
      for (int k = 0; k < 3; ++k) {
        const Points p = dense.fit.PointsOf(trial.context.iterates()[static_cast<std::size_t>(k)]);
        const Points residual = dense.fit.a.transpose() * (dense.fit.q - dense.fit.a * p);
        EXPECT_LT((dense.Move(trial, k) - SweepMove(dense, w, residual)).norm(), kRoundingOfStep)
            << solver << " " << k;
      }
    }
  }
}

TEST(SweepingPia, SorWithoutRelaxationIsGaussSeidelToTheBit) {
  const auto problem = MakeFit(MakeNoisyLoop(50, 2, 43), MakeSpec(3, true, 14));
  const SolverTrial sor(*problem, "sor_pia/w=1", {20});
  const SolverTrial seidel(*problem, "gauss_seidel_pia", {20});
  EXPECT_TRUE(SameBits(sor.x, seidel.x));
}

TEST(RandomisedPia, WithOneBlockStepsByTheLargestRowSum) {
  for (const auto& problem : OpenAndClosed()) {
    const NormalFit dense(*problem);
    const double step = 1.0 / dense.n.cwiseAbs().rowwise().sum().maxCoeff();
    const SolverTrial trial(*problem, "randomised_pia/block=100", {1});
    EXPECT_LT((dense.Move(trial) - step * dense.residual).norm(), kRoundingOfStep);
  }
}

TEST(RandomisedPia, TakesAPathThatTheSeedDecides) {
  const auto problem = MakeFit(MakeNoisyLoop(80, 2, 45), MakeSpec(3, true, 40));
  TestContextOptions options = {20, -1.0};
  const SolverTrial first(*problem, "randomised_pia", options);
  const SolverTrial again(*problem, "randomised_pia", options);
  options.seed += 1;
  const SolverTrial other(*problem, "randomised_pia", options);
  ASSERT_EQ(first.iterations(), again.iterations());
  for (std::size_t k = 0; k < first.context.iterates().size(); ++k) {
    EXPECT_TRUE(SameBits(first.context.iterates()[k], again.context.iterates()[k])) << k;
  }
  EXPECT_FALSE(SameBits(first.context.iterates()[1], other.context.iterates()[1]));
}

TEST(RandomisedPia, NeverRaisesTheEnergy) {
  const auto problem = MakeFit(MakeNoisyLoop(80, 2, 46), MakeSpec(3, false, 40));
  const DenseFit dense(*problem);
  for (const char* solver :
       {"randomised_pia/block=1", "randomised_pia", "randomised_pia/block=64"}) {
    const SolverTrial trial(*problem, solver, {300, -1.0});
    double last = dense.Gap(trial.context.iterates().front());
    for (const Eigen::VectorXd& x : trial.context.iterates()) {
      const double gap = dense.Gap(x);
      // What the reference solution itself is off by: squares of its 1e-13.
      EXPECT_LE(gap, last + 1e-13 * std::sqrt(last) + 1e-26) << solver;
      last = gap;
    }
    EXPECT_LT(last, 1e-2 * dense.Gap(problem->start())) << solver;
  }
}

}  // namespace
}  // namespace batten
