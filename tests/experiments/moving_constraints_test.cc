// Constraints that are not linear where parameters are free or projected.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "experiments/fit_report.h"
#include "experiments/run.h"
#include "tests/solvers/test_fits.h"

namespace batten {
namespace {

/// What constraints that are not linear hold to, in units of the data's size.
constexpr double kHeldWhileMoving = 1e-10;

struct MovingCase {
  const char* name;
  bool is_closed;
  const char* constraint;
};
/// Conditions that the data do not meet by themselves, though the curve need not leave them for it.
constexpr MovingCase kMovingCases[] = {
    {"ClosedCurvature", true, "curvature/t=0.3/kappa=0.5"},
    {"ClosedPoint", true, "point/free=1/x=1.15/y=0.25"},
    {"ClosedTangent", true, "tangent/free=1/x=1/y=1"},
    {"OpenCurvature", false, "curvature/t=0.5/kappa=1.1"},
    {"OpenPoint", false, "point/free=1/x=0.1/y=0.9/z=0.4"},
    {"OpenTangent", false, "tangent/free=1/t=0.4/x=-1/y=-0.2/z=0.1"},
};

/// A closed plane curve with three bulges, or one turn of a helix.
DataSet NoisyCurve(bool is_closed) {
  constexpr int kPoints = 50;
  std::mt19937 random(20261130);
  std::normal_distribution<double> noise(0.0, is_closed ? 0.01 : 0.005);
  DataSet data;
  data.name = "noisy_curve";
  data.points.resize(kPoints, is_closed ? 2 : 3);
  for (int i = 0; i < kPoints; ++i) {
    const double a = 6.0 * (i + 0.3 * std::sin(1.7 * i)) / kPoints;
    const double radius = is_closed ? 1.0 + 0.2 * std::cos(3.0 * a) : 1.0;
    data.points(i, 0) = radius * std::cos(a) + noise(random);
    data.points(i, 1) = (is_closed ? 0.7 : 1.0) * radius * std::sin(a) + noise(random);
    if (!is_closed) data.points(i, 2) = 0.2 * a + noise(random);
  }
  return data;
}

std::unique_ptr<Problem> MovingFit(const MovingCase& of, ParameterKind kind, bool with_guard) {
  FitSpec spec = MakeSpec(3, of.is_closed, of.is_closed ? 12 : 10, DistanceTermOf(kind));
  spec.parameter_kind = kind;
  if (with_guard) spec.guard = Named("bending");
  std::string error;
  EXPECT_TRUE(ParseNameSpecList(of.constraint, &spec.constraints, &error)) << error;
  return MakeFit(NoisyCurve(of.is_closed), spec);
}

RunResult RunOn(const Problem& problem, const std::string& base, int max_iterations) {
  RunSpec spec;
  spec.max_iterations = max_iterations;
  RunResult run;
  std::string error;
  EXPECT_TRUE(Run(problem, Named("augmented_lagrangian:" + base), spec, &run, &error)) << error;
  EXPECT_EQ(run.skipped, "");
  return run;
}

void ExpectHeld(const Problem& problem, const RunResult& run) {
  const double size = problem.curve_fit()->size();
  EXPECT_LE(run.violation, kHeldWhileMoving * size);
  const FitReport report = MeasureFit(problem, run, RunSpec());
  EXPECT_TRUE(report.audited && report.verdict.holds) << report.verdict.failure;
  EXPECT_LE(report.audit.violation, kHeldWhileMoving * size);
}

class MovingConstraints
    : public ::testing::TestWithParam<std::tuple<MovingCase, ParameterKind, const char*>> {};

std::string NameOf(const ::testing::TestParamInfo<MovingConstraints::ParamType>& info) {
  const auto& [of, kind, base] = info.param;
  return std::string(of.name) + (kind == ParameterKind::kFree ? "Free_" : "Projected_") + base;
}

INSTANTIATE_TEST_SUITE_P(Bases, MovingConstraints,
                         ::testing::Combine(::testing::ValuesIn(kMovingCases),
                                            ::testing::Values(ParameterKind::kFree,
                                                              ParameterKind::kProjected),
                                            ::testing::Values("lbfgs", "ceres_lm", "ceres_lbfgs")),
                         NameOf);

TEST_P(MovingConstraints, AreHeldAtAStationaryPointOfTheLagrangian) {
  const auto& [of, kind, base] = GetParam();
  const auto problem = MovingFit(of, kind, true);
  const RunResult run = RunOn(*problem, base, 20000);
  // Ceres ends where E no longer changes measurably, its line search well before.
  constexpr double kSmall = 1e-7;
  const double most = std::string(base) == "ceres_lbfgs" ? 1e-5 : kSmall;
  EXPECT_LE(run.gradient_norm, most * run.start_gradient_norm)
      << ToString(run.outcome.reason) << " " << run.outcome.message;
  if (std::string(base) == "lbfgs") {
    EXPECT_TRUE(IsSuccess(run.outcome.reason)) << ToString(run.outcome.reason);
  }
  RecordProperty("iterations", run.iterations);
  RecordProperty("relative_gradient", NumberText(run.gradient_norm / run.start_gradient_norm));
  EXPECT_GT(run.trace.front().violation, 1e3 * kHeldWhileMoving);
  ExpectHeld(*problem, run);
}

TEST_P(MovingConstraints, AreHeldWhereALimitEndsTheRun) {
  const auto& [of, kind, base] = GetParam();
  const auto problem = MovingFit(of, kind, false);
  const RunResult run = RunOn(*problem, base, 7);
  EXPECT_EQ(run.outcome.reason, StopReason::kIterationLimit);
  EXPECT_EQ(run.iterations, 7);
  EXPECT_LT(run.energy, run.start_energy);
  ExpectHeld(*problem, run);
}

}  // namespace
}  // namespace batten
