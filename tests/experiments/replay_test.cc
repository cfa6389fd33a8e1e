#include "experiments/replay.h"

#include <gmock/gmock.h>

#include <chrono>
#include <thread>

#include "tests/experiments/faulty_solvers.h"
#include "tests/experiments/outlines.h"

namespace batten {
namespace {

using ::testing::HasSubstr;

/// Evaluates E at the start moved by 0, 1, 2, ... along all axes; from call `changed` on (none if
/// negative) by `change` more.
FaultySolver::Method Walk(int steps, int changed, double change) {
  return [=](Objective* objective, RunContext* context, Eigen::VectorXd* x) -> Outcome {
    if (context->Iterate(*x) != Status::kOk) return {context->stop_reason(), ""};
    const Eigen::VectorXd start = *x;
    for (int i = 0; i < steps; ++i) {
      const double step = i + (changed >= 0 && i >= changed ? change : 0.0);
      double energy = 0.0;
      const Eigen::VectorXd point = start.array() + step;
      if (objective->Energy(point, &energy) != Status::kOk) return {context->stop_reason(), ""};
    }
    return {StopReason::kNativeStop, ""};
  };
}

Tape Record(const Problem& problem, const std::string& solver, const RunSpec& spec = {}) {
  Tape tape;
  std::string error;
  EXPECT_TRUE(RecordTape(problem, Named(solver), spec, &tape, &error)) << error;
  return tape;
}

TEST(Replay, TapeHoldsThePointsOfAWalkInTheirOrder) {
  const auto problem = LoadCatalogueProblem("rhino");
  const RegisteredSolver walk("walk", Walk(5, -1, 0.0));
  const Tape tape = Record(*problem, "walk");
  const Eigen::VectorXd start = Objective(problem.get(), nullptr).start();
  ASSERT_EQ(tape.points.size(), 5U);
  for (int i = 0; i < 5; ++i) {
    EXPECT_TRUE(tape.points[static_cast<std::size_t>(i)] == (start.array() + i).matrix()) << i;
  }
}

TEST(Replay, SolversPartExactlyWhereOneChanges) {
  const auto problem = LoadCatalogueProblem("rhino");
  const RegisteredSolver walk("walk", Walk(9, -1, 0.0));
  const RegisteredSolver turns("turns", Walk(9, 6, 0.25));
  const RegisteredSolver slips("slips", Walk(9, 4, 1e-10));
  const Tape first = Record(*problem, "walk");
  double size = 0.0;
  for (const Eigen::VectorXd& x : first.points) size = std::max(size, x.cwiseAbs().maxCoeff());

  const Parting turned = FindParting(first, Record(*problem, "turns"), 0.0);
  EXPECT_EQ(turned.index, 6U);
  EXPECT_NEAR(turned.difference, 0.25 / size, 1e-14);
  const Tape slipped = Record(*problem, "slips");
  EXPECT_EQ(FindParting(first, slipped, 0.0).index, 4U);
  EXPECT_EQ(FindParting(first, slipped, 1e-12).index, 4U);
  EXPECT_EQ(FindParting(first, slipped, 1e-8).index, Parting::kNever);
}

TEST(Replay, SolverThatIsNotRepeatablePartsFromItself) {
  const auto problem = LoadCatalogueProblem("rhino");
  int runs = 0;
  const RegisteredSolver fickle(
      "fickle", [&runs](Objective* objective, RunContext* context, Eigen::VectorXd* x) {
        return Walk(5, runs++ == 0 ? -1 : 3, 0.5)(objective, context, x);
      });
  const Tape first = Record(*problem, "fickle");
  EXPECT_EQ(FindParting(first, Record(*problem, "fickle"), 0.0).index, 3U);
}

TEST(Replay, BothFormsOfCeresEvaluateAtTheSamePointsUncompiled) {
  const auto problem = LoadCatalogueProblem("rhino");
  RunSpec spec;
  spec.compile = false;
  const Tape objective = Record(*problem, "ceres_lbfgs", spec);
  const Tape native = Record(*problem, "ceres_lbfgs/form=problem", spec);
  EXPECT_GT(objective.points.size(), 10U);
  EXPECT_EQ(objective.points.size(), native.points.size());
  EXPECT_EQ(FindParting(objective, native, 0.0).index, Parting::kNever);
}

/// Waits for `seconds` at each of `steps` evaluations, which are the tape's only requests.
FaultySolver::Method Slow(int steps, double seconds) {
  return [=](Objective* objective, RunContext* context, Eigen::VectorXd* x) -> Outcome {
    if (context->Iterate(*x) != Status::kOk) return {context->stop_reason(), ""};
    for (int i = 0; i < steps; ++i) {
      double energy = 0.0;
      std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
      if (objective->Energy(*x, &energy) != Status::kOk) return {context->stop_reason(), ""};
    }
    return {StopReason::kNativeStop, ""};
  };
}

TEST(Replay, TimeThatASolverSpendsItselfIsItsOwn) {
  const auto problem = LoadCatalogueProblem("rhino");
  const RegisteredSolver slow("slow", Slow(5, 0.01));
  const Tape tape = Record(*problem, "slow");
  EXPECT_EQ(tape.Count(Evaluation::kEnergy), 5);
  TimeSplit split;
  std::string error;
  ASSERT_TRUE(MeasureSplit(*problem, tape, {}, 3, &split, &error)) << error;
  // Sleeping takes at least what was asked for; an evaluation here takes microseconds.
  EXPECT_GE(split.solver, 0.05 - split.evaluation);
  EXPECT_GE(split.run, 0.05);
  EXPECT_LT(split.evaluation, split.solver);
}

TEST(Replay, ProductsAndGradientsOfAQuadraticAreOnTheTape) {
  const auto problem = LoadCatalogueProblem("rhino");
  const Tape tape = Record(*problem, "lbfgs");
  EXPECT_EQ(tape.Count(Evaluation::kGradient), tape.run.counts.gradient_calls);
  EXPECT_EQ(tape.Count(Evaluation::kProduct), tape.run.counts.products);
  EXPECT_GT(tape.Count(Evaluation::kProduct), 10);
  EXPECT_EQ(tape.requests.size(),
            static_cast<std::size_t>(tape.run.counts.gradient_calls + tape.run.counts.products));
}

TEST(Replay, SplitRefusesWhatIsNotRepeatable) {
  const auto problem = LoadCatalogueProblem("rhino");
  int runs = 0;
  const RegisteredSolver fickle(
      "fickle", [&runs](Objective* objective, RunContext* context, Eigen::VectorXd* x) {
        *x = x->array() + runs++;
        return Walk(2, -1, 0.0)(objective, context, x);
      });
  const Tape tape = Record(*problem, "fickle");
  TimeSplit split;
  std::string error;
  EXPECT_FALSE(MeasureSplit(*problem, tape, {}, 1, &split, &error));
  EXPECT_THAT(error, HasSubstr("fickle is not repeatable"));
}

TEST(Replay, RefusesWhatATapeDoesNotHold) {
  const auto problem = LoadCatalogueProblem("rhino");
  Tape tape;
  std::string error;
  for (const char* solver : {"banded_qr", "ceres_lm", "cg"}) {
    EXPECT_FALSE(RecordTape(*problem, Named(solver), {}, &tape, &error)) << solver;
    EXPECT_THAT(error, HasSubstr("a tape holds evaluations of E and its gradient")) << solver;
  }
}

}  // namespace
}  // namespace batten
