#include "experiments/audit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "experiments/fit_report.h"
#include "tests/experiments/bezier_segment.h"
#include "tests/experiments/outlines.h"
#include "tests/not_a_number.h"
#include "tests/roundoff.h"
#include "tests/solvers/test_fits.h"

namespace batten {
namespace {

using ::testing::HasSubstr;
using ::testing::MatchesRegex;

/// A uniform periodic spline on integer knots, domain [0, n), on the line.
AuditedFit PeriodicLine(int degree, std::vector<double> control_points) {
  AuditedFit fit;
  fit.degree = degree;
  fit.periodic = true;
  fit.dimension = 1;
  fit.knots.resize(control_points.size() + 2 * degree + 1);
  std::iota(fit.knots.begin(), fit.knots.end(), -degree);
  fit.control_points = std::move(control_points);
  return fit;
}

/// C(t) as the audit sees it: the distance to a far point below.
double ValueAt(AuditedFit fit, double t) {
  const double far = -64.0;  // subtracting it rounds to 64 eps at most
  fit.parameters = {t};
  fit.points = {far};
  return Audit(fit).max_distance + far;
}

TEST(Audit, KnowsTheMiddleOfABezierSegment) {
  const AuditReport report = Audit(BezierSegmentAndPoint());
  EXPECT_EQ(report.energy, 1.0 / 64);  // (15/8 - 2)^2
  EXPECT_EQ(report.rms_distance, 0.125);
  EXPECT_EQ(report.max_distance, 0.125);
  // g = 2 r (1, 3, 3, 1) / 8, r = -1/8.
  EXPECT_NEAR(report.gradient_norm, 0.25 * std::sqrt(20.0) / 8, kFewRoundings);
}

TEST(Audit, PassesThroughTheEndsOfAClampedCurve) {
  AuditedFit fit = BezierSegmentAndPoint();
  fit.parameters = {0.0, 1.0};
  fit.points = {0, 0, 4, 0};
  const AuditReport report = Audit(fit);
  EXPECT_EQ(report.energy, 0.0);
  EXPECT_EQ(report.gradient_norm, 0.0);
  EXPECT_EQ(report.max_distance, 0.0);
}

TEST(Audit, WeighsEnergyButNotDistances) {
  AuditedFit fit = BezierSegmentAndPoint();
  fit.parameters = {0.5, 0.5};
  fit.points = {2, 2, 2, 1.875 + 1};  // at distances 1/8 and 1
  fit.weights = {4, 0.5};
  const AuditReport report = Audit(fit);
  EXPECT_EQ(report.energy, 4.0 / 64 + 0.5);
  EXPECT_EQ(report.max_distance, 1.0);
  EXPECT_NEAR(report.rms_distance, std::sqrt((1.0 / 64 + 1) / 2), kFewRoundings);
}

TEST(Audit, KnowsTheUniformPeriodicCubic) {
  const AuditedFit fit = PeriodicLine(3, {5, -1, 2, 7, 3});
  const double tolerance = 128 * kEpsilon;  // of numbers up to 64 + 7
  // At knots (P0 + 4 P1 + P2) / 6, half way (P0 + 23 P1 + 23 P2 + P3) / 48.
  EXPECT_NEAR(ValueAt(fit, 0), (5 - 4 + 2) / 6.0, tolerance);
  EXPECT_NEAR(ValueAt(fit, 3), (7 + 4 * 3 + 5) / 6.0, tolerance);
  EXPECT_NEAR(ValueAt(fit, 4), (3 + 4 * 5 - 1) / 6.0, tolerance);
  EXPECT_NEAR(ValueAt(fit, 4.5), (3 + 23 * 5 - 23 + 2) / 48.0, tolerance);
}

TEST(Audit, WrapsParametersOfClosedCurves) {
  const AuditedFit fit = PeriodicLine(3, {5, -1, 2, 7, 3});
  EXPECT_EQ(ValueAt(fit, 0.25), ValueAt(fit, 5.25));
  EXPECT_EQ(ValueAt(fit, 4.5), ValueAt(fit, -0.5));
  EXPECT_EQ(ValueAt(fit, 0.0), ValueAt(fit, 10.0));
}

TEST(Audit, KnowsSplinesThatWrapOntoThemselves) {
  const double tolerance = 128 * kEpsilon;
  // One control point is the whole curve; two of degree 1 are a walk to and fro.
  EXPECT_NEAR(ValueAt(PeriodicLine(3, {2.5}), 0.3), 2.5, tolerance);
  EXPECT_NEAR(ValueAt(PeriodicLine(1, {1, 4}), 0.25), 1 + 0.75 * 0 + 0.25 * 3, tolerance);
  EXPECT_NEAR(ValueAt(PeriodicLine(1, {1, 4}), 1.25), 4 - 0.25 * 3, tolerance);
  // Cubic, n = 2: P0 stands twice in every span: (P0 + 4 P1 + P0) / 6 at 0.
  EXPECT_NEAR(ValueAt(PeriodicLine(3, {1, 4}), 0), (2 * 1 + 4 * 4) / 6.0, tolerance);
}

// Values: SciPy 1.10,
//   import numpy as np
//   from scipy.interpolate import BSpline
//   knots = [0, 0, 0, 0.2, 0.3, 0.5, 0.5, 0.9, 1, 1.4, 1.5]
//   p = 3; d = 3; n = len(knots) - p - 1
//   P = np.array([[np.cos(1.3 * j + c) + 0.1 * j * c for c in range(d)] for j in range(n)])
//   t = np.array([0.2, 0.31, 0.5, 0.62, 0.88, 0.9, 0.77])
//   Q = np.array([[np.sin(2.1 * i - c) for c in range(d)] for i in range(len(t))])
//   w = np.array([1, 0.5, 2, 0, 1.25, 3, 1])
//   A = np.array([[BSpline(knots, np.eye(n)[j], p)(x) for j in range(n)] for x in t])
//   R = A @ P - Q
//   print(repr((w[:, None] * R**2).sum()), repr(np.linalg.norm(2 * A.T @ (w[:, None] * R))),
//         repr(np.sqrt((R**2).sum(1).mean())), repr(np.sqrt((R**2).sum(1).max())))
TEST(Audit, AgreesWithSciPyOnUnevenKnotsInSpace) {
  AuditedFit fit;
  fit.degree = 3;
  fit.dimension = 3;
  fit.knots = {0, 0, 0, 0.2, 0.3, 0.5, 0.5, 0.9, 1, 1.4, 1.5};
  fit.parameters = {0.2, 0.31, 0.5, 0.62, 0.88, 0.9, 0.77};
  fit.weights = {1, 0.5, 2, 0, 1.25, 3, 1};
  for (int j = 0; j < 7; ++j) {
    for (int c = 0; c < 3; ++c) {
      fit.control_points.push_back(std::cos(1.3 * j + c) + 0.1 * j * c);
      fit.points.push_back(std::sin(2.1 * j - c));
    }
  }
  const AuditReport report = Audit(fit);
  const double tolerance = 64 * kEpsilon;  // SciPy's own sums of 21 terms
  EXPECT_NEAR(report.energy, 20.035045208575184, tolerance * report.energy);
  EXPECT_NEAR(report.gradient_norm, 9.033443658835221, tolerance * report.gradient_norm);
  EXPECT_NEAR(report.rms_distance, 1.8293265378318124, tolerance);
  EXPECT_NEAR(report.max_distance, 2.9057443289082228, tolerance);
}

/// A periodic fit of a noisy circle, away from the minimum.
AuditedFit NoisyCircle(int n, int m, double shift) {
  std::mt19937 random(20240611);
  std::uniform_real_distribution<double> noise(-0.1, 0.1);
  AuditedFit fit = PeriodicLine(3, {});
  fit.dimension = 2;
  fit.knots.resize(n + 7);
  std::iota(fit.knots.begin(), fit.knots.end(), -3.0);
  const double turn = 2 * std::acos(-1.0);
  for (int j = 0; j < n; ++j) {
    fit.control_points.push_back(shift + std::cos(turn * j / n));
    fit.control_points.push_back(std::sin(turn * j / n));
  }
  for (int i = 0; i < m; ++i) {
    fit.parameters.push_back(static_cast<double>(i) * n / m);
    fit.points.push_back(shift + std::cos(turn * i / m) + noise(random));
    fit.points.push_back(std::sin(turn * i / m) + noise(random));
  }
  return fit;
}

TEST(Audit, FloorsAreWhatRoundingOfTheControlPointsIsWorth) {
  const double turn_of_last_bit = 0.5 * kEpsilon;
  for (const double shift : {0.0, 1e6}) {
    AuditedFit fit = NoisyCircle(20, 100, shift);
    const AuditReport before = Audit(fit);
    for (double& value : fit.control_points) value *= 1 + 2 * turn_of_last_bit;
    const AuditReport after = Audit(fit);
    // All control points moved by two roundings in one direction, the data by none.
    EXPECT_LE(std::abs(after.gradient_norm - before.gradient_norm), 2 * before.gradient_floor);
    EXPECT_LE(std::abs(after.energy - before.energy), 2 * before.energy_floor);
    EXPECT_LT(before.gradient_floor, 1e-13 * (1 + shift));
    EXPECT_GT(before.gradient_floor, 1e-16 * (1 + shift));
  }
}

/// All parameters move.
AuditedFit Freed(AuditedFit fit) {
  fit.parameter_states.assign(fit.parameters.size(), ParameterState::kMoves);
  return fit;
}

TEST(Audit, TakesTheGradientInFreeParametersTimesTheLength) {
  AuditedFit fit = Freed(BezierSegmentAndPoint());
  // C'(1/2) = 3/4 (P3 + P2 - P1 - P0) = (4.5, 0.75), r = (0, -1/8): dE/dt = -0.1875.
  for (const double length : {1.0, 2.0, 1024.0}) {
    fit.length = length;
    const double by_control_points = 0.25 * std::sqrt(20.0) / 8;
    EXPECT_NEAR(Audit(fit).gradient_norm, std::hypot(by_control_points, 0.1875 / length),
                kFewRoundings);
  }
  fit.weights = {3.0};
  fit.length = 1.0;
  EXPECT_NEAR(Audit(fit).gradient_norm, 3 * std::hypot(0.25 * std::sqrt(20.0) / 8, 0.1875),
              3 * kFewRoundings);
  EXPECT_EQ(Audit(fit).pull_norm, 0.0);
}

TEST(Audit, LeavesOutParametersThatAreHeld) {
  AuditedFit fit = BezierSegmentAndPoint();
  const double fixed = Audit(fit).gradient_norm;
  fit.parameter_states = {ParameterState::kHeld};
  EXPECT_EQ(Audit(fit).gradient_norm, fixed);
  EXPECT_EQ(Audit(fit).pull_norm, 0.0);
}

// Two points on the curve: their distances of 1e-13 are what feet are certified to, no more.
TEST(Audit, BearsWhatFeetOnTheCurveAreCertifiedTo) {
  FitSpec spec = MakeSpec(3, false, 6, "foot_point");
  spec.parameter_kind = ParameterKind::kProjected;
  spec.start = "ellipse";
  DataSet data;
  data.name = "two";
  data.points.resize(2, 2);
  data.points << 0.0, 0.0, 1.0, 1.0;
  const auto problem = MakeFit(data, spec);
  for (const char* solver : {"lbfgs", "newton", "lm_schur"}) {
    const FitReport report = MeasureFit(*problem, RunSolver(*problem, solver), RunSpec());
    EXPECT_TRUE(report.audited && report.verdict.holds) << solver << ": " << report.verdict.failure;
  }
}

TEST(Audit, TellsPressedParametersPastAnEndFromThoseThatEDrawsBack) {
  // C'(0) = (3, 6), C'(1) = (3, -9).
  struct Case {
    double t;
    std::vector<double> point;
    double pull;  // 2 |C' . r| where E falls into the domain
  };
  const Case cases[] = {
      {0.0, {1, 0}, 2 * 3}, {0.0, {-1, 0}, 0}, {1.0, {3, 0}, 2 * 3}, {1.0, {4, -2}, 0}};
  for (const Case& one : cases) {
    AuditedFit fit = BezierSegmentAndPoint();
    fit.parameters = {one.t};
    fit.points = one.point;
    const double fixed = Audit(fit).gradient_norm;
    fit.parameter_states = {ParameterState::kPastEnd};
    EXPECT_EQ(Audit(fit).gradient_norm, fixed);
    EXPECT_NEAR(Audit(fit).pull_norm, one.pull, 8 * kFewRoundings);
    // At the end itself it counts, wherever it presses.
    fit.parameter_states = {ParameterState::kMoves};
    EXPECT_GT(Audit(fit).gradient_norm, fixed);
    EXPECT_EQ(Audit(fit).pull_norm, 0.0);
  }
}

TEST(Audit, TakesDegreeOneAtKnotsToTheRightAndAtTheEndToTheLeft) {
  AuditedFit fit;
  fit.degree = 1;
  fit.dimension = 1;
  fit.knots = {0, 0, 1, 3, 3};
  fit.control_points = {0, 2, 12};  // slopes 2 and 5
  const auto by_parameter = [&fit](double t, double point) {
    fit.parameters = {t};
    fit.points = {point};
    fit.parameter_states.clear();
    const double fixed = Audit(fit).gradient_norm;
    return std::sqrt(std::pow(Audit(Freed(fit)).gradient_norm, 2) - fixed * fixed);
  };
  const double tolerance = 1e3 * kEpsilon;
  EXPECT_NEAR(by_parameter(0.5, 0), 2 * 2 * 1, tolerance);
  EXPECT_NEAR(by_parameter(1.0, 0), 2 * 5 * 2, tolerance);
  EXPECT_NEAR(by_parameter(3.0, 11), 2 * 5 * 1, tolerance);
}

/// Knots without symmetry; points near the curve.
AuditedFit UnevenFit(int degree, bool periodic) {
  std::mt19937 random(20260103);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  AuditedFit fit;
  fit.degree = degree;
  fit.periodic = periodic;
  fit.dimension = 2;
  const int n = degree + 4;
  std::vector<double> steps(n);
  for (double& step : steps) step = 0.3 + uniform(random);
  fit.knots = {0.0};
  for (int k = 0; k < (periodic ? n + 2 * degree : n + degree); ++k) {
    fit.knots.push_back(fit.knots.back() + steps[k % n]);
  }
  for (int k = 0; k < 2 * n; ++k) fit.control_points.push_back(uniform(random));
  const double begin = fit.knots[degree];
  const double end = fit.knots[periodic ? n + degree : n];
  for (int i = 0; i < 30; ++i) {
    fit.parameters.push_back(begin + (end - begin) * (0.01 + 0.98 * uniform(random)));
    fit.points.push_back(uniform(random));
    fit.points.push_back(uniform(random));
    fit.weights.push_back(0.5 + uniform(random));
  }
  return fit;
}

TEST(Audit, AgreesWithDifferencesOfItsEnergyInEveryDegree) {
  const double step = std::cbrt(kEpsilon);
  for (int degree = 1; degree <= 9; ++degree) {
    for (const bool periodic : {false, true}) {
      const AuditedFit fit = UnevenFit(degree, periodic);
      double squares = 0.0;
      for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
        AuditedFit moved = fit;
        moved.parameters[i] = fit.parameters[i] + step;
        const double above = Audit(moved).energy;
        moved.parameters[i] = fit.parameters[i] - step;
        const double slope = (above - Audit(moved).energy) / (2 * step);
        squares += slope * slope;
      }
      const double by_control_points = Audit(fit).gradient_norm;
      const double expected = std::hypot(by_control_points, std::sqrt(squares));
      // Errors of step^2 and eps / step, times derivatives of some tens.
      EXPECT_NEAR(Audit(Freed(fit)).gradient_norm, expected, 1e-8 * expected) << degree << periodic;
    }
  }
}

TEST(Audit, FloorsCoverRoundingOfTheDerivativeByParameters) {
  for (const double shift : {0.0, 1e6}) {
    AuditedFit fit = Freed(NoisyCircle(20, 100, shift));
    const AuditReport before = Audit(fit);
    // Neighbours are rounded against each other: the worst for differences.
    double sign = 1.0;
    for (std::size_t k = 0; k < fit.control_points.size(); k += 2) {
      fit.control_points[k] *= 1 + sign * kEpsilon;
      fit.control_points[k + 1] *= 1 + sign * kEpsilon;
      sign = -sign;
    }
    const AuditReport after = Audit(fit);
    EXPECT_LE(std::abs(after.gradient_norm - before.gradient_norm), 2 * before.gradient_floor);
    EXPECT_LT(before.gradient_floor, 1e-13 * (1 + shift));
  }
}

Claim TrueDescent(const AuditReport& report) {
  Claim claim;
  claim.energy = report.energy;
  claim.gradient_norm = report.gradient_norm;
  claim.start_energy = 2 * report.energy;
  return claim;
}

TEST(Verify, AcceptsTheTruth) {
  const AuditReport report = Audit(NoisyCircle(20, 100, 0.0));
  const Verdict verdict = Verify(TrueDescent(report), report);
  EXPECT_TRUE(verdict.holds) << verdict.failure;
  EXPECT_EQ(verdict.failure, "");
}

TEST(Verify, AcceptsAMinimumAtTheRoundingFloor) {
  AuditedFit fit = BezierSegmentAndPoint();
  fit.parameters = {0.0, 1.0};
  fit.points = {0, 0, 4 * (1 + kEpsilon), 0};  // one rounding off
  const AuditReport report = Audit(fit);
  Claim claim = TrueDescent(report);
  claim.minimum = true;
  EXPECT_TRUE(Verify(claim, report).holds) << Verify(claim, report).failure;
}

TEST(Verify, CatchesAWrongEnergy) {
  const AuditReport report = Audit(NoisyCircle(20, 100, 0.0));
  for (const double factor : {0.5, 1 - 1e-9, 1 + 1e-9, 2.0}) {  // the factor 1/2 is an old trap
    Claim claim = TrueDescent(report);
    claim.energy *= factor;
    const Verdict verdict = Verify(claim, report);
    EXPECT_FALSE(verdict.holds) << factor;
    EXPECT_THAT(verdict.failure, MatchesRegex("claims energy .*, but the audit finds .*"));
  }
}

TEST(Verify, CatchesAWrongGradient) {
  const AuditReport report = Audit(NoisyCircle(20, 100, 0.0));
  for (const double factor : {0.0, 0.5, 1 - 1e-9, 1 + 1e-9}) {
    Claim claim = TrueDescent(report);
    claim.gradient_norm *= factor;
    const Verdict verdict = Verify(claim, report);
    EXPECT_FALSE(verdict.holds) << factor;
    EXPECT_THAT(verdict.failure, HasSubstr("claims |g|"));
  }
}

TEST(Verify, CatchesAMinimumThatWasNotReached) {
  const AuditReport report = Audit(NoisyCircle(20, 100, 0.0));
  Claim claim = TrueDescent(report);
  claim.minimum = true;
  claim.gradient_target = 0.999 * report.gradient_norm;
  EXPECT_THAT(Verify(claim, report).failure, HasSubstr("claims a minimum with |g| at most"));
  claim.gradient_target = report.gradient_norm;
  EXPECT_TRUE(Verify(claim, report).holds);
}

TEST(Verify, CatchesAMinimumAboveTheStart) {
  const AuditReport report = Audit(NoisyCircle(20, 100, 0.0));
  Claim claim = TrueDescent(report);
  claim.minimum = true;
  claim.gradient_target = report.gradient_norm;
  claim.start_energy = 0.999 * report.energy;
  EXPECT_THAT(Verify(claim, report).failure, HasSubstr("above the start's"));
  claim.start_energy = kNan;  // not known
  EXPECT_TRUE(Verify(claim, report).holds);
}

TEST(Verify, CatchesAMinimumWhoseParametersAreDrawnBackIntoTheDomain) {
  AuditedFit fit = BezierSegmentAndPoint();
  fit.parameters = {1.0};
  fit.points = {3, 0};
  fit.parameter_states = {ParameterState::kPastEnd};
  const AuditReport report = Audit(fit);
  Claim claim = TrueDescent(report);
  EXPECT_TRUE(Verify(claim, report).holds);  // it claims no minimum
  claim.minimum = true;
  claim.gradient_target = report.gradient_norm;
  EXPECT_THAT(Verify(claim, report).failure, HasSubstr("past an end"));
  fit.points = {4, -2};  // pressed outwards
  const AuditReport pressed = Audit(fit);
  claim = TrueDescent(pressed);
  claim.minimum = true;
  claim.gradient_target = pressed.gradient_norm;
  EXPECT_TRUE(Verify(claim, pressed).holds) << Verify(claim, pressed).failure;
}

TEST(Verify, CatchesNumbersThatAreNone) {
  const AuditReport report = Audit(NoisyCircle(20, 100, 0.0));
  for (const double wrong : {kNan, std::numeric_limits<double>::infinity()}) {
    Claim energy = TrueDescent(report);
    energy.energy = wrong;
    EXPECT_FALSE(Verify(energy, report).holds);
    Claim gradient = TrueDescent(report);
    gradient.gradient_norm = wrong;
    EXPECT_FALSE(Verify(gradient, report).holds);
  }
  AuditedFit broken = BezierSegmentAndPoint();
  broken.control_points[2] = kNan;
  EXPECT_FALSE(Verify(TrueDescent(report), Audit(broken)).holds);
}

TEST(Verify, LetsARunSayThatItEndedWithoutANumber) {
  AuditedFit broken = BezierSegmentAndPoint();
  broken.control_points[2] = kNan;
  Claim claim;
  claim.energy = kNan;
  claim.gradient_norm = kNan;
  EXPECT_TRUE(Verify(claim, Audit(broken)).holds);
  claim.minimum = true;
  EXPECT_FALSE(Verify(claim, Audit(broken)).holds);
}

}  // namespace
}  // namespace batten
