// Joint solvers, those that move control points and parameters together, asked for all there is.
#include <gmock/gmock.h>

#include "experiments/fit_report.h"
#include "solvers/solver_registry.h"
#include "solvers/stepper.h"
#include "tests/experiments/outlines.h"
#include "tests/solvers/test_fits.h"

namespace batten {
namespace {

/// All that are registered and take `problem`, without those that wrap another and those that
/// search the feet in every step: these lower E(P).
std::vector<std::string> JointSolvers(const Problem& problem) {
  const Objective objective(&problem, nullptr);
  std::vector<std::string> names;
  for (const std::string& name : SolverRegistry::Global().Names()) {
    if (SolverRegistry::Global().Find(name)->wraps_solver) continue;
    std::string error;
    const auto solver = SolverRegistry::Global().Make(Named(name), nullptr, &error);
    EXPECT_NE(solver, nullptr) << error;
    if (solver == nullptr || dynamic_cast<FixedPoint*>(solver.get()) != nullptr) continue;
    if (solver->WhyUnsupported(objective).empty()) names.push_back(name);
  }
  return names;
}

/// Every one ends at the rounding floor of its gradient in (P, t), as the audit finds it, or says
/// why it goes no further. Returns how many do the first.
int CountAtFloor(const Problem& problem) {
  int at_floor = 0;
  for (const std::string& name : JointSolvers(problem)) {
    RunSpec spec = ToTheFloor();
    spec.max_iterations = 100'000;
    spec.max_seconds = 120.0;
    const RunResult run = RunSolver(problem, name, spec);
    const FitReport report = MeasureFit(problem, run, spec);
    EXPECT_TRUE(report.audited) << name;
    EXPECT_TRUE(report.verdict.holds) << name << ": " << report.verdict.failure;
    if (run.outcome.reason == StopReason::kRoundingFloor) {
      ++at_floor;
      EXPECT_LE(run.gradient_norm, run.gradient_floor) << name;
      // Either floor bounds the rounding of its own evaluator: g differs by both.
      EXPECT_LE(report.audit.gradient_norm, run.gradient_floor + report.audit.gradient_floor)
          << name;
    } else {
      EXPECT_NE(run.outcome.reason, StopReason::kIterationLimit) << name;
      EXPECT_NE(run.outcome.reason, StopReason::kTimeLimit) << name;
      EXPECT_NE(run.outcome.message, "") << name << " " << ToString(run.outcome.reason);
    }
  }
  return at_floor;
}

TEST(JointSolvers, AreAllThatMoveBoth) {
  const auto problem = MakeFit(MakeNoisyBean(60, 2, 321), MakeFreeSpec(3, true, 10));
  EXPECT_THAT(JointSolvers(*problem),
              ::testing::IsSupersetOf({"lbfgs", "ceres_lbfgs", "ceres_lm", "lm_schur", "newton",
                                       "varpro", "foot_newton"}));
}

TEST(JointSolvers, EndAtTheFloorOfTheirGradientOrSayWhyNot) {
  EXPECT_GE(CountAtFloor(*MakeFileFit("animals/rhino_100.csv", MakeFreeSpec(3, true, 12))), 3);
  EXPECT_GE(CountAtFloor(*MakeFit(MakeNoisyBean(60, 2, 321), MakeFreeSpec(3, true, 10))), 3);
}

TEST(JointSolvers, DoSoWhereTheEndsOfAnOpenCurveAreHeld) {
  FitSpec spec = MakeFreeSpec(3, false, 10, "data");
  spec.hold_ends = true;
  EXPECT_GE(CountAtFloor(*MakeFit(MakeNoisyBean(60, 2, 321), spec)), 3);
}

}  // namespace
}  // namespace batten
