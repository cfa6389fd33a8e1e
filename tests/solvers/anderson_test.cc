#include "solvers/anderson.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/solvers/circulant_fit.h"
#include "tests/solvers/contract_cases.h"

namespace batten {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

int IterationsTo(const Problem& problem, const std::string& solver, double tolerance) {
  const SolverTrial trial(problem, solver, {20000, tolerance});
  EXPECT_EQ(trial.outcome.reason, StopReason::kGradientSmall) << solver;
  return trial.iterations();
}

std::unique_ptr<Problem> InterpolatedRhino() {
  FitSpec spec = MakeSpec(3, true, 100);
  spec.knots = KnotRule::kAveraged;
  return MakeFileFit("animals/rhino_100.csv", spec);
}

TEST(Anderson, NeedsFewerIterationsThanItsBase) {
  const auto rhino = InterpolatedRhino();
  const auto dolphin = Dolphin();
  for (const auto& [problem, base] :
       {std::pair<const Problem*, std::string>(rhino.get(), "gim"), {dolphin.get(), "lspia"}}) {
    const int plain = IterationsTo(*problem, base, 1e-10);
    const int accelerated = IterationsTo(*problem, "anderson:" + base, 1e-10);
    // Measured: gim 51 and 20, lspia 341 and 74.
    EXPECT_LT(2 * accelerated, plain) << base;
  }
}

TEST(Anderson, FirstStepIsThatOfItsBaseAndTheSecondMinimisesTheResidual) {
  const auto problem = MakeFit(MakeNoisyLoop(60, 2, 61), MakeSpec(3, false, 14));
  const DenseFit dense(*problem);
  const SolverTrial plain(*problem, "lspia", {1});
  const SolverTrial trial(*problem, "anderson:lspia", {2, -1.0, false});
  const std::vector<Eigen::VectorXd>& x = trial.context.iterates();
  EXPECT_LT((x[1] - plain.context.iterates()[1]).norm(), 1e-14);
  // With one difference: gamma = f'df / df'df, x_2 = x_1 + f - gamma (dx + df).
  // Weighted rows do not sum to 1: the steps are inverse row sums of N.
  const Eigen::VectorXd sums = (dense.a.transpose() * dense.a).rowwise().sum();
  const auto f = [&](const Eigen::VectorXd& at) {
    const Points moves = sums.cwiseInverse().asDiagonal() *
                         (dense.a.transpose() * (dense.q - dense.a * dense.PointsOf(at)));
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(moves.data(), moves.size()));
  };
  const Eigen::VectorXd df = f(x[1]) - f(x[0]);
  const double gamma = f(x[1]).dot(df) / df.squaredNorm();
  const Eigen::VectorXd expected = x[1] + f(x[1]) - gamma * (x[1] - x[0] + df);
  EXPECT_LT((x[2] - expected).norm(), 1e-12);
}

TEST(Anderson, WithAWindowForAllEigenvaluesEndsLikeGmres) {
  // With 8 control points A and A'A have 5 distinct eigenvalues. That of the constant vector has no
  // part in the start's error, as the start has the data's mean. So GMRES' fourth residual is zero,
  // and Anderson's fifth point is the map of GMRES' fourth (Walker & Ni, theorem 2.2).
  const auto problem = MakeCirculantFit(8, 1);
  for (const char* base : {"gim", "lspia"}) {
    const SolverTrial trial(*problem, std::string("anderson/window=8:") + base, {50, 1e-12});
    EXPECT_EQ(trial.iterations(), 5) << base;
    const SolverTrial plain(*problem, base, {1000, 1e-12});
    EXPECT_GT(plain.iterations(), 40) << base;
  }
}

TEST(Anderson, NeverRaisesTheEnergyOfAQuadratic) {
  for (const ContractProblem& contract : LeastSquaresProblems()) {
    const auto problem = contract.make();
    const DenseFit dense(*problem);
    for (const char* solver :
         {"anderson/window=1:lspia", "anderson:lspia", "anderson/window=20:jacobi_pia",
          "anderson:lspia/step=cauchy", "anderson:gauss_seidel_pia"}) {
      const SolverTrial trial(*problem, solver, {100});
      double last = dense.Gap(trial.context.iterates().front());
      for (const Eigen::VectorXd& x : trial.context.iterates()) {
        const double gap = dense.Gap(x);
        // What the reference solution itself is off by.
        EXPECT_LE(gap, last + 1e-13 * std::sqrt(last) + 1e-26) << contract.name << ", " << solver;
        last = gap;
      }
    }
  }
}

TEST(Anderson, RefusesWhatIsNoFixedPointInOneSentence) {
  const auto problem = Dolphin();
  for (const auto& [solver, base] :
       {std::pair("anderson:lbfgs", "lbfgs is none"),
        {"anderson:cg", "cg is none"},
        {"anderson:lspia/step=barzilai_borwein", "lspia with this step is none"}}) {
    const std::string why = WhyUnsupported(*problem, solver);
    EXPECT_THAT(why, StartsWith("anderson accelerates fixed points, and ")) << solver;
    EXPECT_THAT(why, HasSubstr(base)) << solver;
    EXPECT_EQ(why.find(". "), std::string::npos) << solver;
  }
  EXPECT_EQ(WhyUnsupported(*problem, "anderson:lspia/step=cauchy"), "");
  EXPECT_THAT(WhyUnsupported(*problem, "anderson:gim"), EndsWith("control points for 80 points"));
}

TEST(Newton, OneStepEndsAtTheRoundingFloor) {
  for (const auto& problem :
       {MakeCirculantFit(20, 3), MakeFit(MakeNoisyLoop(60, 2, 65), MakeSpec(3, false, 14))}) {
    const DenseFit dense(*problem);
    const SolverTrial trial(*problem, "newton", {10, -1.0});
    EXPECT_EQ(trial.outcome.reason, StopReason::kRoundingFloor);
    EXPECT_EQ(trial.iterations(), 1);
    const double error = (dense.PointsOf(trial.x) - dense.solution).norm();
    EXPECT_LT(error, 100 * kEpsilon * dense.condition() * dense.condition());
  }
}

}  // namespace
}  // namespace batten
