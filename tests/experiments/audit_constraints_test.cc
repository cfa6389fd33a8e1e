// Constraints in the audit: values known by hand, and runs that end anywhere.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "experiments/audit.h"
#include "experiments/fit_report.h"
#include "tests/experiments/bezier_segment.h"
#include "tests/experiments/outlines.h"
#include "tests/not_a_number.h"
#include "tests/roundoff.h"

namespace batten {
namespace {

using ::testing::HasSubstr;

/// A line from 0 to 3 under C(1/2) = 3/2, which makes P_1 follow P_0; data 1 at its begin, 5 at its
/// end: E = 5, g = (-2, -4).
AuditedFit Line() {
  AuditedFit fit;
  fit.degree = 1;
  fit.dimension = 1;
  fit.knots = {0, 0, 1, 1};
  fit.control_points = {0, 3};
  fit.points = {1, 5};
  fit.parameters = {0, 1};
  fit.equations = {{"middle", {{0.5, 0, 1.0}}, {1.0}, 1.5}};
  fit.eliminated = {1};
  return fit;
}

Claim TrueClaim(const AuditReport& report) {
  Claim claim;
  claim.energy = report.energy;
  claim.gradient_norm = report.gradient_norm;
  return claim;
}

std::string Failure(const AuditReport& report) { return Verify(TrueClaim(report), report).failure; }

TEST(Audit, TakesTheGradientInWhatIsNotEliminated) {
  // P_1 = 3 - P_0: -2 + 4. P_0 = 3 - P_1: 2 - 4. Projected: (1, -1).
  for (const int entry : {0, 1}) {
    AuditedFit fit = Line();
    fit.eliminated = {entry};
    const AuditReport report = Audit(fit);
    EXPECT_EQ(report.energy, 5.0);
    EXPECT_NEAR(report.gradient_norm, 2.0, kFewRoundings);
    EXPECT_NEAR(report.projected_gradient_norm, std::sqrt(2.0), kFewRoundings);
    EXPECT_EQ(report.missed, 0.0);
    EXPECT_EQ(Failure(report), "");
  }
}

TEST(Audit, KnowsTheProjectedGradientOfAnUnevenEquation) {
  AuditedFit fit = Line();
  fit.equations = {{"quarter", {{0.25, 0, 1.0}}, {2.0}, 1.5}};  // 3/2 P_0 + P_1 / 2 = 3/2
  // P_1 = 3 - 3 P_0: -2 + 12. Across (3, 1) / sqrt(10): g . (1, -3) / sqrt(10) = 10 / sqrt(10).
  const AuditReport report = Audit(fit);
  EXPECT_NEAR(report.gradient_norm, 10.0, 10 * kFewRoundings);
  EXPECT_NEAR(report.projected_gradient_norm, std::sqrt(10.0), 10 * kFewRoundings);
}

TEST(Audit, AllowsRepeatedEquations) {
  AuditedFit fit = Line();
  fit.equations.push_back({"twice", {{0.5, 0, 2.0}}, {1.0}, 3.0});
  EXPECT_NEAR(Audit(fit).gradient_norm, 2.0, kFewRoundings);
  EXPECT_EQ(Failure(Audit(fit)), "");
}

TEST(Verify, CatchesAConstraintThatDoesNotHold) {
  for (const double off : {1e-9, -1e-9, 1e-3}) {
    AuditedFit fit = Line();
    fit.equations[0].value += 3 * off;
    const AuditReport report = Audit(fit);
    EXPECT_NEAR(report.missed, std::abs(3 * off), kFewRoundings);
    EXPECT_THAT(Failure(report), HasSubstr("says that constraint middle holds"));
  }
}

TEST(Verify, CatchesAnotherNumberOfVariables) {
  AuditedFit fit = Line();
  fit.eliminated = {};
  EXPECT_THAT(Failure(Audit(fit)), HasSubstr("more are independent"));
  fit.eliminated = {0, 1};
  EXPECT_THAT(Failure(Audit(fit)), HasSubstr("only 1 are independent"));
  fit = Line();
  fit.degree = 1;
  fit.knots = {0, 0, 1, 2, 2};
  fit.control_points = {0, 3, 4};
  fit.eliminated = {1, 2};  // the last is in no equation
  EXPECT_THAT(Failure(Audit(fit)), HasSubstr("do not hold them"));
}

AuditReport WithCondition(const AuditedCondition& condition) {
  AuditedFit fit = BezierSegmentAndPoint();
  fit.conditions = {condition};
  return Audit(fit);
}

TEST(Audit, MeasuresConditionsAsLengths) {
  using Kind = AuditedCondition::Kind;
  const auto missed = [](const AuditedCondition& condition) {
    const AuditReport report = WithCondition(condition);
    EXPECT_FALSE(report.covers_gradient);
    EXPECT_TRUE(std::isnan(report.gradient_norm));
    EXPECT_EQ(report.energy, 1.0 / 64);
    return report.violation;
  };
  EXPECT_EQ(missed({Kind::kPoint, "", 0.5, {2.5, 1.75}, 0, 1}), 0.5);
  EXPECT_EQ(missed({Kind::kPoint, "", 0.5, {kNan, 1.75}, 0, 1}), 0.125);
  // C'(0.5) = (4.5, 0.75)
  EXPECT_NEAR(missed({Kind::kPoint, "", 0.5, {4, kNan}, 0, 1, 1}), 0.5, kFewRoundings);
  EXPECT_NEAR(missed({Kind::kPoint, "", 0.5, {4.5, 1.5}, 0, 1, 1}), 0.75, kFewRoundings);
  EXPECT_NEAR(missed({Kind::kTangent, "", 0.5, {1, 0}, 0.1, 1}), 0.75, kFewRoundings);
  EXPECT_NEAR(missed({Kind::kTangent, "", 0.5, {1, 0}, 6.0, 1}), 1.5, kFewRoundings);
  // The other way round it is as far below the least speed as it is fast.
  EXPECT_NEAR(missed({Kind::kTangent, "", 0.5, {-1, 0}, 0.5, 1}), 5.0, 4 * kFewRoundings);
  const double kappa = -67.5 / std::pow(20.25 + 0.5625, 1.5);
  EXPECT_NEAR(missed({Kind::kCurvature, "", 0.5, {}, kappa, 3}), 0.0, kFewRoundings);
  EXPECT_NEAR(missed({Kind::kCurvature, "", 0.5, {}, kappa - 0.25, 3}), 0.75, 3 * kFewRoundings);
}

TEST(Audit, MeasuresTheCurvatureOfAScrewInSpace) {
  // C = (t, t^2, t^3) has C' = (1, 0, 0), C'' = (0, 2, 0) at 0: kappa = 2.
  AuditedFit fit;
  fit.degree = 3;
  fit.dimension = 3;
  fit.knots = {0, 0, 0, 0, 1, 1, 1, 1};
  fit.control_points = {0, 0, 0, 1.0 / 3, 0, 0, 2.0 / 3, 1.0 / 3, 0, 1, 1, 1};
  fit.conditions = {{AuditedCondition::Kind::kCurvature, "", 0.0, {}, 1.0, 1.0}};
  EXPECT_NEAR(Audit(fit).violation, 1.5, 8 * kFewRoundings);  // (4 - 1) / 2
  fit.conditions[0].amount = 2.0;
  EXPECT_NEAR(Audit(fit).violation, 0.0, 8 * kFewRoundings);
}

TEST(Verify, HoldsConditionsAgainstWhatIsClaimed) {
  const AuditReport report =
      WithCondition({AuditedCondition::Kind::kPoint, "there", 0.5, {2, 1.875 + 1e-9}, 0, 1});
  Claim claim;
  claim.energy = report.energy;
  claim.gradient_norm = 123.0;  // of a Lagrangian
  EXPECT_THAT(Verify(claim, report).failure, HasSubstr("constraints are missed by 0 at most"));
  claim.violation = 1e-9;
  EXPECT_TRUE(Verify(claim, report).holds);
  claim.minimum = true;
  claim.violation_target = 1e-10;
  EXPECT_THAT(Verify(claim, report).failure, HasSubstr("there missed by 1"));
  claim.violation_target = 1e-9;
  EXPECT_TRUE(Verify(claim, report).holds);
}

/// A wave far from the origin, in the plane or in space.
DataSet Wave(int dimension, int m) {
  DataSet data;
  data.name = "wave";
  data.points.resize(m, dimension);
  for (int i = 0; i < m; ++i) {
    const double a = 6.0 * i / (m - 1);
    data.points(i, 0) = 500 + 7 * a;
    data.points(i, 1) = 9 * std::sin(a) + 0.3 * std::cos(11 * a);
    if (dimension > 2) data.points(i, 2) = 5 * std::cos(1.7 * a);
  }
  return data;
}

std::unique_ptr<Problem> WaveFit(int dimension, const std::string& constraints, FitSpec spec) {
  spec.degree = 4;
  spec.control_points = 11;
  std::string error;
  EXPECT_TRUE(ParseNameSpecList(constraints, &spec.constraints, &error)) << error;
  auto problem = MakeFitProblem(Wave(dimension, 50), spec, &error);
  EXPECT_NE(problem, nullptr) << error;
  return problem;
}

/// An honest run is verified wherever it ends; one that lies, or has left its constraints, is not.
void ExpectAudited(const Problem& problem, const std::string& solver) {
  for (const int iterations : {0, 3, 500}) {
    SCOPED_TRACE(problem.curve_fit()->spec().constraints[0].ToString() + " " + solver);
    RunSpec spec;
    spec.max_iterations = iterations;
    RunResult run = RunSolver(problem, solver.c_str(), spec);
    ASSERT_EQ(run.skipped, "");
    const FitReport report = MeasureFit(problem, run, spec);
    EXPECT_TRUE(report.audited && report.audit.covers_gradient && report.verdict.holds)
        << report.verdict.failure;
    EXPECT_LE(report.audit.projected_gradient_norm, report.audit.gradient_norm * (1 + 1e-9));
    RunResult lie = run;
    lie.energy *= 1 + 1e-9;
    EXPECT_THAT(MeasureFit(problem, lie, spec).verdict.failure, HasSubstr("claims energy"));
    // Later, and at starts that Huber's fit has found, |g| is not known to ten digits.
    if (iterations == 0 && run.gradient_norm > 0.01 * run.energy) {
      lie = run;
      lie.gradient_norm *= 1 + 1e-9;
      EXPECT_THAT(MeasureFit(problem, lie, spec).verdict.failure, HasSubstr("claims |g|"));
    }
    // One that follows others, moved by 1e-9 of the data's size (1/2 to 1 inside) and more.
    for (int entry = 0; entry < problem.ranges().front().size; ++entry) {
      const std::vector<int>& stay = problem.elimination().free();
      if (std::find(stay.begin(), stay.end(), entry) != stay.end()) continue;
      lie = run;
      lie.x[entry] += 1e-9;
      const AuditReport moved = MeasureFit(problem, lie, spec).audit;
      Claim claim;
      claim.energy = moved.energy;
      claim.gradient_norm = moved.gradient_norm;
      EXPECT_THAT(Verify(claim, moved).failure, HasSubstr("holds, but the audit finds it missed"))
          << entry;
    }
  }
}

constexpr const char* kLinear[] = {"ends",
                                   "point/t=0.37/x=518/y=3",
                                   "point/t=0.5/y=2,point/t=0.51/y=2.1,point/t=0.52/y=2.15",
                                   "derivative/t=0.25/order=2/x=3/y=-4",
                                   "natural,ends/end=begin",
                                   "clamped/end=begin,clamped/end=end/x=20/y=-3",
                                   "not-a-knot",
                                   "not-a-knot/end=end,natural/end=begin",
                                   "periodic",
                                   "ends,point/t=0/x=500,point/t=0.6/x=520/y=1"};

TEST(MeasureFit, AuditsLinearConstraints) {
  for (const char* constraints : kLinear) {
    for (const int dimension : {2, 3}) {
      const auto problem = WaveFit(dimension, constraints, {});
      ExpectAudited(*problem, "lbfgs");
      ExpectAudited(*problem, "ceres_lm");
    }
  }
  ExpectAudited(*WaveFit(3, "ends,natural", {}), "banded_qr");
  ExpectAudited(*WaveFit(2, "ends,natural", {}), "cg");
}

TEST(MeasureFit, AuditsLinearConstraintsOfClosedCurves) {
  FitSpec spec;
  spec.closed = true;
  for (const char* constraints : {"point/t=0.99/x=505/y=3", "derivative/t=0/order=1/y=2"}) {
    ExpectAudited(*WaveFit(2, constraints, spec), "lbfgs");
  }
}

TEST(MeasureFit, AuditsLinearConstraintsBesideLossesAndMovingParameters) {
  FitSpec spec;
  spec.terms = {{"interpolation", {{"loss", "cauchy"}, {"loss_scale", "0.02"}}, nullptr}};
  ExpectAudited(*WaveFit(2, "ends,derivative/t=0.5/y=0", spec), "lbfgs");
  for (const bool keep_order : {false, true}) {
    for (const bool hold_ends : {false, true}) {
      FitSpec moving;
      moving.parameter_kind = ParameterKind::kFree;
      moving.keep_order = keep_order;
      moving.hold_ends = hold_ends;
      ExpectAudited(*WaveFit(2, "point/t=0.37/x=518/y=3,natural", moving), "lbfgs");
    }
  }
  FitSpec projected;
  projected.parameter_kind = ParameterKind::kProjected;
  ExpectAudited(*WaveFit(2, "ends,natural/end=end", projected), "lbfgs");
}

// Constraints of another value: what the run solved is not what is asked.
TEST(MeasureFit, CatchesTheConstraintsOfAnotherProblem) {
  const auto problem = WaveFit(2, "point/t=0.37/x=518/y=3", {});
  const auto other = WaveFit(2, "point/t=0.37/x=518/y=3.0000001", {});
  const RunResult run = RunSolver(*problem, "banded_qr", {});
  EXPECT_TRUE(MeasureFit(*problem, run, {}).verdict.holds);
  EXPECT_THAT(MeasureFit(*other, run, {}).verdict.failure,
              HasSubstr("constraint point/t=0.37/x=518/y=3.0000001 holds"));
}

/// What rounding is worth in what a tangent or a curvature `kappa` of a WaveFit is missed by, as a
/// length, where the curve is at t. C^(k) = sum B_j^(k) P_j, and sum |B_j^(k)| is at most the
/// product of 2 (p - i) over the shortest span, i < k (differences of control points, k times). Its
/// terms carry 3 roundings for each of the p steps of a basis function, p + 1 for product and sum,
/// and 3 for centring, scaling and back, of coordinates as large as the largest.
double MissedRounding(const Problem& problem, const Eigen::VectorXd& x, double t, double kappa) {
  const CurveFit& fit = *problem.curve_fit();
  const int p = fit.basis().degree();
  const int d = fit.dimension();
  const double spans = fit.basis().num_domain_spans();
  const double roundings = 0.5 * kEpsilon * (3 * p + p + 1 + 3);
  const double largest =
      std::max(fit.ControlPoints(x).cwiseAbs().maxCoeff(), fit.data().points.cwiseAbs().maxCoeff());
  const double of_first = roundings * 2 * p * spans * largest * std::sqrt(d);
  double missed = of_first;  // across the direction and along it; the domain's length is 1
  if (kappa > 0.0) {
    // By the rules of differentiation of |a x b| / |a|^3, a and b the first two derivatives.
    const double of_second = of_first * 2 * (p - 1) * spans;
    std::vector<double> derivatives(static_cast<std::size_t>(3 * d));
    fit.Curve(x).EvaluateUpTo(t, 2, derivatives.data());
    const Eigen::Map<const Eigen::VectorXd> a(derivatives.data() + d, d);
    const Eigen::Map<const Eigen::VectorXd> b(derivatives.data() + 2 * d, d);
    const double bend = b.norm() / a.squaredNorm();  // at least the curvature
    const double of_kappa = of_second / a.squaredNorm() + 4 * bend * of_first / a.norm();
    // In space (curvature^2 - kappa^2) / (2 kappa) is held.
    const double slope = d == 2 ? 1.0 : std::max(1.0, bend / kappa);
    missed = fit.size() * fit.size() * slope * of_kappa;
  }
  return missed;
}

TEST(MeasureFit, AuditsWhatConditionsLeaveOfTheClaim) {
  for (const int dimension : {2, 3}) {
    const std::string tangent = dimension == 2 ? "/x=1/y=-1" : "/x=1/y=-1/z=0.5";
    for (const std::string& constraints :
         {"tangent/t=0.5" + tangent, std::string("curvature/t=0.3/kappa=0.05,ends"),
          "point/free=7/y=4,point/free=2/x=520/y=-3,tangent/free=7" + tangent}) {
      SCOPED_TRACE(constraints);
      const auto problem = WaveFit(dimension, constraints, {});
      for (const int iterations : {0, 20, 5000}) {
        RunSpec spec;
        spec.max_iterations = iterations;
        const RunResult run = RunSolver(*problem, "augmented_lagrangian:lbfgs", spec);
        const FitReport report = MeasureFit(*problem, run, spec);
        EXPECT_TRUE(report.audited && report.verdict.holds) << report.verdict.failure;
        EXPECT_FALSE(report.audit.covers_gradient);
        // In space one normal of the tangent may have all of what it is missed by.
        const bool has_curvature = constraints.find("curvature") != std::string::npos;
        // Both the run and the audit round; the audit's long double hardly.
        const double rounding = MissedRounding(*problem, run.x, 0.3, has_curvature ? 0.05 : 0.0);
        EXPECT_LE(report.audit.violation, run.violation + rounding);
        EXPECT_GE(report.audit.violation, run.violation / 1.5 - rounding);
        RunResult lie = run;
        lie.violation = 0.5 * run.violation;
        if (iterations == 0 && run.violation > 1e-3) {  // not an inequality that holds anyway
          EXPECT_THAT(MeasureFit(*problem, lie, spec).verdict.failure,
                      HasSubstr("claims that constraints are missed"));
        }
      }
    }
  }
}

}  // namespace
}  // namespace batten
