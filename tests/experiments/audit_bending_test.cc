// The audit of curvature integrals: closed values, differences, and runs that end anywhere.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "experiments/fit_report.h"
#include "tests/experiments/bezier_segment.h"
#include "tests/experiments/outlines.h"
#include "tests/roundoff.h"

namespace batten {
namespace {

using ::testing::HasSubstr;

/// y = x^2 / 2 over [0, 2] as one cubic segment: u = x / 2 runs over [0, 1].
AuditedFit Parabola() {
  AuditedFit fit = BezierSegment();
  fit.control_points = {0, 0, 2.0 / 3, 0, 4.0 / 3, 2.0 / 3, 2, 2};
  return fit;
}

// Along y = x^2 / 2 kappa = (1 + x^2)^(-3/2). With s = sin(atan x) its square is integrated to
// s - s^3 / 3, that of d kappa / d(arc) = -3 x (1 + x^2)^-3 to 9 (s^3 / 3 - 3 s^5 / 5 + 3 s^7 / 7 -
// s^9 / 9).
TEST(AuditedBending, IsTheIntegralAlongAParabola) {
  constexpr double kOfTheRule = 1e-13;  // 32 points in one span
  const double s = 2.0 / std::sqrt(5.0);
  AuditedFit fit = Parabola();
  fit.bendings = {{false, 32, 3.0, {}}};
  const double bending = 3.0 * (s - std::pow(s, 3) / 3);
  EXPECT_NEAR(Audit(fit).energy, bending, kOfTheRule * bending);
  fit.bendings = {{true, 32, 0.5, {2.0}}};
  const double variation = 9.0 * (std::pow(s, 3) / 3 - 3 * std::pow(s, 5) / 5 +
                                  3 * std::pow(s, 7) / 7 - std::pow(s, 9) / 9);
  EXPECT_NEAR(Audit(fit).energy, variation, kOfTheRule * variation);
}

// At the one point of the rule, t = 1/2 of weight 1, C' = (9/2, 3/4), C'' = (0, -15).
TEST(AuditedBending, OfOnePointIsTheCurvatureThere) {
  AuditedFit fit = BezierSegment();
  fit.bendings = {{false, 1, 1.0, {}}};
  const double expected = std::pow(4.5 * 15.0, 2) / std::pow(4.5 * 4.5 + 0.75 * 0.75, 2.5);
  EXPECT_NEAR(Audit(fit).energy, expected, kFewRoundings * expected);
}

/// A curve of degree 4 in space with spans of two lengths, and no symmetry.
AuditedFit InSpace(bool variation) {
  AuditedFit fit;
  fit.degree = 4;
  fit.dimension = 3;
  fit.knots = {0, 0, 0, 0, 0, 1, 1.5, 1.5, 1.5, 1.5, 1.5};
  fit.control_points = {0, 0, 0, 1, 2, 0.3, 2.2, 2.9, -0.7, 3.1, 1.8, 0.4, 4, 0.2, 1.9, 5, 0.1, 3};
  fit.bendings = {{variation, 5, 1.3, {0.7, 1.9}}};
  return fit;
}

TEST(AuditedBending, HasTheGradientOfItsDifferences) {
  // Central differences of an energy known to a rounding of double: errors of step^2 and 1e-16 /
  // step, relative.
  constexpr double kStep = 2e-5;
  constexpr double kTolerance = 2e-7;
  for (const bool variation : {false, true}) {
    const AuditedFit fit = InSpace(variation);
    double squared = 0.0;
    for (std::size_t k = 0; k < fit.control_points.size(); ++k) {
      AuditedFit more = fit, less = fit;
      more.control_points[k] += kStep;
      less.control_points[k] -= kStep;
      const double slope = (Audit(more).energy - Audit(less).energy) / (2 * kStep);
      squared += slope * slope;
    }
    const double norm = Audit(fit).gradient_norm;
    EXPECT_NEAR(norm, std::sqrt(squared), kTolerance * norm) << variation;
  }
}

TEST(AuditedBending, DoesNotChangeWithTheParameter) {
  for (const bool variation : {false, true}) {
    AuditedFit fit = InSpace(variation);
    const double energy = Audit(fit).energy;
    for (double& knot : fit.knots) knot = 8 * knot + 4;
    EXPECT_NEAR(Audit(fit).energy, energy, kFewRoundings * energy);
  }
}

/// 60 points around a bent loop in space or the plane, away from the origin.
std::unique_ptr<Problem> Loop(int dimension, ParameterKind kind, const std::string& terms) {
  DataSet data;
  data.name = "loop";
  data.points.resize(60, dimension);
  for (int i = 0; i < 60; ++i) {
    const double a = 2 * M_PI * i / 60;
    data.points(i, 0) = 50 + 9 * std::cos(a) + 0.5 * std::sin(5 * a);
    data.points(i, 1) = 5 * std::sin(a) + std::sin(3 * a);
    if (dimension == 3) data.points(i, 2) = std::cos(2 * a) - 7;
  }
  FitSpec spec;
  spec.degree = 4;
  spec.closed = true;
  spec.control_points = 14;
  spec.parameter_kind = kind;
  spec.span_weights.assign(14, 1.5);
  std::string error;
  EXPECT_TRUE(ParseNameSpecList(terms, &spec.terms, &error)) << error;
  auto problem = MakeFitProblem(std::move(data), spec, &error);
  EXPECT_NE(problem, nullptr) << error;
  return problem;
}

void ExpectBendingVerified(const Problem& problem, const std::string& solver) {
  for (const int iterations : {0, 3, 400}) {
    RunSpec spec;
    spec.max_iterations = iterations;
    const RunResult run = RunSolver(problem, solver.c_str(), spec);
    ASSERT_EQ(run.skipped, "");
    const FitReport report = MeasureFit(problem, run, spec);
    EXPECT_TRUE(report.audited && report.audit.covers_gradient && report.verdict.holds)
        << solver << " " << iterations << " " << report.verdict.failure;
    for (const double factor : {1 - 1e-8, 1 + 1e-8}) {
      RunResult lie = run;
      lie.energy *= factor;
      EXPECT_THAT(MeasureFit(problem, lie, spec).verdict.failure, HasSubstr("claims energy"));
    }
  }
}

TEST(MeasureFit, AuditsCurveFairing) {
  for (const int dimension : {2, 3}) {
    for (const std::string term :
         {"curve_fairing/weight=1e-4", "curve_fairing/weight=1e-7/measure=variation/points=6",
          "curve_fairing/weight=0.05/units=source",
          "curve_fairing/weight=0.01/measure=variation/units=source"}) {
      SCOPED_TRACE(term + " " + std::to_string(dimension));
      const auto problem = Loop(dimension, ParameterKind::kFixed, "interpolation," + term);
      for (const char* solver : {"lbfgs", "newton", "ceres_lm"})
        ExpectBendingVerified(*problem, solver);
    }
  }
}

TEST(MeasureFit, AuditsCurveFairingOfMovingParameters) {
  const std::string term = "curve_fairing/weight=1e-4";
  for (const char* solver : {"lbfgs", "foot_newton"}) {
    ExpectBendingVerified(*Loop(2, ParameterKind::kFree, "free_parameter," + term), solver);
  }
  ExpectBendingVerified(*Loop(2, ParameterKind::kProjected, "foot_point," + term), "newton");
}

TEST(MeasureFit, CatchesAnotherRuleOfCurveFairing) {
  const auto problem = Loop(2, ParameterKind::kFixed, "interpolation,curve_fairing/weight=1e-4");
  const auto other =
      Loop(2, ParameterKind::kFixed, "interpolation,curve_fairing/weight=1e-4/points=5");
  const RunResult run = RunSolver(*problem, "lbfgs", {});
  EXPECT_TRUE(MeasureFit(*problem, run, {}).verdict.holds);
  EXPECT_FALSE(MeasureFit(*other, run, {}).verdict.holds);
}

TEST(MeasureFit, DoesNotAuditCurveFairingWithALoss) {
  const auto problem = Loop(2, ParameterKind::kFixed,
                            "interpolation,curve_fairing/weight=1e-4/loss=huber/loss_scale=10");
  EXPECT_FALSE(MeasureFit(*problem, RunSolver(*problem, "lbfgs", {}), {}).audited);
}

}  // namespace
}  // namespace batten
