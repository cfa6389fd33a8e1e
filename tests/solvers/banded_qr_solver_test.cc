#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "solvers/banded_qr.h"
#include "tests/solvers/contract_cases.h"

namespace batten {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(BandedQrSolver, ReturnsTheSplineThatTheDataComeFrom) {
  std::mt19937 random(20240606);
  for (const int degree : {1, 3, 4, 7}) {
    for (const bool closed : {true, false}) {
      FitSpec spec = MakeSpec(degree, closed, 18);
      spec.parameters = Parameterization::kUniform;
      DataSet data = WithoutWeights(MakeNoisyLoop(90, 2, 1));
      const auto pattern = MakeFit(data, spec);
      const BsplineBasis& basis = pattern->curve_fit()->basis();
      const Points control_points = RandomPoints(18, 2, &random);
      for (int i = 0; i < 90; ++i) {
        data.points.row(i).setZero();
        for (int j = 0; j < 18; ++j) {
          data.points.row(i) +=
              DenseFit::Coefficient(basis, pattern->curve_fit()->parameters()[i], j) *
              control_points.row(j);
        }
      }
      const auto problem = MakeFit(data, spec);
      // The start may be the answer: nobody judges it.
      const SolverTrial trial(*problem, "banded_qr", {10, -1.0, false});
      EXPECT_EQ(trial.outcome.reason, StopReason::kSolved);
      EXPECT_THAT(trial.outcome.message, IsEmpty());
      const double condition = DenseFit(*problem).condition();
      const Points found = problem->curve_fit()->ControlPoints(trial.x);
      EXPECT_LT((found - control_points).cwiseAbs().maxCoeff(), 64 * kEpsilon * condition)
          << degree << (closed ? " closed" : " open");
    }
  }
}

TEST(BandedQrSolver, IsOneIterationWithoutAnEvaluation) {
  const auto problem = MakeFit(MakeNoisyLoop(50, 2, 1), MakeSpec(3, true, 17));
  const SolverTrial trial(*problem, "banded_qr");
  EXPECT_EQ(trial.iterations(), 1);
  EXPECT_THAT(trial.context.evaluations(), IsEmpty());
}

TEST(BandedQrSolver, NotesTheRatioOfItsDiagonal) {
  const auto problem = MakeFit(MakeNoisyLoop(50, 2, 1), MakeSpec(3, true, 17));
  const SolverTrial trial(*problem, "banded_qr");
  double ratio = 0.0;
  ASSERT_TRUE(
      ParseNumber(trial.context.notes().at("smallest over largest diagonal entry of R"), &ratio));
  // It bounds the reciprocal condition from above.
  EXPECT_GE(ratio, 1.0 / DenseFit(*problem).condition());
  EXPECT_LE(ratio, 1.0);
}

TEST(BandedQrSolver, NamesTheRankOfADeficientFit) {
  const auto problem = MakeFit(MakeNoisyLoop(12, 2, 5), MakeSpec(3, true, 17));
  const SolverTrial trial(*problem, "banded_qr");
  EXPECT_EQ(trial.outcome.reason, StopReason::kSolved);
  EXPECT_THAT(trial.outcome.message,
              HasSubstr("the minimum is not unique: rank 12 of 17; this is the solution nearest"));
}

TEST(BandedQrSolver, KeepsItsDigitsWhereTheNormalEquationsLoseThem) {
  // Weights down to 1e-14: condition of A about 1e7, of A'A about 1e14.
  DataSet data = MakeNoisyLoop(80, 2, 21);
  for (int i = 30; i < 50; ++i) (*data.weights)[i] = 1e-14;
  const auto problem = MakeFit(data, MakeSpec(3, true, 20));
  const DenseFit dense(*problem);
  ASSERT_GT(dense.condition(), 1e6);
  ASSERT_EQ(dense.rank, 20);
  const SolverTrial trial(*problem, "banded_qr");
  EXPECT_EQ(trial.outcome.reason, StopReason::kSolved);
  EXPECT_LT((trial.x - dense.solution_x()).norm(), 16 * kEpsilon * dense.condition());
}

}  // namespace
}  // namespace batten
