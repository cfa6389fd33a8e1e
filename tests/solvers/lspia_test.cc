#include "solvers/lspia.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/solvers/circulant_fit.h"
#include "tests/solvers/contract_cases.h"

namespace batten {
namespace {

using ::testing::HasSubstr;

/// (P1 - P0) = mu A'(Q - A P0), row by row.
void ExpectFirstStep(const Problem& problem, const std::string& solver, const Eigen::VectorXd& mu) {
  const DenseFit dense(problem);
  const SolverTrial trial(problem, solver, {1});
  const Points start = dense.PointsOf(problem.start());
  const Points move = dense.PointsOf(trial.context.iterates()[1]) - start;
  const Points expected = mu.asDiagonal() * (dense.a.transpose() * (dense.q - dense.a * start));
  EXPECT_LT((move - expected).norm(), 1e-13 * (1.0 + expected.norm())) << solver;
}

TEST(Lspia, StepsByTheColumnSumsOfTheCollocationMatrix) {
  for (const bool closed : {true, false}) {
    const auto problem = MakeFit(WithoutWeights(MakeNoisyLoop(40, 2, 12)), MakeSpec(3, closed, 13));
    const Eigen::VectorXd sums = DenseFit(*problem).a.colwise().sum();
    ExpectFirstStep(*problem, "lspia", sums.cwiseInverse());
    ExpectFirstStep(*problem, "lspia/relaxation=0.5", 0.5 * sums.cwiseInverse());
    ExpectFirstStep(*problem, "lspia/step=max_column",
                    Eigen::VectorXd::Constant(13, 2.0 / sums.maxCoeff()));
  }
}

TEST(Lspia, StepsInClosedFormOnAClosedUniformCubic) {
  // Column sums: one per point of a span.
  ExpectFirstStep(*MakeCirculantFit(20, 1), "lspia", Eigen::VectorXd::Ones(20));
  ExpectFirstStep(*MakeCirculantFit(20, 4), "lspia", Eigen::VectorXd::Constant(20, 0.25));
  ExpectFirstStep(*MakeCirculantFit(20, 4), "lspia/step=max_column/relaxation=0.75",
                  Eigen::VectorXd::Constant(20, 0.375));
}

TEST(Lspia, OptimalStepBalancesTheEndsOfTheSpectrum) {
  const auto problem = MakeCirculantFit(8, 1);
  const SolverTrial trial(*problem, "lspia/step=optimal");
  // 2 / (1 + 1/9) to the estimate's 1e-3; the rate is (1 - 1/9) / (1 + 1/9) = 0.8.
  const DenseFit dense(*problem);
  const Points start = dense.PointsOf(problem->start());
  const Points direction = dense.a.transpose() * (dense.q - dense.a * start);
  const Points move = dense.PointsOf(trial.context.iterates()[1]) - start;
  const double step = move.norm() / direction.norm();
  EXPECT_NEAR(step, 1.8, 1.8 * 2e-3);
  EXPECT_LT((move - step * direction).norm(), 1e-14);
  double predicted = 0.0;
  ASSERT_TRUE(ParseNumber(trial.context.notes().at("predicted rate"), &predicted));
  EXPECT_NEAR(predicted, 0.8, 2e-3);
  const std::vector<double>& norms = trial.context.gradient_norms();
  // The next eigenvalue of I - mu N is 1 - 1.8 * 0.186 = 0.666: gone after 40 steps.
  EXPECT_NEAR(norms[60] / norms[58], 0.8 * 0.8, 5e-3);
  EXPECT_GT(trial.context.count(Evaluation::kProduct), trial.iterations());  // Lanczos' too
}

TEST(Lspia, SaysThatItJumpsToAndFroWhereAnEigenvalueIsMinusOne) {
  // Column sums 2, step 2 / 2, and the largest eigenvalue of A'A is 2.
  const auto problem = Dolphin();
  const SolverTrial trial(*problem, "lspia/step=max_column");
  EXPECT_EQ(trial.outcome.reason, StopReason::kStalled);
  EXPECT_THAT(trial.outcome.message, HasSubstr("an eigenvalue of I - mu A'A is -1"));
  EXPECT_THAT(trial.outcome.message, HasSubstr("relaxation"));
  const SolverTrial relaxed(*problem, "lspia/step=max_column/relaxation=0.9", {5000});
  EXPECT_EQ(relaxed.outcome.reason, StopReason::kGradientSmall);
}

TEST(Lspia, ConvergesOnTheDolphinByItsOtherSteps) {
  const auto problem = Dolphin();
  for (const char* solver : {"lspia", "lspia/step=optimal"}) {
    EXPECT_EQ(SolverTrial(*problem, solver).outcome.reason, StopReason::kGradientSmall) << solver;
  }
}

TEST(Lspia, ConvergesWhereRowsAreNoPartitionOfUnity) {
  // Weights from 0.01 to 2000 and two terms: row sums of A are anything but 1.
  DataSet data = MakeNoisyLoop(60, 2, 13);
  for (int i = 0; i < 60; ++i) (*data.weights)[i] *= i % 3 == 0 ? 1000.0 : 0.1;
  const auto problem = MakeFit(data, MakeSpec(3, true, 12, "interpolation,interpolation/weight=7"));
  for (const char* solver :
       {"lspia", "lspia/step=max_column/relaxation=0.99", "lspia/step=optimal"}) {
    const SolverTrial trial(*problem, solver, {20000});
    EXPECT_EQ(trial.outcome.reason, StopReason::kGradientSmall) << solver;
    const std::vector<double>& norms = trial.context.gradient_norms();
    // Diagonal steps scale |g|; never does it grow much.
    EXPECT_LT(*std::max_element(norms.begin(), norms.end()), 10.0 * norms.front()) << solver;
  }
}

TEST(Lspia, EnergyNeverRises) {
  const auto problem = MakeFit(MakeNoisyLoop(60, 2, 14), MakeSpec(3, false, 20));
  const DenseFit dense(*problem);
  for (const char* solver : {"lspia", "lspia/step=max_column", "lspia/step=optimal"}) {
    const SolverTrial trial(*problem, solver, {200});
    double last = dense.Gap(trial.context.iterates().front());
    for (const Eigen::VectorXd& x : trial.context.iterates()) {
      const double gap = dense.Gap(x);
      EXPECT_LE(gap, last * (1.0 + 1e-6) + 1e-25) << solver;
      last = gap;
    }
  }
}

TEST(Lspia, AControlPointWithoutDataStaysWhereItStarts) {
  DataSet data = MakeNoisyLoop(30, 2, 15);
  Eigen::VectorXd parameters(30);
  for (int i = 0; i < 30; ++i) parameters[i] = 0.4 * i / 30.0;
  data.parameters = parameters;
  FitSpec spec = MakeSpec(3, false, 20);
  spec.parameters.reset();
  spec.domain = {0.0, 1.0};
  const auto problem = MakeFit(data, spec);
  for (const char* solver : {"lspia", "lspia/step=max_column", "lspia/step=optimal"}) {
    const SolverTrial trial(*problem, solver, {50});
    EXPECT_EQ(trial.x.tail(8), problem->start().tail(8)) << solver;
  }
}

TEST(Lspia, OptimalStepIsSafeWhereWeightsDifferByManyPowersOfTen) {
  // The small eigenproblem of the Lanczos recursion may then not converge at all.
  for (unsigned seed = 0; seed < 20; ++seed) {
    DataSet data = MakeNoisyLoop(60, 1, seed);
    for (int i = 0; i < 60; ++i) {
      (*data.weights)[i] = std::pow(10.0, 12.0 * std::sin(3.0 * i * i + seed));
    }
    FitSpec spec = MakeSpec(3, false, 17);
    spec.ends = EndKnots::kFloating;
    const auto problem = MakeFit(data, spec);
    const SolverTrial trial(*problem, "lspia/step=optimal", {300});
    const DenseFit dense(*problem);
    // A step above 2 / l1 would make the gap grow from some iteration on.
    EXPECT_LE(dense.Gap(trial.x), dense.Gap(problem->start()) * (1.0 + 1e-12)) << seed;
    const double step = 2.0 / (dense.largest * dense.largest);
    double l1 = 0.0;
    const std::string range = trial.context.notes().at("eigenvalues of A'A");
    ASSERT_TRUE(ParseNumber(range.substr(range.rfind(' ') + 1), &l1)) << range;
    EXPECT_LT(1.0 / l1, step) << seed;
  }
}

}  // namespace
}  // namespace batten
