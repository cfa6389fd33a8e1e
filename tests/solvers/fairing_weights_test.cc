#include "solvers/fairing_weights.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "solvers/lspia.h"
#include "tests/solvers/contract_cases.h"

namespace batten {
namespace {

std::unique_ptr<Problem> FairFit(bool closed, const std::string& fairing_weight) {
  return MakeFit(MakeNoisyLoop(50, 2, 821),
                 MakeSpec(3, closed, 14,
                          "interpolation,fairing/weight=" + fairing_weight +
                              ",fairing/derivative=1/weight=" + fairing_weight));
}

/// N of the interpolation terms or of the fairing terms alone, and A'Q.
Eigen::MatrixXd NormalOf(const Problem& problem, bool fairing, Eigen::MatrixXd* right) {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(problem.curve_fit()->basis().num_control_points(),
                                              problem.curve_fit()->basis().num_control_points());
  for (const Problem::TermInstance& term : problem.terms()) {
    if ((term.name.rfind("fairing", 0) == 0) != fairing) continue;
    const NormalBand band = NormalBand::FromRows(*term.family->rows());
    sum += band.ToDense();
    if (right != nullptr) *right = band.right_hand_side();
  }
  return sum;
}

TEST(FairingWeights, ThatAreEqualGiveTheIteratesOfTheTermsWeight) {
  for (const bool closed : {false, true}) {
    const auto once = FairFit(closed, "0.001");
    const auto four = FairFit(closed, "0.004");
    const SolverTrial weighed(*once, "lspia/fairing_factor=4", {200, -1.0, false});
    const SolverTrial plain(*four, "lspia", {200, -1.0, false});
    ASSERT_GE(weighed.iterations(), 200);
    for (int k = 0; k <= 200; ++k) {
      const auto i = static_cast<std::size_t>(k);
      // The same numbers but for a few roundings per iteration, each of which contracts.
      ASSERT_LT((weighed.context.iterates()[i] - plain.context.iterates()[i]).norm(), 1e-12) << k;
    }
    const SolverTrial ones(*once, "lspia/fairing_factor=1/fairing_first=2", {50});
    const SolverTrial none(*once, "lspia", {50});
    EXPECT_TRUE(SameBits(ones.x, none.x));
  }
}

void ExpectSolves(const Problem& problem, const std::vector<double>& factors,
                  const Eigen::VectorXd& x) {
  Eigen::MatrixXd right;
  const Eigen::MatrixXd data = NormalOf(problem, false, &right);
  const Eigen::MatrixXd fairing = NormalOf(problem, true, nullptr);
  const Eigen::VectorXd f =
      Eigen::Map<const Eigen::VectorXd>(factors.data(), static_cast<Eigen::Index>(factors.size()));
  const Eigen::MatrixXd matrix = data + f.asDiagonal() * fairing;
  const Points expected = matrix.fullPivLu().solve(right);
  const Eigen::Map<const Points> found(x.data(), expected.rows(), expected.cols());
  // Moves of 1e-10 of the first one, over a rate that is 1e-4 from 1 at most.
  EXPECT_LT((found - expected).norm(), 1e-6);
}

TEST(FairingWeights, OfARangeLeadToTheSolutionOfTheirEquations) {
  for (const bool closed : {false, true}) {
    const auto problem = FairFit(closed, "0.001");
    const SolverTrial trial(*problem, "lspia/fairing_factor=30/fairing_first=3/fairing_last=7",
                            {100'000});
    EXPECT_EQ(trial.outcome.reason, StopReason::kNativeStop) << trial.outcome.message;
    std::vector<double> factors(14, 1.0);
    std::fill(factors.begin() + 3, factors.begin() + 8, 30.0);
    ExpectSolves(*problem, factors, trial.all);
    // It is another curve than the one of least energy.
    const SolverTrial least(*problem, "banded_qr");
    EXPECT_GT((trial.all - least.all).norm(), 1e-3);
  }
}

TEST(FairingWeights, MayDifferAtEachControlPoint) {
  const auto problem = FairFit(false, "0.001");
  std::vector<double> factors;
  std::mt19937 random(20240921);
  for (int j = 0; j < 14; ++j) factors.push_back(RandomBetween(0.0, 20.0, &random));
  LspiaSolver solver(factors);
  EXPECT_FALSE(solver.Info().limit.empty());
  TestContext context(*problem, {100'000});
  Objective objective(problem.get(), &context);
  Eigen::VectorXd x = objective.start();
  EXPECT_EQ(solver.Minimize(&objective, &context, &x).reason, StopReason::kNativeStop);
  ExpectSolves(*problem, factors, x);
}

TEST(FairingWeights, RefuseWhatTheyDoNotWeigh) {
  const auto plain = MakeFit(MakeNoisyLoop(50, 2, 1), MakeSpec(3, true, 17));
  EXPECT_THAT(WhyUnsupported(*plain, "lspia/fairing_factor=2"),
              ::testing::HasSubstr("there is none"));
  const auto fair = FairFit(false, "0.001");
  for (const char* step : {"optimal", "barzilai_borwein"}) {
    EXPECT_THAT(WhyUnsupported(*fair, "lspia/fairing_factor=2/step=" + std::string(step)),
                ::testing::HasSubstr("use step=diagonal"));
  }
  for (const char* range : {"fairing_first=9/fairing_last=3", "fairing_first=14"}) {
    const std::string why = WhyUnsupported(*fair, "lspia/fairing_factor=2/" + std::string(range));
    ExpectOneSentenceWithAWayOut(why, "lspia");
    EXPECT_THAT(why, ::testing::HasSubstr("none of 0 to 13"));
  }
  EXPECT_EQ(WhyUnsupported(*fair, "lspia/fairing_factor=2/fairing_first=13"), "");
  SetConstraints({HoldCurve(*fair, 0.4, 0, 0.1), HoldCurve(*fair, 0.4, 1, 0.1)}, fair.get());
  EXPECT_THAT(WhyUnsupported(*fair, "lspia/fairing_factor=2"),
              ::testing::HasSubstr("without constraints"));
  EXPECT_EQ(WhyUnsupported(*fair, "lspia"), "");
}

}  // namespace
}  // namespace batten
