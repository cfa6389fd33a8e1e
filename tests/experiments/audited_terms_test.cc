// What the audit knows beside distances: integrals of derivatives and end conditions.
#include "experiments/audited_terms.h"

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

AuditReport WithIntegral(AuditedFit fit, int derivative, double factor) {
  fit.integrals = {{derivative, factor, {}}};
  return Audit(fit);
}

// With the differences d = (1, 2), (2, 1), (1, -3) and the Gram matrix of the Bernstein polynomials
// of degree 2, (1, 1/2, 1/6; 1/2, 2/3, 1/2; 1/6, 1/2, 1) / 5: 9 / 5 * (55/3 + 2 * 2/3) = 35.4.
// Second differences a = (1, -1), b = (-1, -4): 36 (a.a + a.b + b.b) / 3 = 264. Third (-2, -3):
// 468.
TEST(AuditedIntegral, IsTheIntegralOfABezierSegment) {
  EXPECT_NEAR(WithIntegral(BezierSegment(), 1, 1.0).energy, 35.4, kFewRoundings * 35.4);
  EXPECT_NEAR(WithIntegral(BezierSegment(), 2, 0.5).energy, 132.0, kFewRoundings * 132.0);
  EXPECT_NEAR(WithIntegral(BezierSegment(), 3, 2.0).energy, 936.0, kFewRoundings * 936.0);
}

// C''' = 6 v, v = P_3 - 3 P_2 + 3 P_1 - P_0: the gradient is 72 v (-1, 3, -3, 1).
TEST(AuditedIntegral, HasTheGradientOfABezierSegment) {
  const double expected = 72.0 * std::sqrt(13.0) * std::sqrt(20.0);
  EXPECT_NEAR(WithIntegral(BezierSegment(), 3, 1.0).gradient_norm, expected,
              kFewRoundings * expected);
}

TEST(AuditedIntegral, WeighsItsSpans) {
  // C = t^2 on the line over [0, 3] in spans of 1 and 2: C'' = 2, and 4 (5 * 1 + 7 * 2) = 76.
  AuditedFit fit;
  fit.degree = 2;
  fit.dimension = 1;
  fit.knots = {0, 0, 0, 1, 3, 3, 3};
  fit.control_points = {0, 0, 3, 9};
  fit.integrals = {{2, 1.0, {5.0, 7.0}}};
  EXPECT_NEAR(Audit(fit).energy, 76.0, kFewRoundings * 76.0);
}

// C'(0) = 3 (P_1 - P_0) = (3, 6), C''(1) = 6 (P_3 - 2 P_2 + P_1) = (-6, -24), C(1) = (4, 0).
TEST(AuditedEnd, ComparesDerivativesAtTheEnds) {
  AuditedFit fit = BezierSegment();
  fit.ends = {{false, 1, 2.0, {3.0, 4.0}}};
  EXPECT_NEAR(Audit(fit).energy, 8.0, kFewRoundings * 8.0);
  fit.ends = {{true, 2, 1.0, {-5.0, -22.0}}};
  EXPECT_NEAR(Audit(fit).energy, 5.0, kFewRoundings * 5.0);
  fit.ends = {{true, 0, 1.0, {1.0, 4.0}}, {false, 0, 3.0, {0.0, 1.0}}};
  EXPECT_NEAR(Audit(fit).energy, 28.0, kFewRoundings * 28.0);
}

/// A wave of 60 points around (50, 0), given parameters on [begin, begin + length].
std::unique_ptr<Problem> Wave(bool closed, int degree, ParameterKind kind,
                              const std::vector<NameSpec>& terms, double begin, double length) {
  DataSet data;
  data.name = "wave";
  data.points.resize(60, 2);
  data.parameters = Eigen::VectorXd(60);
  for (int i = 0; i < 60; ++i) {
    const double a = 2 * M_PI * i / 60;
    (*data.parameters)[i] = begin + length * i / (closed ? 60 : 59);
    if (closed) {
      data.points.row(i) << 50 + 9 * std::cos(a), 5 * std::sin(a) + std::sin(3 * a);
    } else {
      data.points.row(i) << 50 + 3 * a, 5 * std::sin(a) + 0.3 * std::sin(9 * a);
    }
  }
  FitSpec spec;
  spec.degree = degree;
  spec.closed = closed;
  spec.control_points = 12;
  spec.parameter_kind = kind;
  if (kind == ParameterKind::kFixed) {
    spec.parameters.reset();
    spec.domain = {begin, begin + length};
  } else {
    data.parameters.reset();
  }
  spec.terms = terms;
  if (!closed) spec.span_weights.assign(static_cast<std::size_t>(12 - degree), 1.5);
  std::string error;
  auto problem = MakeFitProblem(std::move(data), spec, &error);
  EXPECT_NE(problem, nullptr) << error;
  return problem;
}

void ExpectVerified(const Problem& problem, const std::string& solver, int iterations) {
  RunSpec spec;
  spec.max_iterations = iterations;
  const RunResult run = RunSolver(problem, solver.c_str(), spec);
  const FitReport report = MeasureFit(problem, run, spec);
  EXPECT_TRUE(report.audited && report.verdict.holds) << solver << report.verdict.failure;
}

TEST(MeasureFit, AuditsFairingAndEnds) {
  const std::vector<std::string> open_terms = {"fairing/derivative=1/weight=1e-2",
                                               "fairing/weight=1e-4",
                                               "fairing/derivative=3/weight=1e-7",
                                               "fairing/units=source/weight=0.01",
                                               "end_point/weight=10",
                                               "end_tangent/weight=0.1",
                                               "end_tangent/units=source/end=begin",
                                               "end_curvature/weight=1e-3",
                                               "end_curvature/end=end/x=3/units=source",
                                               "end_point/end=begin/y=2"};
  for (const std::string& term : open_terms) {
    for (const auto& [begin, length] : {std::pair(0.0, 1.0), std::pair(1000.0, 8.0)}) {
      const auto problem = Wave(false, 4, ParameterKind::kFixed,
                                {Named("interpolation/weight=2"), Named(term)}, begin, length);
      for (const int iterations : {0, 5, 1000}) ExpectVerified(*problem, "lbfgs", iterations);
      ExpectVerified(*problem, "banded_cholesky", 1);
      if (HasFatalFailure() || HasNonfatalFailure()) FAIL() << term << begin;
    }
  }
}

TEST(MeasureFit, AuditsFairingBesideMovingParameters) {
  for (const bool closed : {false, true}) {
    const auto free = Wave(closed, 3, ParameterKind::kFree,
                           {Named("free_parameter"), Named("fairing/weight=1e-5")}, 0.0, 1.0);
    for (const char* solver : {"newton", "lm_schur", "lbfgs", "pdm"}) {
      for (const int iterations : {0, 4, 300}) ExpectVerified(*free, solver, iterations);
    }
    const auto projected = Wave(closed, 3, ParameterKind::kProjected,
                                {Named("foot_point"), Named("fairing/weight=1e-5")}, 0.0, 1.0);
    for (const int iterations : {0, 4, 300}) ExpectVerified(*projected, "newton", iterations);
  }
}

// The same run beside a problem whose term weighs a millionth more: E and g are not its own.
TEST(MeasureFit, CatchesAnotherWeightOfFairing) {
  const auto problem = Wave(false, 3, ParameterKind::kFixed,
                            {Named("interpolation"), Named("fairing/weight=1e-3")}, 0.0, 1.0);
  const auto other = Wave(false, 3, ParameterKind::kFixed,
                          {Named("interpolation"), Named("fairing/weight=1.000001e-3")}, 0.0, 1.0);
  const RunResult run = RunSolver(*problem, "banded_qr", {});
  EXPECT_TRUE(MeasureFit(*problem, run, {}).verdict.holds);
  EXPECT_FALSE(MeasureFit(*other, run, {}).verdict.holds);
}

TEST(MeasureFit, DoesNotAuditFairingAlone) {
  const auto problem =
      Wave(false, 3, ParameterKind::kFixed, {Named("fairing/weight=1e-3")}, 0.0, 1.0);
  EXPECT_FALSE(MeasureFit(*problem, RunSolver(*problem, "lbfgs", {}), {}).audited);
}

}  // namespace
}  // namespace batten
