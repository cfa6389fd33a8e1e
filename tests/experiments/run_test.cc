#include "experiments/run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "experiments/sparse_run.h"
#include "tests/experiments/outlines.h"
#include "tests/roundoff.h"
#include "tests/solvers/test_fits.h"

namespace batten {
namespace {

using ::testing::AnyOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

TEST(Run, RaceEndsWhereTheGradientHasFallenByTheTolerance) {
  const auto problem = LoadCatalogueProblem("rhino");
  for (const char* solver : {"lbfgs", "lspia", "cg"}) {
    RunSpec spec;
    spec.gradient_tolerance = 1e-7;
    const RunResult result = RunSolver(*problem, solver, spec);
    EXPECT_EQ(result.outcome.reason, StopReason::kGradientSmall);
    const double target = 1e-7 * result.start_gradient_norm;
    for (const TraceRow& row : result.trace) {
      EXPECT_EQ(row.gradient_norm <= target, row.iteration == result.iterations);
    }
  }
}

TEST(Run, WithoutATargetEndsAtTheRoundingFloor) {
  const auto problem = LoadCatalogueProblem("rhino");
  for (const char* solver : {"lbfgs", "lspia", "cg"}) {
    const RunResult result = RunSolver(*problem, solver, ToTheFloor());
    EXPECT_EQ(result.outcome.reason, StopReason::kRoundingFloor) << solver;
    EXPECT_LE(result.gradient_norm, result.gradient_floor);
    // About four roundings of sums over the data, in the user's units.
    EXPECT_LT(result.gradient_floor, 1e4 * kEpsilon * result.start_gradient_norm);
  }
}

TEST(Run, NativeEndsEachMethodByItsAuthorsRule) {
  const auto problem = LoadCatalogueProblem("rhino");
  RunSpec spec;
  spec.mode = Mode::kNative;
  const RunResult lspia = RunSolver(*problem, "lspia", spec);
  EXPECT_EQ(lspia.outcome.reason, StopReason::kStepSmall);
  EXPECT_LT(lspia.trace.back().step_norm, 1e-6);
  EXPECT_GE(lspia.trace[lspia.trace.size() - 2].step_norm, 1e-6);
  const RunResult lbfgs = RunSolver(*problem, "lbfgs", spec);
  EXPECT_EQ(lbfgs.outcome.reason, StopReason::kGradientSmall);
  EXPECT_LT(lbfgs.gradient_norm, 1e-6);
  EXPECT_GE(lbfgs.trace[lbfgs.trace.size() - 2].gradient_norm, 1e-6);
  EXPECT_EQ(RunSolver(*problem, "banded_qr", spec).outcome.reason, StopReason::kSolved);
}

TEST(Run, LimitsEndIt) {
  const auto problem = LoadCatalogueProblem("rhino");
  RunSpec spec;
  for (const int limit : {0, 1, 7}) {
    spec.max_iterations = limit;
    const RunResult result = RunSolver(*problem, "lspia", spec);
    EXPECT_EQ(result.outcome.reason, StopReason::kIterationLimit);
    EXPECT_EQ(result.iterations, limit);
    EXPECT_EQ(static_cast<int>(result.trace.size()), limit + 1);
  }
  spec = RunSpec();
  spec.max_seconds = 1e-9;
  EXPECT_EQ(RunSolver(*problem, "lspia", spec).outcome.reason, StopReason::kTimeLimit);
}

TEST(Run, TracesEveryIterationInTheUsersUnits) {
  const auto problem = LoadCatalogueProblem("cat");
  RunSpec spec;
  spec.keep_iterates = true;
  int num_progress = 0;
  spec.progress = [&](const TraceRow& row) { EXPECT_EQ(row.iteration, num_progress++); };
  const RunResult result = RunSolver(*problem, "lbfgs", spec);
  const CurveFit& fit = *problem->curve_fit();
  ASSERT_EQ(static_cast<int>(result.trace.size()), result.iterations + 1);
  ASSERT_EQ(result.iterates.size(), result.trace.size());
  EXPECT_EQ(num_progress, result.iterations + 1);
  Points before = fit.ControlPoints(problem->start());
  for (std::size_t k = 0; k < result.trace.size(); ++k) {
    const TraceRow& row = result.trace[k];
    EXPECT_EQ(row.iteration, static_cast<int>(k));
    EXPECT_EQ(result.iterates[k].iteration, static_cast<int>(k));
    const Points now = fit.ControlPoints(result.iterates[k].x);
    const Points curve = fit.Curve(result.iterates[k].x).Sample(fit.parameters());
    EXPECT_NEAR(row.energy, (curve - fit.data().points).squaredNorm(), 1e-12 * (1.0 + row.energy));
    EXPECT_NEAR(row.step_norm, (now - before).rowwise().norm().maxCoeff(), 1e-11);
    before = now;
  }
  EXPECT_EQ(result.iterates.back().x, result.x);
  EXPECT_EQ(result.trace.back().energy, result.energy);
  EXPECT_EQ(result.trace.front().energy, result.start_energy);
  EXPECT_EQ(result.trace.back().gradient_norm, result.gradient_norm);
}

TEST(RunKeepingSome, HoldsIteratesOfTheWholeRunAndChangesNothingElse) {
  const auto problem = LoadCatalogueProblem("cat");
  RunSpec spec;
  spec.keep_iterates = true;
  const RunResult whole = RunSolver(*problem, "lspia", spec);
  ASSERT_GT(whole.iterations, 50);
  NameSpec solver;
  solver.name = "lspia";
  RunResult some;
  std::string error;
  ASSERT_TRUE(RunKeepingSome(*problem, solver, RunSpec(), 9, &some, &error)) << error;
  EXPECT_EQ(some.x, whole.x);
  EXPECT_EQ(some.stream_hash, whole.stream_hash);
  ASSERT_EQ(some.iterates.size(), 9u);
  EXPECT_EQ(some.iterates.front().iteration, 0);
  EXPECT_EQ(some.iterates.back().iteration, whole.iterations);
  for (const Iterate& iterate : some.iterates) {
    EXPECT_EQ(iterate.x, whole.iterates[static_cast<std::size_t>(iterate.iteration)].x);
  }
  ASSERT_TRUE(RunKeepingSome(*problem, solver, RunSpec(), 0, &some, &error)) << error;
  EXPECT_TRUE(some.iterates.empty());
}

TEST(Run, CountsNeverFallAndEndAsInTheResult) {
  const auto problem = LoadCatalogueProblem("cat");
  for (const char* solver : {"lbfgs", "cg", "ceres_lbfgs", "ceres_lm"}) {
    const RunResult result = RunSolver(*problem, solver);
    for (std::size_t k = 1; k < result.trace.size(); ++k) {
      const Counts& a = result.trace[k - 1].counts;
      const Counts& b = result.trace[k].counts;
      EXPECT_LE(a.energy_calls, b.energy_calls);
      EXPECT_LE(a.gradient_calls, b.gradient_calls);
      EXPECT_LE(a.products, b.products);
      EXPECT_LE(a.distinct_points, b.distinct_points);
      EXPECT_LE(result.trace[k - 1].seconds, result.trace[k].seconds);
      EXPECT_LE(result.trace[k - 1].cpu_seconds, result.trace[k].cpu_seconds);
    }
    EXPECT_LE(result.counts.distinct_points,
              result.counts.energy_calls + result.counts.gradient_calls)
        << solver;
  }
}

TEST(Run, KeepsNothingThatIsNotAskedFor) {
  const auto problem = LoadCatalogueProblem("cat");
  RunSpec spec;
  spec.keep_trace = false;
  const RunResult result = RunSolver(*problem, "lbfgs", spec);
  EXPECT_THAT(result.trace, IsEmpty());
  EXPECT_THAT(result.iterates, IsEmpty());
  EXPECT_GT(result.iterations, 5);
}

TEST(Run, SplitsTheEnergyByTerms) {
  const auto problem = LoadCatalogueProblem("dolphin");
  FixedFit fit(*problem);
  std::string error;
  ASSERT_TRUE(ParseNameSpecList("interpolation,interpolation/weight=3", &fit.spec.terms, &error));
  const RunResult result = RunSolver(*fit.Make(), "cg");
  ASSERT_GT(result.trace.size(), 3U);
  for (const TraceRow& row : result.trace) {
    ASSERT_EQ(row.term_energies.size(), 2U);
    EXPECT_NEAR(row.term_energies[1], 3.0 * row.term_energies[0], 1e-12 * row.energy);
    EXPECT_NEAR(row.term_energies[0] + row.term_energies[1], row.energy, 1e-12 * row.energy);
  }
}

TEST(Run, ReachesTheSameMinimumWithoutCompilation) {
  const auto problem = LoadCatalogueProblem("cat");
  const RunResult direct = RunSolver(*problem, "banded_qr");
  const double size = problem->curve_fit()->size();
  for (const bool compile : {true, false}) {
    RunSpec spec;
    spec.compile = compile;
    spec.gradient_tolerance = 0.0;
    const RunResult result = RunSolver(*problem, "lbfgs", spec);
    EXPECT_LT((ControlPointsOf(*problem, result) - ControlPointsOf(*problem, direct))
                  .cwiseAbs()
                  .maxCoeff(),
              1e-8 * size)
        << compile;
    EXPECT_EQ(result.counts.energy_calls > 0, !compile);
  }
}

TEST(Run, SeesTheRateOfTheGeometricIteration) {
  const auto problem = LoadCatalogueProblem("rhino_interpolation");
  // The eigenvalues of I - A are 2/3 - (1 + cos a_k) / 3, a_k = 2 pi k / 100, and crowd below 2/3:
  // all |k - 50| <= 5 lie within 2/3 (1 - 0.025). In some 50 iterations they cannot be told apart,
  // and the mean rate lies among them, never above the radius.
  const double rate = RunSolver(*problem, "gim").observed_rate;
  EXPECT_LT(rate, 2.0 / 3.0 + 1e-6);
  EXPECT_GT(rate, 2.0 / 3.0 * (1.0 - 0.025));
  EXPECT_TRUE(std::isnan(RunSolver(*problem, "banded_qr").observed_rate));
  // |g| does not go to 0 where an iteration goes to a limit of its own.
  const auto rhino = LoadCatalogueProblem("rhino");
  const RunResult own = RunSolver(*rhino, "extended_pia");
  EXPECT_EQ(own.outcome.reason, StopReason::kNativeStop);
  EXPECT_TRUE(std::isnan(own.observed_rate));
  // Also where |g| has fallen far until then.
  const auto light = MakeFileFit("animals/rhino_100.csv",
                                 MakeSpec(3, true, 100, "interpolation,fairing/weight=1e-13"));
  const RunResult gim = RunSolver(*light, "gim");
  EXPECT_EQ(gim.outcome.reason, StopReason::kNativeStop);
  EXPECT_LT(gim.gradient_norm, 1e-3 * gim.start_gradient_norm);
  EXPECT_TRUE(std::isnan(gim.observed_rate));
}

TEST(Run, SaysWhatItDidNotDo) {
  const auto problem = LoadCatalogueProblem("rhino");
  const RunResult skipped = RunSolver(*problem, "gim");
  EXPECT_EQ(skipped.skipped, "gim needs 100 control points for 100 points");
  EXPECT_EQ(skipped.outcome.reason, StopReason::kNotRun);
  RunResult result;
  std::string error;
  EXPECT_FALSE(batten::Run(*problem, {"lbgfs", {}, nullptr}, {}, &result, &error));
  EXPECT_THAT(error, HasSubstr("did you mean lbfgs?"));
  EXPECT_FALSE(batten::Run(*problem, {"lbfgs", {{"memory", "2"}}, nullptr}, {}, &result, &error));
  EXPECT_THAT(error, HasSubstr("3 to 20"));
}

TEST(Run, StatesTheOptionsItReallyUsed) {
  const auto problem = LoadCatalogueProblem("dolphin");
  const RunResult result = RunSolver(*problem, "lbfgs/memory=4");
  EXPECT_EQ(result.options.at("memory"), "4");
  EXPECT_EQ(result.options.at("wolfe"), "weak");
}

TEST(Run, KnowsItsStartEvenWhereTheTimeWasUpBeforeTheSetUpWas) {
  const auto problem = LoadCatalogueProblem("rhino");
  RunSpec spec;
  spec.max_seconds = 1e-9;
  for (const char* solver : {"cg", "lbfgs", "lspia/step=optimal"}) {
    const RunResult result = RunSolver(*problem, solver, spec);
    EXPECT_EQ(result.outcome.reason, StopReason::kTimeLimit) << solver;
    EXPECT_EQ(result.start_energy, result.energy) << solver;
    EXPECT_GT(result.start_gradient_norm, 1.0) << solver;
  }
}

TEST(Run, NeedsLittleMoreThanOneEvaluationAnIterationWithoutCompilation) {
  // The line search knows how large the rounding of E is, also where E ends near zero.
  for (const char* name : {"rhino", "squirrel", "dolphin", "cat", "airfoil", "hike"}) {
    const auto problem = LoadCatalogueProblem(name);
    RunSpec spec;
    spec.compile = false;
    const RunResult result = RunSolver(*problem, "lbfgs", spec);
    EXPECT_EQ(result.outcome.reason, StopReason::kGradientSmall) << name;
    EXPECT_LE(result.counts.energy_calls, 1.2 * result.iterations + 5) << name;
  }
}

std::vector<std::string> NoteNames(const RunResult& result) {
  std::vector<std::string> names;
  for (const auto& [name, text] : result.notes) names.push_back(name);
  return names;
}

TEST(Run, WarnsOfKinksAndOfCurvesFarFromTheDataWhereParametersMove) {
  const auto rhino = LoadCatalogueProblem("rhino_free");
  FitSpec spec = rhino->curve_fit()->spec();
  RunSpec few;
  few.max_iterations = 3;
  const auto notes_on = [&](const std::string& solver) {
    std::string error;
    const auto problem = MakeFitProblem(rhino->curve_fit()->data(), spec, &error);
    EXPECT_NE(problem, nullptr) << error;
    return NoteNames(RunSolver(*problem, solver, few));
  };
  EXPECT_THAT(notes_on("newton"),
              Not(Contains(AnyOf("degree 1", "degree 2", "far from the data"))));
  spec.degree = 2;
  EXPECT_THAT(notes_on("newton"), Contains("degree 2"));
  EXPECT_THAT(notes_on("lbfgs"), Not(Contains("degree 2")));
  spec.degree = 1;
  for (const char* solver : {"newton", "lbfgs", "ceres_lm"}) {
    EXPECT_THAT(notes_on(solver), Contains("degree 1")) << solver;
  }
  spec = rhino->curve_fit()->spec();
  const CurveFit& fit = *rhino->curve_fit();
  spec.start_points = 1e7 * fit.ControlPoints(rhino->start());
  EXPECT_THAT(notes_on("lbfgs"), Contains("far from the data"));
}

TEST(Run, KeepsTheLastWordOfAWrappedSolver) {
  const auto problem = MakeFit(MakeNoisyLoop(40, 2, 11),
                               MakeSpec(3, false, 20, "interpolation/loss=huber/loss_scale=0.003"));
  // Each iteration solves rows of other weights, and notes another ratio.
  const RunResult run = RunSolver(*problem, "irls:banded_qr");
  EXPECT_GT(run.iterations, 2);
  const std::vector<std::string> names = NoteNames(run);
  EXPECT_EQ(std::count(names.begin(), names.end(), "smallest over largest diagonal entry of R"), 1);
}

TEST(Run, KnowsWhereALineSearchHasToEnd) {
  const RunResult floor = RunSolver(*LoadCatalogueProblem("rhino"), "ceres_lbfgs", ToTheFloor());
  ASSERT_EQ(floor.outcome.reason, StopReason::kLineSearchEnded);
  EXPECT_LE(floor.gradient_norm, floor.line_search_floor);
  // Scaled by 128, the largest eigenvalue of 2 N is at most 4, E 3e-4, S at most 10: the floor is
  // at most sqrt(2 * 4 * 2 * 4 eps * (2 sqrt(3e-4) 10 + 3e-4)) 128.
  EXPECT_LE(floor.line_search_floor, 9.1e-6);
  EXPECT_EQ(RunSolver(*LoadCatalogueProblem("rhino"), "lbfgs").line_search_floor, 0.0);
}

TEST(Run, BestOfTriesAllItsStartsHoweverSoonTheRunWouldBeContent) {
  const auto problem = LoadCatalogueProblem("rhino_free");
  RunSpec loose;
  loose.gradient_tolerance = 1e-4;
  RunSpec native;
  native.mode = Mode::kNative;
  for (const RunSpec& spec : {loose, native}) {
    const RunResult once = RunSolver(*problem, "foot_newton", spec);
    const RunResult best = RunSolver(*problem, "best_of/starts=6:foot_newton", spec);
    EXPECT_THAT(NoteNames(best), Contains("best start"));
    EXPECT_EQ(best.outcome.reason, StopReason::kGradientSmall);
    EXPECT_LT(best.energy, 0.8 * once.energy);
  }
  RunSpec limited;
  limited.max_iterations = 1;
  EXPECT_EQ(RunSolver(*problem, "best_of/starts=6:foot_newton", limited).outcome.reason,
            StopReason::kIterationLimit);
}

TEST(Run, SaysThatAFarStartMakesEveryGradientLookSmall) {
  FitSpec spec = LoadCatalogueProblem("rhino_free")->curve_fit()->spec();
  DataSet data = LoadCatalogueProblem("rhino_free")->curve_fit()->data();
  spec.start_points.resize(spec.control_points, 2);
  for (int j = 0; j < spec.control_points; ++j) {
    const double angle = 2.0 * M_PI * j / spec.control_points;
    spec.start_points.row(j) << 1e6 + 100.0 * std::cos(angle), 100.0 * std::sin(angle);
  }
  std::string error;
  const auto problem = MakeFitProblem(std::move(data), std::move(spec), &error);
  ASSERT_NE(problem, nullptr) << error;
  const RunResult result = RunSolver(*problem, "foot_newton", RunSpec());
  ASSERT_EQ(result.outcome.reason, StopReason::kGradientSmall);
  EXPECT_THAT(NoteNames(result), Contains("far start"));
}

}  // namespace
}  // namespace batten
