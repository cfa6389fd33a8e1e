#include "experiments/run_control.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <ctime>
#include <thread>

#include "tests/experiments/outlines.h"

namespace batten {
namespace {

/// A solver made of one function.
class ScriptedSolver : public Solver {
 public:
  using Script = std::function<Outcome(Objective*, RunContext*, Eigen::VectorXd*)>;
  explicit ScriptedSolver(Script script) : script_(std::move(script)) {}
  SolverInfo Info() const override { return {}; }
  std::string WhyUnsupported(const Objective&) const override { return ""; }

 private:
  Outcome DoMinimize(Objective* objective, RunContext* context, Eigen::VectorXd* x) override {
    return script_(objective, context, x);
  }
  Script script_;
};

/// What Run() does, with a solver that is not registered.
RunResult RunScript(const Problem& problem, const ScriptedSolver::Script& script,
                    const RunSpec& spec = {}, NativeRule rule = NativeRule::kGradient) {
  RunResult result;
  RunControl control(problem, spec, rule, &result);
  Objective objective(&problem, &control, {spec.compile});
  Eigen::VectorXd x = objective.start();
  control.Begin();
  result.outcome = ScriptedSolver(script).Minimize(&objective, &control, &x);
  control.Finish(x);
  return result;
}

void Sleep(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

/// Works, and does not only wait, for some CPU time.
void BurnCpu(double seconds) {
  const std::clock_t begin = std::clock();
  volatile double sum = 0.0;
  while (static_cast<double>(std::clock() - begin) < seconds * CLOCKS_PER_SEC) sum = sum + 1.0;
}

TEST(RunControl, CountsEachKindOfEvaluation) {
  const auto problem = LoadCatalogueProblem("dolphin");
  const RunResult result =
      RunScript(*problem, [](Objective* objective, RunContext* context, Eigen::VectorXd* x) {
        double energy = 0.0;
        Eigen::VectorXd vector;
        SparseRows jacobian;
        objective->Energy(*x, &energy);
        objective->Energy(*x, &energy);
        objective->EnergyAndGradient(*x, &energy, &vector);
        const Eigen::VectorXd y = 2.0 * *x;
        objective->Gradient(y, &vector);
        objective->Jacobian(y, &vector, &jacobian);
        objective->HessianTimes(*x, y, &vector);
        objective->curve_view()->NormalResidual(3.0 * *x, &vector);
        Points residuals;
        objective->curve_view()->Residuals(*x, &residuals);
        objective->PartialEnergy(*x, 0, 0, 5, &energy);
        context->Iterate(*x);
        return Outcome{StopReason::kSolved, ""};
      });
  EXPECT_EQ(result.counts.energy_calls, 4);
  EXPECT_EQ(result.counts.gradient_calls, 2);
  EXPECT_EQ(result.counts.jacobian_calls, 1);
  EXPECT_EQ(result.counts.products, 3);
  EXPECT_EQ(result.counts.projections, 0);
  EXPECT_EQ(result.counts.distinct_points, 2);
}

TEST(RunControl, DoesNotCountWhatItBooks) {
  const auto problem = LoadCatalogueProblem("dolphin");
  const RunResult result =
      RunScript(*problem, [](Objective*, RunContext* context, Eigen::VectorXd* x) {
        for (int k = 0; k < 5; ++k) context->Iterate(*x);
        return Outcome{StopReason::kSolved, ""};
      });
  EXPECT_EQ(result.counts.energy_calls, 0);
  EXPECT_EQ(result.counts.gradient_calls, 0);
  EXPECT_EQ(result.counts.products, 0);
  EXPECT_EQ(result.iterations, 4);
}

// Pauses below are half a second: a busy machine may add to what runs on the clock, not so much.
constexpr double kPause = 0.5;
constexpr double kLittle = 0.25;

TEST(RunControl, ClocksStandStillForASolverThatSleepsOffTheClock) {
  const auto problem = LoadCatalogueProblem("dolphin");
  const RunResult result =
      RunScript(*problem, [](Objective* objective, RunContext* context, Eigen::VectorXd* x) {
        context->Iterate(*x);
        context->OffTheClock([&] {
          double energy = 0.0;
          objective->Energy(*x, &energy);  // books off the clock itself
          Sleep(kPause);
          objective->Energy(*x, &energy);
          BurnCpu(0.1);
        });
        return Outcome{StopReason::kSolved, ""};
      });
  EXPECT_LT(result.seconds, kLittle);
  EXPECT_LT(result.cpu_seconds, 0.05);
}

TEST(RunControl, ClocksStandStillWhileItBooks) {
  const auto problem = LoadCatalogueProblem("dolphin");
  RunSpec spec;
  spec.progress = [](const TraceRow&) { Sleep(kPause / 5); };
  const RunResult result = RunScript(
      *problem,
      [](Objective*, RunContext* context, Eigen::VectorXd* x) {
        for (int k = 0; k < 5; ++k) context->Iterate(*x);
        return Outcome{StopReason::kSolved, ""};
      },
      spec);
  EXPECT_LT(result.seconds, kLittle);
  EXPECT_LT(result.trace.back().seconds, kLittle);
}

TEST(RunControl, ClocksRunWhileASolverSteps) {
  const auto problem = LoadCatalogueProblem("dolphin");
  const RunResult result =
      RunScript(*problem, [](Objective*, RunContext* context, Eigen::VectorXd* x) {
        BurnCpu(0.03);
        context->Iterate(*x);
        for (int k = 0; k < 3; ++k) {
          BurnCpu(0.02);
          Sleep(0.01);
          context->Iterate(*x);
        }
        BurnCpu(0.02);
        return Outcome{StopReason::kSolved, ""};
      });
  EXPECT_GE(result.setup_seconds, 0.029);
  EXPECT_GE(result.seconds, 0.029 + 3 * 0.029 + 0.019);
  EXPECT_GE(result.cpu_seconds, 0.029 + 4 * 0.019);
  EXPECT_LT(result.cpu_seconds, result.seconds + 0.01);
  for (std::size_t k = 1; k < result.trace.size(); ++k) {
    EXPECT_GE(result.trace[k].seconds - result.trace[k - 1].seconds, 0.029);
  }
}

TEST(RunControl, EndsDivergedRuns) {
  const auto problem = LoadCatalogueProblem("dolphin");
  for (const double factor : {1e3, 1e150, std::nan("")}) {
    int steps = 0;
    const RunResult result =
        RunScript(*problem, [&](Objective*, RunContext* context, Eigen::VectorXd* x) {
          while (context->Iterate(*x) == Status::kOk && ++steps < 100) *x *= factor;
          return Outcome{context->stop_reason(), ""};
        });
    EXPECT_EQ(result.outcome.reason, StopReason::kDiverged) << factor;
    EXPECT_LT(steps, 10);
  }
}

TEST(RunControl, RefusesEvaluationsOnceItHasSaidStop) {
  const auto problem = LoadCatalogueProblem("dolphin");
  RunSpec spec;
  spec.max_iterations = 0;
  const RunResult result = RunScript(
      *problem,
      [](Objective* objective, RunContext* context, Eigen::VectorXd* x) {
        EXPECT_EQ(context->Iterate(*x), Status::kStop);
        double energy = 0.0;
        Eigen::VectorXd product;
        EXPECT_EQ(objective->Energy(*x, &energy), Status::kStop);
        EXPECT_EQ(objective->HessianTimes(*x, *x, &product), Status::kStop);
        return Outcome{context->stop_reason(), ""};
      },
      spec);
  EXPECT_EQ(result.outcome.reason, StopReason::kIterationLimit);
  EXPECT_EQ(result.counts.energy_calls + result.counts.products, 0);
}

TEST(RunControl, EndsARunThatOnlyEvaluatesWhenItsTimeIsUp) {
  const auto problem = LoadCatalogueProblem("dolphin");
  RunSpec spec;
  spec.max_seconds = 0.02;
  const RunResult result = RunScript(
      *problem,
      [](Objective* objective, RunContext* context, Eigen::VectorXd* x) {
        double energy = 0.0;
        while (objective->Energy(*x, &energy) == Status::kOk) continue;
        return Outcome{context->stop_reason(), ""};
      },
      spec);
  EXPECT_EQ(result.outcome.reason, StopReason::kTimeLimit);
  EXPECT_GE(result.seconds, 0.02);
}

bool InterruptEndsARun() {
  const auto problem = LoadCatalogueProblem("dolphin");
  RequestInterrupt();
  bool good = InterruptRequested();
  for (const char* solver : {"lbfgs", "cg", "banded_qr", "ceres_lbfgs", "ceres_lm"}) {
    const RunResult result = RunSolver(*problem, solver);
    good = good && result.outcome.reason == StopReason::kInterrupted && result.iterations <= 1;
  }
  return good;
}

TEST(RunControlDeathTest, AnInterruptEndsEveryRun) {
  // In a process of its own: the request stays.
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(std::exit(InterruptEndsARun() ? 0 : 1), ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace batten
