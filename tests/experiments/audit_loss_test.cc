// Robust losses in the audit: closed values, and runs that end anywhere.
#include "experiments/audit_loss.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "experiments/fit_report.h"
#include "tests/experiments/bezier_segment.h"
#include "tests/experiments/outlines.h"
#include "tests/roundoff.h"

namespace batten {
namespace {

using Kind = AuditedLoss::Kind;
using ::testing::HasSubstr;

constexpr Kind kLosses[] = {Kind::kHuber, Kind::kCauchy, Kind::kTukey, Kind::kSoftL1};

/// rho and rho' at s, with b = scale^2 = 4.
void ExpectRho(Kind kind, double s, double value, double slope) {
  const AuditedRho rho = EvaluateRho({kind, 2.0}, s);
  EXPECT_NEAR(static_cast<double>(rho.value), value, kFewRoundings * value);
  EXPECT_NEAR(static_cast<double>(rho.slope), slope, kFewRoundings);
}

TEST(EvaluateRho, IsTheClosedForm) {
  ExpectRho(Kind::kNone, 7.0, 7.0, 1.0);
  ExpectRho(Kind::kHuber, 3.0, 3.0, 1.0);
  ExpectRho(Kind::kHuber, 9.0, 8.0, 2.0 / 3);  // 2 * 2 * 3 - 4
  ExpectRho(Kind::kCauchy, 4.0, 4 * std::log(2.0), 0.5);
  ExpectRho(Kind::kTukey, 2.0, 7.0 / 6, 0.25);  // 4 / 3 * (1 - 1 / 8)
  ExpectRho(Kind::kTukey, 5.0, 4.0 / 3, 0.0);
  ExpectRho(Kind::kSoftL1, 12.0, 8.0, 0.5);  // 8 (2 - 1)
}

TEST(EvaluateRho, KeepsItsDigitsWhereTheResidualIsSmall) {
  for (const Kind kind : kLosses) ExpectRho(kind, 1e-30, 1e-30, 1.0);
}

TEST(EvaluateRho, HasTheSlopeOfItsDifferences) {
  // Central differences in long double: errors of step^2 and 1e-19 / step.
  constexpr long double kStep = 1e-6L;
  for (const Kind kind : kLosses) {
    for (const long double s : {0.0L + 2 * kStep, 0.3L, 3.9L, 4.1L, 77.0L}) {
      const AuditedLoss loss = {kind, 2.0};
      const long double slope =
          (EvaluateRho(loss, s + kStep).value - EvaluateRho(loss, s - kStep).value) / (2 * kStep);
      EXPECT_NEAR(static_cast<double>(EvaluateRho(loss, s).slope), static_cast<double>(slope),
                  1e-11);
    }
  }
}

TEST(EvaluateRho, MakesNoNumberOfNone) {
  for (const Kind kind : kLosses) {
    EXPECT_TRUE(std::isnan(EvaluateRho({kind, 1.0}, std::nan("")).value));
    EXPECT_TRUE(std::isinf(EvaluateRho({kind, 1.0}, HUGE_VAL).value));
  }
}

/// The segment at C(1/2) = (2, 15/8), from a point at distance 3 and one at 1/2.
AuditedFit Segment() {
  AuditedFit fit = BezierSegment();
  fit.points = {5, 1.875, 2, 1.375};
  fit.parameters = {0.5, 0.5};
  return fit;
}

TEST(Audit, AppliesALossToEachPoint) {
  AuditedFit fit = Segment();
  fit.weights = {4, 1};  // inside of rho: 4 * 9 = 36 and 1/4
  fit.distances = {{3.0, {Kind::kHuber, 1.0}}};
  const AuditReport report = Audit(fit);
  // 3 (2 * 6 - 1) + 3 / 4. g = 2 * 3 (4 / 6 (-3, 0) + (0, 1/2)) (1, 3, 3, 1) / 8.
  EXPECT_NEAR(report.energy, 33.75, kFewRoundings * 33.75);
  const double gradient = 6 * std::hypot(2.0, 0.5) * std::sqrt(20.0) / 8;
  EXPECT_NEAR(report.gradient_norm, gradient, kFewRoundings * gradient);
  EXPECT_EQ(report.max_distance, 3.0);  // without loss
}

TEST(Audit, AddsDistancesWithSeveralLosses) {
  AuditedFit fit = Segment();
  fit.distances = {{2.0, {}}, {1.0, {Kind::kSoftL1, 3.0}}, {5.0, {Kind::kTukey, 1.0}}};
  // s = 9 and 1/4: 2 * 9.25 + 18 (sqrt(2) - 1 + sqrt(37/36) - 1) + 5/3 (1 + 1 - 27/64).
  const double expected =
      18.5 + 18 * (std::sqrt(2.0) + std::sqrt(37.0 / 36) - 2) + 5.0 / 3 * (2 - 27.0 / 64);
  EXPECT_NEAR(Audit(fit).energy, expected, 4 * kFewRoundings * expected);
}

TEST(Audit, AppliesALossAtAnEnd) {
  AuditedFit fit = Segment();
  fit.distances = {};
  fit.ends = {{false, 1, 2.0, {3.0, 4.0}, {Kind::kCauchy, 2.0}}};  // C'(0) = (3, 6): s = 4
  EXPECT_NEAR(Audit(fit).energy, 8 * std::log(2.0), kFewRoundings * 8);
}

// The slope along t carries rho', too: C'(1/2) = (4.5, 0.75).
TEST(Audit, AppliesALossToFreeParameters) {
  AuditedFit fit = Segment();
  fit.points = {5, 1.875};
  fit.parameters = {0.5};
  fit.distances = {{1.0, {Kind::kHuber, 1.0}}};  // rho' = 1 / 3
  fit.parameter_states = {ParameterState::kMoves};
  const double by_points = 2 * std::sqrt(20.0) / 8;
  EXPECT_NEAR(Audit(fit).gradient_norm, std::hypot(by_points, 2 * 4.5), 10 * kFewRoundings);
}

/// A bow of 40 points, with weights and some far off.
DataSet Bow() {
  DataSet data;
  data.name = "bow";
  data.points.resize(40, 2);
  data.weights = Eigen::VectorXd(40);
  for (int i = 0; i < 40; ++i) {
    const double a = 0.1 * i;
    data.points.row(i) << 20 + 30 * std::cos(a), 20 * std::sin(a) + 0.5 * std::sin(7 * a);
    if (i % 9 == 4) data.points(i, 1) += 25.0 - i;
    (*data.weights)[i] = 0.25 + 0.05 * (i % 5);
  }
  return data;
}

std::unique_ptr<Problem> BowFit(ParameterKind kind, const std::string& terms) {
  FitSpec spec;
  spec.control_points = 9;
  spec.parameter_kind = kind;
  std::string error;
  EXPECT_TRUE(ParseNameSpecList(terms, &spec.terms, &error)) << error;
  auto problem = MakeFitProblem(Bow(), spec, &error);
  EXPECT_NE(problem, nullptr) << error;
  return problem;
}

void ExpectVerified(const Problem& problem, const std::string& solver) {
  for (const int iterations : {0, 3, 400}) {
    RunSpec spec;
    spec.max_iterations = iterations;
    const RunResult run = RunSolver(problem, solver.c_str(), spec);
    ASSERT_EQ(run.skipped, "");
    FitReport report = MeasureFit(problem, run, spec);
    EXPECT_TRUE(report.audited && report.audit.covers_gradient && report.verdict.holds)
        << solver << iterations << report.verdict.failure;
    for (const double factor : {1 - 1e-9, 1 + 1e-9}) {
      RunResult lie = run;
      lie.energy *= factor;
      EXPECT_THAT(MeasureFit(problem, lie, spec).verdict.failure, HasSubstr("claims energy"));
      // Later, and at starts that Huber's fit has found, |g| is not known to ten digits.
      if (iterations > 0 || run.gradient_norm < 0.01 * run.energy) continue;
      lie = run;
      lie.gradient_norm *= factor;
      EXPECT_THAT(MeasureFit(problem, lie, spec).verdict.failure, HasSubstr("claims |g|"));
    }
  }
}

TEST(MeasureFit, AuditsEveryLoss) {
  for (const std::string loss : {"huber", "cauchy", "tukey", "soft_l1"}) {
    for (const std::string scale : {"mad", "0.02", "100"}) {
      SCOPED_TRACE(loss + scale);
      const auto problem = BowFit(ParameterKind::kFixed,
                                  "interpolation/weight=3/loss=" + loss + "/loss_scale=" + scale);
      for (const char* solver : {"lbfgs", "irls:banded_qr", "ceres_lm"}) {
        ExpectVerified(*problem, solver);
      }
    }
  }
}

TEST(MeasureFit, AuditsLossesBesideOtherTerms) {
  const auto problem = BowFit(ParameterKind::kFixed,
                              "interpolation/loss=cauchy/loss_scale=0.05,interpolation/weight=0.1,"
                              "fairing/weight=1e-6,end_point/loss=huber/loss_scale=0.01,"
                              "end_tangent/units=source/loss=tukey/loss_scale=0.3");
  ExpectVerified(*problem, "lbfgs");
}

TEST(MeasureFit, AuditsLossesOfMovingParameters) {
  ExpectVerified(*BowFit(ParameterKind::kFree, "free_parameter/loss=huber/loss_scale=0.02"),
                 "lbfgs");
  ExpectVerified(*BowFit(ParameterKind::kProjected, "foot_point/loss=soft_l1/loss_scale=0.02"),
                 "lbfgs");
}

TEST(MeasureFit, CatchesAnotherScaleOfALoss) {
  const auto problem = BowFit(ParameterKind::kFixed, "interpolation/loss=cauchy/loss_scale=0.05");
  const auto other =
      BowFit(ParameterKind::kFixed, "interpolation/loss=cauchy/loss_scale=0.05000001");
  const RunResult run = RunSolver(*problem, "lbfgs", {});
  EXPECT_TRUE(MeasureFit(*problem, run, {}).verdict.holds);
  EXPECT_FALSE(MeasureFit(*other, run, {}).verdict.holds);
}

// At its Gauss points fairing with a loss is a sum of the run's own rule.
TEST(MeasureFit, DoesNotAuditFairingWithALoss) {
  const auto problem =
      BowFit(ParameterKind::kFixed, "interpolation,fairing/weight=1e-6/loss=huber/loss_scale=10");
  EXPECT_FALSE(MeasureFit(*problem, RunSolver(*problem, "lbfgs", {}), {}).audited);
}

}  // namespace
}  // namespace batten
