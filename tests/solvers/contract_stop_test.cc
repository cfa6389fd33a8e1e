#include <gtest/gtest.h>

#include <limits>

#include "solvers/stopping_context.h"
#include "tests/roundoff.h"
#include "tests/solvers/contract_cases.h"

namespace batten {
namespace {

constexpr int kNever = StoppingContext::kNever;

Outcome MinimizeFrom(const Problem& problem, const std::string& solver, StoppingContext* context,
                     Eigen::VectorXd* x) {
  Objective objective(&problem, context);
  return MakeSolver(solver)->Minimize(&objective, context, x);
}

/// Calls test(problem, solver) for the problems that the solver takes: one at least.
template <typename Test>
void ForSupported(const std::string& registered, Test test) {
  const std::vector<SupportedProblem> supported = SupportedProblems(registered);
  EXPECT_FALSE(supported.empty());
  for (const SupportedProblem& row : supported) {
    SCOPED_TRACE(row.name);
    test(*row.problem, row.solver);
  }
}

bool IsFree(const Problem& problem) {
  return problem.curve_fit()->spec().parameter_kind != ParameterKind::kFixed;
}

TEST_P(EverySolver, LeavesAtTheIterateThatSaysStop) {
  ForSupported(GetParam(), [](const Problem& problem, const std::string& solver) {
    for (const int last : {0, 1, 3}) {
      SCOPED_TRACE(last);
      StoppingContext context(last, kNever);
      Eigen::VectorXd x = StartOf(problem);
      const Outcome outcome = MinimizeFrom(problem, solver, &context, &x);
      const int num_iterates = static_cast<int>(context.iterates().size());
      EXPECT_LE(num_iterates, last + 1);
      ASSERT_GE(num_iterates, 1);
      // What has ended by itself before says something else; so does a direct method, whose second
      // iterate is its answer.
      if (outcome.reason != StopReason::kInterrupted) {
        EXPECT_TRUE(outcome.reason == StopReason::kSolved || num_iterates <= last)
            << ToString(outcome.reason);
      }
      EXPECT_EQ(context.asked_after_stop(), 0);
      EXPECT_EQ(context.booked_after_stop(), 0);
      EXPECT_TRUE(SameBits(x, context.iterates().back()));
    }
  });
}

TEST_P(EverySolver, BooksItsStartFirst) {
  ForSupported(GetParam(), [](const Problem& problem, const std::string& solver) {
    StoppingContext context(0, kNever);
    const Eigen::VectorXd start = StartOf(problem);
    Eigen::VectorXd x = start;
    MinimizeFrom(problem, solver, &context, &x);
    EXPECT_TRUE(SameBits(x, context.iterates().front()));
    if (IsFree(problem)) {
      // Set-up may look for feet, or for the control points that go with the parameters.
      TestContext judge(problem);
      EXPECT_LE(judge.Energy(x), judge.Energy(start) * (1.0 + 64 * kEpsilon));
    } else {
      EXPECT_TRUE(SameBits(x, start));
    }
  });
}

TEST_P(EverySolver, LeavesAtTheEvaluationThatIsRefused) {
  ForSupported(GetParam(), [](const Problem& problem, const std::string& solver) {
    StoppingContext all(20, kNever);
    const Eigen::VectorXd start = StartOf(problem);
    Eigen::VectorXd x = start;
    MinimizeFrom(problem, solver, &all, &x);
    for (int allowed = 0; allowed < all.num_evaluations(); ++allowed) {
      SCOPED_TRACE(allowed);
      StoppingContext context(kNever, allowed);
      x = start;
      const Outcome outcome = MinimizeFrom(problem, solver, &context, &x);
      ASSERT_TRUE(context.stopped());
      EXPECT_EQ(outcome.reason, StopReason::kInterrupted) << outcome.message;
      EXPECT_EQ(context.asked_after_stop(), 0);
      // Where a library keeps its last point to itself, it is booked on the way out.
      EXPECT_LE(context.booked_after_stop(), 1);
      const bool booked = !context.iterates().empty();
      EXPECT_TRUE(SameBits(x, booked ? context.iterates().back() : start));
    }
  });
}

TEST_P(EverySolver, RefusesAStartThatIsNotFinite) {
  ForSupported(GetParam(), [](const Problem& problem, const std::string& solver) {
    for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
      const Eigen::VectorXd start = StartOf(problem);
      // A control point, and where they are free a parameter.
      for (const Eigen::Index place : {Eigen::Index{3}, start.size() - 1}) {
        StoppingContext context(kNever, kNever);
        Eigen::VectorXd x = start;
        x[place] = bad;
        const Outcome outcome = MinimizeFrom(problem, solver, &context, &x);
        EXPECT_EQ(outcome.reason, StopReason::kNumericalFailure);
        EXPECT_FALSE(outcome.message.empty());
        EXPECT_EQ(context.num_evaluations(), 0);
        EXPECT_TRUE(context.iterates().empty());
      }
    }
  });
}

TEST_P(EverySolver, SolvesOrFailsFromAStartWhoseSquareOverflows) {
  ForSupported(GetParam(), [](const Problem& problem, const std::string& solver) {
    TestContext context(problem);
    Objective objective(&problem, &context);
    Eigen::VectorXd x = StartOf(problem);
    x.head(problem.ranges().front().size).setConstant(1e200);
    const Outcome outcome = MakeSolver(solver)->Minimize(&objective, &context, &x);
    if (outcome.reason == StopReason::kSolved) {
      EXPECT_TRUE(x.allFinite());
    } else {
      EXPECT_EQ(outcome.reason, StopReason::kNumericalFailure) << ToString(outcome.reason);
    }
  });
}

TEST_P(EverySolver, StaysAtTheMinimum) {
  ForSupported(GetParam(), [this](const Problem& problem, const std::string& solver) {
    if (IsFree(problem)) return;  // contract_free_test.cc
    const DenseFit dense(problem);
    // Judged: the first iterate already is at the rounding floor.
    TestContext judge(problem);
    Objective judged(&problem, &judge);
    Eigen::VectorXd x = dense.solution_x();
    const Outcome outcome = MakeSolver(solver)->Minimize(&judged, &judge, &x);
    EXPECT_TRUE(IsSuccess(outcome.reason)) << ToString(outcome.reason);
    EXPECT_LE(judge.iterates().size(), 2U);
    if (!SolverRegistry::Global().Find(GetParam())->limit.empty()) return;
    // Nobody stops it: it may end by itself or go on, but not go away. One rounding of each number
    // moves A P by this much.
    StoppingContext context(200, kNever);
    x = dense.solution_x();
    MinimizeFrom(problem, solver, &context, &x);
    const double rounding = 64 * kEpsilon * dense.a.norm() * dense.condition();
    for (const Eigen::VectorXd& iterate : context.iterates()) {
      ASSERT_LT(std::sqrt(dense.Gap(iterate)), rounding);
    }
  });
}

TEST_P(EverySolver, TakesAGradientThatIsExactlyZero) {
  DataSet data;
  data.points = Points::Constant(12, 2, 3.5);
  int num_supported = 0;
  for (const bool is_free : {false, true}) {
    FitSpec spec = is_free ? MakeFreeSpec(3, false, 12, "data") : MakeSpec(3, false, 12);
    spec.parameters = Parameterization::kUniform;
    const auto problem = MakeFit(data, spec);
    const std::string solver = is_free ? free_name() : name();
    if (!WhyUnsupported(*problem, solver).empty()) continue;
    ++num_supported;
    StoppingContext context(50, kNever);
    Eigen::VectorXd x = problem->start();
    const Eigen::Index size = problem->ranges().front().size;
    ASSERT_TRUE(x.head(size).isZero(0.0));
    const Outcome outcome = MinimizeFrom(*problem, solver, &context, &x);
    EXPECT_NE(outcome.reason, StopReason::kNumericalFailure) << outcome.message;
    EXPECT_TRUE(x.head(size).isZero(0.0));
    EXPECT_TRUE(x.allFinite());
  }
  EXPECT_GT(num_supported, 0);
}

}  // namespace
}  // namespace batten
