#include "solvers/stall_guard.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/solvers/circulant_fit.h"
#include "tests/solvers/contract_cases.h"

namespace batten {
namespace {

using ::testing::HasSubstr;

TEST(StallGuard, EndsARunWhoseMeasureHasNoNewLeastValueAndNotBefore) {
  constexpr int kPatience = StallGuard::kPatience;
  StallGuard guard;
  EXPECT_FALSE(guard.Check(2.0).has_value());
  for (int k = 1; k < kPatience; ++k) ASSERT_FALSE(guard.Check(2.0).has_value()) << k;
  const std::optional<Outcome> outcome = guard.Check(2.0);
  ASSERT_TRUE(outcome.has_value());
  EXPECT_EQ(outcome->reason, StopReason::kStalled);
  EXPECT_THAT(outcome->message, HasSubstr(std::to_string(kPatience)));
}

TEST(StallGuard, WaitsAnewAfterEachNewLeastValue) {
  constexpr int kPatience = StallGuard::kPatience;
  StallGuard guard;
  guard.Check(2.0);
  for (int round = 0; round < 3; ++round) {
    // Rises, equal values and no numbers are all no progress.
    for (int k = 1; k < kPatience; ++k) ASSERT_FALSE(guard.Check(3.0 + k % 5).has_value());
    ASSERT_FALSE(guard.Check(1.0 - 0.1 * round).has_value());
  }
  for (int k = 1; k < kPatience; ++k) ASSERT_FALSE(guard.Check(std::nan("")).has_value());
  EXPECT_TRUE(guard.Check(std::nan("")).has_value());
}

TEST(StallGuard, GoesOnFromItsState) {
  StallGuard guard;
  guard.Check(2.0);
  for (int k = 0; k < 10; ++k) guard.Check(2.0);
  std::vector<double> state;
  guard.AppendTo(&state);
  StallGuard restored;
  restored.Restore(state.data());
  int left = 0;
  while (!restored.Check(2.0).has_value()) ++left;
  EXPECT_EQ(left, StallGuard::kPatience - 11);
}

TEST(StallGuard, EndsEveryIterationThatOnlyTurnsRoundingsOver) {
  // Errors fall by 0.8 an iteration or faster: 200 iterations to rounding, then the guard's
  // patience; a least value may still be undercut by chance now and then.
  const auto problem = MakeCirculantFit(20, 1);
  for (const char* solver :
       {"gim", "weighted_pia", "preconditioned_pia", "lspia/step=optimal", "lspia/step=cauchy",
        "lspia/step=barzilai_borwein", "jacobi_pia", "gauss_seidel_pia", "sor_pia", "polyak_lspia",
        "nesterov_lspia", "mlspia", "chebyshev_lspia", "anderson:lspia", "newton"}) {
    const SolverTrial trial(*problem, solver, {10000, -1.0, false});
    EXPECT_EQ(trial.outcome.reason, StopReason::kStalled) << solver;
    EXPECT_GE(trial.iterations(), StallGuard::kPatience) << solver;
    EXPECT_LT(trial.iterations(), 4000) << solver;
  }
}

TEST(StallGuard, LetsSlowIterationsGoOn) {
  // Far from done after three times the guard's patience.
  const auto fit = MakeFit(MakeNoisyLoop(80, 2, 71), MakeSpec(9, false, 30));
  FitSpec spec = MakeSpec(9, false, 30);
  spec.knots = KnotRule::kAveraged;
  const auto interpolation = MakeFit(WithoutWeights(MakeNoisyLoop(30, 2, 72)), spec);
  const std::string names[] = {
      "lspia", "lspia/step=optimal", "jacobi_pia",    "gauss_seidel_pia", "sor_pia/w=0.5",
      "gim",   "weighted_pia/w=1",   "randomised_pia"};
  for (const std::string& solver : names) {
    const bool paired = solver == "gim" || solver == "weighted_pia/w=1";
    const SolverTrial trial(paired ? *interpolation : *fit, solver,
                            {3 * StallGuard::kPatience, -1.0});
    EXPECT_EQ(trial.outcome.reason, StopReason::kIterationLimit) << solver;
  }
}

}  // namespace
}  // namespace batten
