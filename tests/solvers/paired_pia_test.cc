// The relatives of gim: weights, points that are met, groups of points, an approximate inverse.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/QR>

#include "tests/solvers/circulant_fit.h"
#include "tests/solvers/contract_cases.h"

namespace batten {
namespace {

using ::testing::HasSubstr;

/// Open, so that point i belongs to control point i.
std::unique_ptr<Problem> OpenInterpolation(int n) {
  FitSpec spec = MakeSpec(3, false, n);
  spec.knots = KnotRule::kAveraged;
  return MakeFit(WithoutWeights(MakeNoisyLoop(n, 2, 51)), spec);
}

std::unique_ptr<Problem> PlainFit(int m, int n, bool closed) {
  return MakeFit(WithoutWeights(MakeNoisyLoop(m, 2, 52)), MakeSpec(3, closed, n));
}

Points PointsAt(const DenseFit& dense, const SolverTrial& trial, std::size_t k) {
  return dense.PointsOf(trial.context.iterates()[k]);
}

TEST(WeightedPia, MovesByWTimesTheResidual) {
  const auto problem = OpenInterpolation(14);
  const DenseFit dense(*problem);
  const SolverTrial trial(*problem, "weighted_pia/w=1.3", {1});
  const Points start = PointsAt(dense, trial, 0);
  EXPECT_LT((PointsAt(dense, trial, 1) - start - 1.3 * (dense.q - dense.a * start)).norm(),
            kRoundingOfStep);
}

TEST(WeightedPia, HalvesTheErrorOnAClosedUniformCubicWithAnEvenNumberOfPoints) {
  // Eigenvalues of A are (2 + cos) / 3, from 1/3 to 1: w = 2 / (1 + 1/3), and those of I - w A are
  // -cos / 2. The next ones are 0.354: after 20 iterations the part of their squares is 1e-6 of
  // what it was, and that may have been some hundred times the slowest part, of which smooth data
  // have little.
  const auto problem = MakeCirculantFit(8, 1);
  const SolverTrial trial(*problem, "weighted_pia", {30, -1.0});
  EXPECT_NEAR(Noted(trial, "smallest eigenvalue of A"), 1.0 / 3.0, 1e-14);
  EXPECT_NEAR(Noted(trial, "w"), 1.5, 1e-14);
  EXPECT_NEAR(Noted(trial, "spectral radius of I - w A"), 0.5, 1e-14);
  const std::vector<double>& norms = trial.context.gradient_norms();
  EXPECT_NEAR(norms[21] / norms[20], 0.5, 1e-3);
}

TEST(WeightedPia, FindsTheWeightOfManyPointsByInverseIteration) {
  // Above 100 points. Its growth settles to 1e-6; neighbours of 1/3 are (pi / 100)^2 / 6 above it.
  const SolverTrial trial(*MakeCirculantFit(200, 1), "weighted_pia", {1});
  EXPECT_GE(Noted(trial, "smallest eigenvalue of A"), 1.0 / 3.0 - 1e-12);
  EXPECT_NEAR(Noted(trial, "smallest eigenvalue of A"), 1.0 / 3.0, 1e-3);
}

TEST(LocalPia, MovesOnlyPointsAboveTheToleranceAndStopsWhenAllAreMet) {
  const auto problem = OpenInterpolation(20);
  const DenseFit dense(*problem);
  const double relative = 1e-4;
  const double tolerance = relative * problem->curve_fit()->setting().size;
  const SolverTrial trial(*problem, "local_pia/tolerance=1e-4", {1000, -1.0, false});
  EXPECT_EQ(trial.outcome.reason, StopReason::kNativeStop);
  EXPECT_THAT(trial.outcome.message, HasSubstr("every point is met"));
  bool some_stayed = false;
  for (std::size_t k = 0; k + 1 < trial.context.iterates().size(); ++k) {
    const Points p = PointsAt(dense, trial, k);
    const Points residual = dense.q - dense.a * p;
    const Points move = PointsAt(dense, trial, k + 1) - p;
    bool some_moved = false;
    for (int j = 0; j < 20; ++j) {
      const bool met = residual.row(j).norm() <= tolerance;
      (met ? some_stayed : some_moved) = true;
      const double error = met ? move.row(j).norm() : (move.row(j) - residual.row(j)).norm();
      EXPECT_LE(error, met ? 0.0 : kRoundingOfStep) << "iteration " << k << ", point " << j;
    }
    EXPECT_TRUE(some_moved) << k;
  }
  EXPECT_TRUE(some_stayed);
  EXPECT_GT(trial.iterations(), 2);
  const Points left = dense.q - dense.a * dense.PointsOf(trial.x);
  EXPECT_LE(left.rowwise().norm().maxCoeff(), tolerance * (1.0 + 1e-12));
}

TEST(LocalPia, WithoutToleranceIsGimToTheBit) {
  const auto problem = OpenInterpolation(20);
  const SolverTrial local(*problem, "local_pia/tolerance=0", {30});
  const SolverTrial gim(*problem, "gim", {30});
  EXPECT_TRUE(SameBits(local.x, gim.x));
}

/// n x m: row j has a(i, j) where i is in the group of j, else 0.
Eigen::MatrixXd Groups(const DenseFit& dense) {
  Eigen::MatrixXd groups = Eigen::MatrixXd::Zero(dense.a.cols(), dense.a.rows());
  for (Eigen::Index i = 0; i < dense.a.rows(); ++i) {
    Eigen::Index j = 0;
    const double largest = dense.a.row(i).maxCoeff(&j);
    groups(j, i) = largest;
  }
  return groups;
}

TEST(ExtendedPia, MovesByTheWeightedMeanOfEachGroupsResiduals) {
  for (const bool closed : {true, false}) {
    const auto problem = PlainFit(60, 14, closed);
    const DenseFit dense(*problem);
    const Eigen::MatrixXd groups = Groups(dense);
    const SolverTrial trial(*problem, "extended_pia", {1});
    const Points start = PointsAt(dense, trial, 0);
    const Eigen::VectorXd sums = groups.rowwise().sum();
    const Points sum_of_residuals = groups * (dense.q - dense.a * start);
    const Points expected = sums.cwiseInverse().asDiagonal() * sum_of_residuals;
    EXPECT_LT((PointsAt(dense, trial, 1) - start - expected).norm(), kRoundingOfStep);
  }
}

TEST(ExtendedPia, EndsByItselfWhereTheGroupedEquationsHold) {
  for (const bool closed : {true, false}) {
    const auto problem = PlainFit(60, 14, closed);
    const DenseFit dense(*problem);
    const Eigen::MatrixXd groups = Groups(dense);
    const SolverTrial trial(*problem, "extended_pia");
    EXPECT_EQ(trial.outcome.reason, StopReason::kNativeStop);
    // The last move is 1e-10 of the first. What is left of the grouped equations are moves times
    // sums of groups, all at most the largest group.
    const double before = (groups * (dense.q - dense.a * PointsAt(dense, trial, 0))).norm();
    const double left = (groups * (dense.q - dense.a * dense.PointsOf(trial.x))).norm();
    const Eigen::VectorXd sums = groups.rowwise().sum();
    EXPECT_LT(left, 1e-10 * before * sums.maxCoeff() / sums.minCoeff());
    // That is not the least-squares curve.
    EXPECT_GT((dense.PointsOf(trial.x) - dense.solution).norm(), 1e-3);
    EXPECT_THAT(trial.outcome.message, HasSubstr("not the least-squares curve"));
  }
}

TEST(ExtendedPia, IsGimWhereEachControlPointHasOnePoint) {
  const auto problem = MakeCirculantFit(24, 1);
  const SolverTrial extended(*problem, "extended_pia", {40, -1.0});
  const SolverTrial gim(*problem, "gim", {40, -1.0});
  ASSERT_EQ(extended.iterations(), gim.iterations());
  for (std::size_t k = 0; k <= 40; ++k) {
    EXPECT_LT((extended.context.iterates()[k] - gim.context.iterates()[k]).norm(), kRoundingOfStep)
        << k;
  }
}

TEST(PreconditionedPia, MovesByTheBandedMatrixThatIsNearestToTheInverse) {
  const int n = 20;
  const auto problem = OpenInterpolation(n);
  const DenseFit dense(*problem);
  for (const int half_width : {0, 1, 3}) {
    // Row j of M^-1 minimises |e_j' - m A| among rows with entries j - q .. j + q.
    Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(n, n);
    double row_sum = 0.0;
    for (int j = 0; j < n; ++j) {
      std::vector<int> columns;
      for (int k = j - half_width; k <= j + half_width; ++k) columns.push_back((k + n) % n);
      Eigen::MatrixXd rows(columns.size(), n);
      for (std::size_t k = 0; k < columns.size(); ++k) {
        rows.row(static_cast<Eigen::Index>(k)) = dense.a.row(columns[k]);
      }
      const Eigen::VectorXd unit = Eigen::VectorXd::Unit(n, j);
      const Eigen::VectorXd row = rows.transpose().colPivHouseholderQr().solve(unit);
      for (std::size_t k = 0; k < columns.size(); ++k) {
        inverse(j, columns[k]) = row[static_cast<Eigen::Index>(k)];
      }
      row_sum = std::max(row_sum, (unit - rows.transpose() * row).lpNorm<1>());
    }
    const SolverTrial trial(*problem, "preconditioned_pia/half_width=" + std::to_string(half_width),
                            {1});
    const Points start = PointsAt(dense, trial, 0);
    const Points expected = inverse * (dense.q - dense.a * start);
    EXPECT_LT((PointsAt(dense, trial, 1) - start - expected).norm(), kRoundingOfStep);
    EXPECT_NEAR(Noted(trial, "largest row sum of |I - M^-1 A|"), row_sum, kRoundingOfStep);
  }
}

TEST(PreconditionedPia, WithAFullInverseSolvesInOneStep) {
  for (const bool closed : {true, false}) {
    FitSpec spec = MakeSpec(3, closed, 24);
    spec.knots = KnotRule::kAveraged;
    const auto problem = MakeFit(WithoutWeights(MakeNoisyLoop(24, 2, 53)), spec);
    const DenseFit dense(*problem);
    const SolverTrial trial(*problem, "preconditioned_pia/half_width=24", {1, -1.0});
    // M^-1 is the inverse but for the condition's number of roundings; twice that.
    const double rounding = 2.0 * 24 * kEpsilon * dense.condition();
    EXPECT_LT((PointsAt(dense, trial, 1) - dense.solution).norm(), rounding);
    EXPECT_LT(Noted(trial, "largest row sum of |I - M^-1 A|"), rounding);
  }
}

TEST(PreconditionedPia, ConvergesWhereItsCertificateIsBelowOne) {
  int certified = 0;
  for (const ContractProblem& contract : InterpolationProblems()) {
    const auto problem = contract.make();
    for (const char* solver : {"preconditioned_pia/half_width=2", "preconditioned_pia",
                               "preconditioned_pia/half_width=6"}) {
      const SolverTrial trial(*problem, solver);
      const double bound = Noted(trial, "largest row sum of |I - M^-1 A|");
      // The spectral radius is below every norm.
      EXPECT_LE(Noted(trial, "spectral radius of I - M^-1 A"), bound + 1e-12) << contract.name;
      if (bound >= 1.0) continue;
      ++certified;
      if (trial.iterations() == 0) continue;  // degree 1: the start is the answer
      EXPECT_TRUE(IsSuccess(trial.outcome.reason)) << contract.name << ", " << solver;
      // Each iteration multiplies the largest error by that bound at most.
      const DenseFit dense(*problem);
      const double first = (PointsAt(dense, trial, 0) - dense.solution).cwiseAbs().maxCoeff();
      const double next = (PointsAt(dense, trial, 1) - dense.solution).cwiseAbs().maxCoeff();
      EXPECT_LE(next, bound * first + kRoundingOfStep * dense.condition()) << contract.name;
    }
  }
  EXPECT_GT(certified, 6);
}

TEST(PairedIteration, WarnsWhereTwoPointsOnOneParameterMakeTheMatrixSingular) {
  FitSpec spec = MakeSpec(3, true, 40);
  DataSet data = WithoutWeights(MakeNoisyLoop(40, 2, 9));
  data.parameters = Eigen::VectorXd(40);
  for (int i = 0; i < 40; ++i) (*data.parameters)[i] = (i == 11 ? 10 : i) / 40.0;
  spec.parameters.reset();
  spec.domain = {0.0, 1.0};
  const auto problem = MakeFit(data, spec);
  for (const char* solver :
       {"gim", "weighted_pia", "local_pia", "preconditioned_pia", "preconditioned_pia/half_width=1",
        "preconditioned_pia/half_width=8"}) {
    const SolverTrial trial(*problem, solver, {200});
    EXPECT_EQ(trial.context.notes().count("may not converge"), 1U) << solver;
    EXPECT_NE(trial.outcome.reason, StopReason::kNumericalFailure) << solver;
  }
}

}  // namespace
}  // namespace batten
