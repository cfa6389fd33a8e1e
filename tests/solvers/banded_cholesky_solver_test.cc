#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "solvers/banded_cholesky.h"
#include "tests/solvers/contract_cases.h"

namespace batten {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr char kConditionNote[] = "condition of the normal equations";

std::unique_ptr<Problem> FitWithWeakSpan(double weight) {
  DataSet data = MakeNoisyLoop(80, 2, 21);
  for (int i = 30; i < 50; ++i) (*data.weights)[i] = weight;
  return MakeFit(data, MakeSpec(3, true, 20));
}

double NotedCondition(const SolverTrial& trial) {
  double condition = 0.0;
  EXPECT_TRUE(ParseNumber(trial.context.notes().at(kConditionNote), &condition));
  return condition;
}

TEST(BandedCholeskySolver, IsOneIterationWithoutAnEvaluation) {
  const auto problem = MakeFit(MakeNoisyLoop(50, 2, 1), MakeSpec(3, true, 17));
  const SolverTrial trial(*problem, "banded_cholesky");
  EXPECT_EQ(trial.iterations(), 1);
  EXPECT_THAT(trial.context.evaluations(), IsEmpty());
  EXPECT_EQ(trial.outcome.reason, StopReason::kSolved);
  EXPECT_THAT(trial.outcome.message, IsEmpty());
}

TEST(BandedCholeskySolver, NotesTheConditionOfTheNormalEquations) {
  for (const double weight : {1.0, 1e-4, 1e-9}) {
    const auto problem = FitWithWeakSpan(weight);
    const DenseFit dense(*problem);
    const Eigen::MatrixXd normal = dense.a.transpose() * dense.a;
    const auto norm1 = [](const Eigen::MatrixXd& m) {
      return m.cwiseAbs().colwise().sum().maxCoeff();
    };
    const double condition = norm1(normal) * norm1(normal.inverse());
    const double noted = NotedCondition(SolverTrial(*problem, "banded_cholesky"));
    // Hager's and Higham's estimate is a lower bound, seldom off by more than 3.
    EXPECT_LE(noted, condition * (1.0 + 1e-6));
    EXPECT_GE(noted, condition / 3.0);
  }
}

TEST(BandedCholeskySolver, SaysHowManyDigitsAreSure) {
  const auto fine = FitWithWeakSpan(1e-4);
  EXPECT_THAT(SolverTrial(*fine, "banded_cholesky").outcome.message, IsEmpty());
  const auto problem = FitWithWeakSpan(1e-11);
  const SolverTrial trial(*problem, "banded_cholesky");
  EXPECT_EQ(trial.outcome.reason, StopReason::kSolved);
  const double error = NotedCondition(trial) * kEpsilon;
  ASSERT_GT(error, 1e-8);
  const int digits = static_cast<int>(-std::log10(error));
  EXPECT_THAT(trial.outcome.message,
              HasSubstr("only " + std::to_string(digits) + " digits are sure"));
  EXPECT_THAT(trial.outcome.message, HasSubstr("banded_qr keeps more"));
  const DenseFit dense(*problem);
  EXPECT_LT((trial.x - dense.solution_x()).cwiseAbs().maxCoeff(), std::pow(10.0, -digits));
}

TEST(BandedCholeskySolver, AnswersThroughQrWhatIsSingularToWorkingPrecision) {
  for (const double weight : {1e-18, 1e-22, 0.0}) {
    const auto problem = FitWithWeakSpan(weight);
    const SolverTrial trial(*problem, "banded_cholesky");
    EXPECT_EQ(trial.outcome.reason, StopReason::kSolved);
    EXPECT_THAT(trial.outcome.message, HasSubstr("singular to working precision; solved by"));
    const SolverTrial qr(*problem, "banded_qr");
    EXPECT_TRUE(SameBits(trial.x, qr.x)) << "the same factorization";
  }
}

TEST(BandedCholeskySolver, LosesNoDigitThatTheStartHasRight) {
  // Solved for the difference from the start: from the solution it hardly moves, though the
  // condition is 1e11.
  const auto problem = FitWithWeakSpan(1e-9);
  const SolverTrial qr(*problem, "banded_qr");
  TestContext context(*problem);
  Objective objective(problem.get(), &context);
  Eigen::VectorXd x = qr.x;
  MakeSolver("banded_cholesky")->Minimize(&objective, &context, &x);
  const SolverTrial from_start(*problem, "banded_cholesky");
  EXPECT_LE((x - qr.x).norm(), (from_start.x - qr.x).norm() + 1e-9);
}

TEST(BandedCholeskySolver, GivesTheSameBitsWithAnyNumberOfThreads) {
  // Enough points for several parts.
  for (const bool closed : {false, true}) {
    const auto problem = MakeFit(MakeNoisyLoop(150000, 2, 5), MakeSpec(3, closed, 300));
    ASSERT_GT(problem->terms()[0].family->rows()->num_parts(), 3);
    const auto solve = [&](int threads) {
      TestContextOptions options;
      options.threads = threads;
      return SolverTrial(*problem, "banded_cholesky", options).x;
    };
    const Eigen::VectorXd x = solve(1);
    EXPECT_TRUE(SameBits(x, solve(2)));
    EXPECT_TRUE(SameBits(x, solve(5)));
    // The parts are all of the rows.
    const SolverTrial qr(*problem, "banded_qr");
    EXPECT_LT((x - qr.x).cwiseAbs().maxCoeff(), 1e-10);
  }
}

}  // namespace
}  // namespace batten
