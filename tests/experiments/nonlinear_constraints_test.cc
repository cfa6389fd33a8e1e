#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "experiments/basins.h"
#include "experiments/fit_report.h"
#include "experiments/run.h"
#include "problems/constraint_projection.h"
#include "tests/experiments/outlines.h"
#include "tests/solvers/test_fits.h"
#include "tests/splines/example_splines.h"

namespace batten {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;

/// What constraints that are not linear hold to, in units of the data's size.
constexpr double kHeld = 1e-10;

RunResult Solve(const Problem& problem, const std::string& solver, RunSpec spec = {}) {
  RunResult run;
  std::string error;
  EXPECT_TRUE(Run(problem, Named(solver), spec, &run, &error)) << error;
  EXPECT_EQ(run.skipped, "");
  return run;
}

FitSpec Constrained(int degree, int control_points, const std::string& constraints) {
  FitSpec spec = MakeSpec(degree, false, control_points);
  spec.parameters.reset();
  spec.domain = {0.0, 1.0};
  std::string error;
  EXPECT_TRUE(ParseNameSpecList(constraints, &spec.constraints, &error)) << error;
  return spec;
}

DataSet DataOf(const Points& points, const Eigen::VectorXd& t) {
  DataSet data;
  data.name = "made";
  data.points = points;
  data.parameters = t;
  return data;
}

std::string WhyNot(const FitSpec& spec, int dimension = 2) {
  std::mt19937 random(5);
  std::string error;
  const auto problem = MakeFitProblem(
      DataOf(RandomPoints(20, dimension, &random), Eigen::VectorXd::LinSpaced(20, 0.0, 1.0)), spec,
      &error);
  return problem == nullptr ? error : "";
}

/// The least-squares line P_0 + t s u of a given direction u: s = cov(t, u . Q) / var(t), no less
/// than it may be, and through the means.
struct DirectedLine {
  DirectedLine(const Points& q, const Eigen::VectorXd& t, const Eigen::Vector2d& u, double least) {
    const double mean_t = t.mean();
    const Eigen::RowVector2d mean_q = q.colwise().mean();
    const Eigen::VectorXd off = t.array() - mean_t;
    const double free = off.dot(q * u) / off.squaredNorm();
    speed = std::max(free, least);
    begin = mean_q - mean_t * speed * u.transpose();
    end = begin + speed * u.transpose();
  }
  double speed;
  Eigen::RowVector2d begin, end;
};

TEST(NonlinearConstraints, ALeastSquaresLineOfGivenDirectionIsTheClosedForm) {
  std::mt19937 random(20250601);
  const Eigen::VectorXd t = Eigen::VectorXd::LinSpaced(15, 0.0, 1.0);
  Points q = RandomPoints(15, 2, &random);
  for (int i = 0; i < 15; ++i) q.row(i) = 0.3 * q.row(i) + 10.0 * t[i] * Eigen::RowVector2d(3, 1);
  const Eigen::Vector2d u = Eigen::Vector2d(2, 1).normalized();
  for (const bool other_way : {false, true}) {
    const auto problem = MakeFit(
        DataOf(q, t),
        Constrained(1, 2,
                    other_way ? "tangent/t=0.4/x=-2/y=-1/least=0.01" : "tangent/t=0.4/x=2/y=1"));
    const double size = problem->curve_fit()->size();
    const DirectedLine line(q, t, other_way ? Eigen::Vector2d(-u) : u, 0.01 * size);
    for (const char* solver : {"augmented_lagrangian:lbfgs", "augmented_lagrangian:ceres_lm"}) {
      SCOPED_TRACE(solver);
      const RunResult run = Solve(*problem, solver);
      EXPECT_TRUE(IsSuccess(run.outcome.reason))
          << ToString(run.outcome.reason) << " " << run.outcome.message;
      const Points points = problem->curve_fit()->ControlPoints(run.x);
      EXPECT_LE((points.row(0) - line.begin).norm(), 1e-8 * size);
      EXPECT_LE((points.row(1) - line.end).norm(), 1e-8 * size);
      const Eigen::Vector2d along = (points.row(1) - points.row(0)).transpose();
      EXPECT_LE(std::abs(along[0] * u[1] - along[1] * u[0]), 1e-12 * size);
      EXPECT_GE((other_way ? -1.0 : 1.0) * along.dot(u), line.speed - kHeld * size);
      EXPECT_LE(run.violation, kHeld * size);
    }
  }
}

/// A cubic of one span with four control points: C, C', C'' by Bernstein's polynomials.
using Cubic = Eigen::Matrix<double, 4, Eigen::Dynamic>;
std::array<Eigen::VectorXd, 3> CubicAt(const Cubic& p, double t) {
  const double s = 1.0 - t;
  const Eigen::RowVector4d value(s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t);
  const Eigen::RowVector4d first(-3 * s * s, 3 * s * s - 6 * s * t, 6 * s * t - 3 * t * t,
                                 3 * t * t);
  const Eigen::RowVector4d second(6 * s, 6 * t - 12 * s, 6 * s - 12 * t, 6 * t);
  return {(value * p).transpose(), (first * p).transpose(), (second * p).transpose()};
}
double CurvatureAt(const Cubic& p, double t) {
  const auto c = CubicAt(p, t);
  const double bend = c[1].squaredNorm() * c[2].squaredNorm() - std::pow(c[1].dot(c[2]), 2);
  const double size = std::sqrt(bend) / std::pow(c[1].norm(), 3);
  return p.cols() == 2 && c[1][0] * c[2][1] < c[1][1] * c[2][0] ? -size : size;
}

/// Data whose best cubic under equations h_k(P, s) = 0, met at P and s, is P: with E = |A P - Q|^2
/// the conditions of Karush, Kuhn and Tucker 2 A'(A P - Q) + sum_k lambda_k dh_k / dP = 0 and
/// sum_k lambda_k dh_k / ds = 0 are met by Q = A P + A (A'A)^-1 (sum_k lambda_k dh_k / dP) / 2.
/// lambda is as given, less what would move s.
Points DataFor(const Cubic& p, double s, bool s_moves, const Eigen::VectorXd& t,
               const std::vector<std::function<double(const Cubic&, double)>>& h,
               Eigen::VectorXd lambda) {
  constexpr double kStep = 1e-5;  // central differences: 1e-10
  const auto k = static_cast<Eigen::Index>(h.size());
  std::vector<Cubic> gradients;
  Eigen::VectorXd by_s = Eigen::VectorXd::Zero(k);
  for (Eigen::Index i = 0; i < k; ++i) {
    Cubic gradient = p;
    for (Eigen::Index e = 0; e < p.size(); ++e) {
      Cubic after = p, before = p;
      after.data()[e] += kStep;
      before.data()[e] -= kStep;
      gradient.data()[e] = (h[i](after, s) - h[i](before, s)) / (2 * kStep);
    }
    gradients.push_back(gradient);
    if (s_moves) by_s[i] = (h[i](p, s + kStep) - h[i](p, s - kStep)) / (2 * kStep);
  }
  if (s_moves) lambda -= by_s * (by_s.dot(lambda) / by_s.squaredNorm());
  Cubic pull = Cubic::Zero(4, p.cols());
  for (Eigen::Index i = 0; i < k; ++i) pull += 0.5 * lambda[i] * gradients[i];
  Eigen::MatrixXd a(t.size(), 4);
  for (Eigen::Index i = 0; i < t.size(); ++i) {
    for (int j = 0; j < 4; ++j) {
      Cubic unit = Cubic::Zero(4, 1);
      unit(j, 0) = 1.0;
      a(i, j) = CubicAt(unit, t[i])[0][0];
    }
  }
  return a * p + a * (a.transpose() * a).ldlt().solve(Eigen::MatrixXd(pull));
}

/// Runs the solvers of nonlinear constraints on such data and finds P, within what differences
/// leave of the data.
void ExpectFinds(const Cubic& p, const Points& data, const Eigen::VectorXd& t,
                 const std::string& constraints,
                 const std::function<double(const Cubic&, double)>& missed, double s) {
  const auto problem = MakeFit(DataOf(data, t), Constrained(3, 4, constraints));
  const double size = problem->curve_fit()->size();
  for (const char* solver :
       {"augmented_lagrangian:lbfgs", "augmented_lagrangian/penalty=100:lbfgs/memory=20",
        "augmented_lagrangian:ceres_lm", "augmented_lagrangian:ceres_lbfgs"}) {
    SCOPED_TRACE(solver);
    const RunResult run = Solve(*problem, solver);
    // Ceres compares values of E only, and ends where their roundings do.
    const bool reached =
        IsSuccess(run.outcome.reason) || (run.outcome.reason == StopReason::kLineSearchEnded &&
                                          run.gradient_norm <= 1e-6 * run.start_gradient_norm);
    EXPECT_TRUE(reached) << ToString(run.outcome.reason) << " " << run.outcome.message;
    const Cubic found = problem->curve_fit()->ControlPoints(run.x);
    EXPECT_LE((found - p).cwiseAbs().maxCoeff(), 1e-6 * size);
    const double at = run.x.size() > p.size() ? run.x[p.size()] : s;
    EXPECT_NEAR(at, s, 1e-6);
    EXPECT_LE(std::abs(missed(found, at)), kHeld * size);
    EXPECT_LE(run.violation, kHeld * size);
    const FitReport report = MeasureFit(*problem, run, RunSpec());
    EXPECT_TRUE(report.audited && report.verdict.holds) << report.verdict.failure;
    EXPECT_FALSE(report.audit.covers_gradient);
    EXPECT_NEAR(report.audit.violation, run.violation, 1e-13 * size);
  }
}

const Eigen::VectorXd kPlaces = Eigen::VectorXd::LinSpaced(12, 0.0, 1.0);

Cubic PlaneCubic() {
  Cubic p(4, 2);
  p << 0.1, 0.2, 1.3, 2.1, 3.2, 1.7, 4.1, -0.4;
  return p;
}
Cubic SpaceCubic() {
  Cubic p(4, 3);
  p << 0.1, 0.2, 0.0, 1.3, 2.1, 0.7, 3.2, 1.7, 1.9, 4.1, -0.4, 1.1;
  return p;
}

TEST(NonlinearConstraints, GivenCurvatureIsMetAtTheLeastEnergy) {
  for (const Cubic& p : {PlaneCubic(), SpaceCubic()}) {
    const double kappa = CurvatureAt(p, 0.3);
    const std::function<double(const Cubic&, double)> h = [kappa](const Cubic& at, double t) {
      return CurvatureAt(at, t) - kappa;
    };
    const Points data = DataFor(p, 0.3, false, kPlaces, {h}, Eigen::VectorXd::Constant(1, 0.4));
    ExpectFinds(p, data, kPlaces, "curvature/t=0.3/kappa=" + NumberText(kappa), h, 0.3);
  }
}

TEST(NonlinearConstraints, APointIsPassedAtAParameterThatIsFound) {
  for (const Cubic& p : {PlaneCubic(), SpaceCubic()}) {
    const double s = 0.62;
    const Eigen::VectorXd q = CubicAt(p, s)[0];
    std::vector<std::function<double(const Cubic&, double)>> h;
    std::string constraint = "point/free=1";
    for (int c = 0; c < p.cols(); ++c) {
      h.emplace_back([q, c](const Cubic& at, double t) { return CubicAt(at, t)[0][c] - q[c]; });
      constraint += "/" + std::string(1, "xyz"[c]) + "=" + NumberText(q[c]);
    }
    const Eigen::VectorXd lambda = Eigen::Vector3d(0.3, -0.2, 0.25).head(p.cols());
    const Points data = DataFor(p, s, true, kPlaces, h, lambda);
    ExpectFinds(
        p, data, kPlaces, constraint,
        [q](const Cubic& at, double t) { return (CubicAt(at, t)[0] - q).norm(); }, s);
  }
}

TEST(NonlinearConstraints, ADerivativeIsMetAtAParameterThatIsFound) {
  for (const Cubic& p : {PlaneCubic(), SpaceCubic()}) {
    for (const int order : {1, 2}) {
      SCOPED_TRACE(order);
      const double s = 0.36;
      const Eigen::VectorXd q = CubicAt(p, s)[order];
      std::vector<std::function<double(const Cubic&, double)>> h;
      std::string constraint = "derivative/free=3/t=0.3/order=" + std::to_string(order);
      for (int c = 0; c < p.cols(); ++c) {
        h.emplace_back(
            [q, c, order](const Cubic& at, double t) { return CubicAt(at, t)[order][c] - q[c]; });
        constraint += "/" + std::string(1, "xyz"[c]) + "=" + NumberText(q[c]);
      }
      const Eigen::VectorXd lambda = Eigen::Vector3d(0.02, -0.01, 0.015).head(p.cols());
      const Points data = DataFor(p, s, true, kPlaces, h, lambda);
      ExpectFinds(
          p, data, kPlaces, constraint,
          [q, order](const Cubic& at, double t) {
            return (CubicAt(at, t)[order] - q).cwiseAbs().maxCoeff();
          },
          s);
    }
  }
}

TEST(NonlinearConstraints, OfOneNumberHoldAtOneParameter) {
  const Cubic p = PlaneCubic();
  const double s = 0.41;
  const auto c = CubicAt(p, s);
  const Eigen::Vector2d q = c[0], u = Eigen::Vector2d(c[1]).normalized();
  const double kappa = CurvatureAt(p, s);
  // In the problem's own measures, or lambda would mean something else: only directions count.
  const std::vector<std::function<double(const Cubic&, double)>> h = {
      [q](const Cubic& at, double t) { return CubicAt(at, t)[0][0] - q[0]; },
      [q](const Cubic& at, double t) { return CubicAt(at, t)[0][1] - q[1]; },
      [u](const Cubic& at, double t) {
        const auto d = CubicAt(at, t);
        return d[1][0] * u[1] - d[1][1] * u[0];
      },
      [kappa](const Cubic& at, double t) { return CurvatureAt(at, t) - kappa; }};
  const Points data = DataFor(p, s, true, kPlaces, h, Eigen::Vector4d(0.2, -0.1, 0.02, 0.1));
  const std::string place = "/x=" + NumberText(q[0]) + "/y=" + NumberText(q[1]);
  const std::string direction = "/x=" + NumberText(u[0]) + "/y=" + NumberText(u[1]);
  ExpectFinds(
      p, data, kPlaces,
      "point/free=7" + place + ",tangent/free=7" + direction +
          ",curvature/free=7/kappa=" + NumberText(kappa),
      [&](const Cubic& at, double t) {
        double largest = 0.0;
        for (const auto& one : h) largest = std::max(largest, std::abs(one(at, t)));
        return largest;
      },
      s);
}

TEST(NonlinearConstraints, StandBesideLinearOnesWhichStayEliminated) {
  const Cubic p = PlaneCubic();
  const double kappa = CurvatureAt(p, 0.5);
  Points data(12, 2);
  std::mt19937 random(20250602);
  for (int i = 0; i < 12; ++i) {
    data.row(i) = CubicAt(p, kPlaces[i])[0].transpose() + 0.1 * RandomPoints(1, 2, &random);
  }
  const auto problem =
      MakeFit(DataOf(data, kPlaces), Constrained(3, 4,
                                                 "point/t=0/x=0.1/y=0.2,derivative/t=1/y=-6.5,"
                                                 "curvature/t=0.5/kappa=" +
                                                     NumberText(1.5 * kappa)));
  RunSpec spec;
  spec.keep_iterates = true;
  const RunResult run = Solve(*problem, "augmented_lagrangian:lbfgs", spec);
  EXPECT_TRUE(IsSuccess(run.outcome.reason)) << ToString(run.outcome.reason);
  const double size = problem->curve_fit()->size();
  for (const Iterate& iterate : run.iterates) {
    const Cubic at = problem->curve_fit()->ControlPoints(iterate.x);
    EXPECT_LE((CubicAt(at, 0.0)[0] - Eigen::Vector2d(0.1, 0.2)).norm(), 1e-12 * size);
    EXPECT_NEAR(CubicAt(at, 1.0)[1][1], -6.5, 1e-11 * size);
  }
  const Cubic found = problem->curve_fit()->ControlPoints(run.x);
  EXPECT_NEAR(CurvatureAt(found, 0.5), 1.5 * kappa, kHeld * size);
}

// From the minimum of E itself, whose gradient is rounding: there is nothing to compare later ones
// with.
TEST(NonlinearConstraints, AreMetFromAStartThatIsTheMinimumWithoutThem) {
  const Cubic p = PlaneCubic();
  Points data(12, 2);
  for (int i = 0; i < 12; ++i) data.row(i) = CubicAt(p, kPlaces[i])[0].transpose();
  FitSpec spec = Constrained(3, 4, "curvature/t=0.5/kappa=-2");
  const RunResult whole =
      Solve(*MakeFit(DataOf(data, kPlaces), spec), "augmented_lagrangian:lbfgs");
  spec.start_points = p;
  const auto problem = MakeFit(DataOf(data, kPlaces), spec);
  for (const char* base : {"lbfgs", "newton", "ceres_lm"}) {
    SCOPED_TRACE(base);
    const RunResult run = Solve(*problem, std::string("augmented_lagrangian:") + base);
    EXPECT_LT(run.start_gradient_norm, 1e-12);
    EXPECT_NE(run.outcome.reason, StopReason::kDiverged);
    EXPECT_LE(run.violation, kHeld * problem->curve_fit()->size());
    EXPECT_NEAR(run.energy, whole.energy, 1e-9 * whole.energy);
    // A floor that is claimed is one.
    if (run.outcome.reason == StopReason::kRoundingFloor) {
      EXPECT_LE(run.gradient_norm, run.gradient_floor);
    }
  }
}

TEST(NonlinearConstraints, RunControlCountsAllRoundsAndTheTraceShowsWhatIsMissed) {
  const Cubic p = PlaneCubic();
  Points data(12, 2);
  for (int i = 0; i < 12; ++i) data.row(i) = CubicAt(p, kPlaces[i])[0].transpose();
  const auto problem =
      MakeFit(DataOf(data, kPlaces), Constrained(3, 4, "curvature/t=0.5/kappa=-2"));
  const RunResult whole = Solve(*problem, "augmented_lagrangian:lbfgs");
  ASSERT_TRUE(IsSuccess(whole.outcome.reason));
  EXPECT_EQ(static_cast<int>(whole.trace.size()), whole.iterations + 1);
  long before = 0;
  for (std::size_t k = 0; k < whole.trace.size(); ++k) {
    EXPECT_EQ(whole.trace[k].iteration, static_cast<int>(k));
    EXPECT_GE(whole.trace[k].counts.energy_calls, before);
    before = whole.trace[k].counts.energy_calls;
    // A gradient of the Lagrangian that is small is no end while the constraint is missed.
    if (k + 1 < whole.trace.size()) {
      EXPECT_TRUE(whole.trace[k].violation > kHeld ||
                  whole.trace[k].gradient_norm > 1e-10 * whole.start_gradient_norm);
    }
  }
  EXPECT_GT(whole.trace.front().violation, 0.1);
  EXPECT_LE(whole.trace.back().violation, kHeld * problem->curve_fit()->size());
  RunSpec spec;
  spec.max_iterations = whole.iterations - 2;
  const RunResult cut = Solve(*problem, "augmented_lagrangian:lbfgs", spec);
  EXPECT_EQ(cut.outcome.reason, StopReason::kIterationLimit);
  EXPECT_EQ(cut.iterations, spec.max_iterations);
  for (int k = 0; k <= cut.iterations; ++k) {
    EXPECT_EQ(cut.trace[static_cast<std::size_t>(k)].energy,
              whole.trace[static_cast<std::size_t>(k)].energy);
  }
}

TEST(NonlinearConstraints, KeepAnEndThatNewtonDoesNotPolishAsItIs) {
  const Cubic p = PlaneCubic();
  Points data(12, 2);
  for (int i = 0; i < 12; ++i) data.row(i) = CubicAt(p, kPlaces[i])[0].transpose();
  const auto problem =
      MakeFit(DataOf(data, kPlaces), Constrained(3, 4, "curvature/t=0.5/kappa=-2"));
  const RunResult run = Solve(*problem, "augmented_lagrangian:lbfgs");
  const BasinEnd end = Polish(*problem, run.x);
  EXPECT_FALSE(end.polished);
  EXPECT_GT(end.energy, 0.0);
  EXPECT_NEAR(end.energy, run.energy, 1e-14 * run.energy);
  EXPECT_EQ(end.control_points, problem->curve_fit()->ControlPoints(run.x));
}

TEST(NonlinearConstraints, ThatCannotBeMetEndAsInfeasible) {
  // The ends of a line are held: it gets no farther than they are.
  std::mt19937 random(20250603);
  Points data = RandomPoints(12, 2, &random);
  data.row(0) << 0.0, 0.0;
  data.row(11) << 1.0, 2.0;
  const auto problem = MakeFit(DataOf(data, kPlaces), Constrained(1, 2, "ends,point/free=1/x=5"));
  const RunResult run = Solve(*problem, "augmented_lagrangian:lbfgs");
  EXPECT_EQ(run.outcome.reason, StopReason::kInfeasible);
  EXPECT_THAT(run.outcome.message, HasSubstr("constraint point/free=1/x=5, which is missed by "));
  EXPECT_GE(run.violation, 3.0);
  EXPECT_FALSE(IsSuccess(run.outcome.reason));
}

TEST(NonlinearConstraints, ThatContradictEachOtherAreNamed) {
  EXPECT_EQ(WhyNot(Constrained(3, 8, "curvature/t=0.4/kappa=1,curvature/t=0.4/kappa=2")),
            "constraints \"curvature/t=0.4/kappa=1\" and \"curvature/t=0.4/kappa=2\" contradict "
            "each other");
  EXPECT_EQ(WhyNot(Constrained(3, 8, "curvature/t=0.4/kappa=1,curvature/t=0.4/kappa=1")), "");
  EXPECT_EQ(WhyNot(Constrained(3, 8, "tangent/t=0.4/x=1/y=2,tangent/t=0.4/x=-1/y=-2")),
            "constraints \"tangent/t=0.4/x=1/y=2\" and \"tangent/t=0.4/x=-1/y=-2\" contradict each "
            "other");
  EXPECT_EQ(WhyNot(Constrained(3, 8, "tangent/t=0.4/x=1/y=2,tangent/t=0.4/x=2/y=4")), "");
  EXPECT_THAT(WhyNot(Constrained(3, 8, "tangent/t=0.4/x=1/y=2,tangent/t=0.4/x=2/y=1")),
              HasSubstr("contradict"));
  EXPECT_THAT(WhyNot(Constrained(3, 8, "tangent/t=0.4/x=1/y=2,derivative/t=0.4/x=-1/y=-2")),
              HasSubstr("constraint \"tangent/t=0.4/x=1/y=2\" contradicts the linear constraints"));
  EXPECT_THAT(WhyNot(Constrained(3, 8, "tangent/t=0.4/x=1/y=0,ends,derivative/t=0.4/x=-1/y=0")),
              EndsWith("contradicts the linear constraints \"derivative/t=0.4/x=-1/y=0 (x)\""));
  EXPECT_EQ(WhyNot(Constrained(3, 8, "natural,ends,curvature/t=0/kappa=1")),
            "constraint \"curvature/t=0/kappa=1\" contradicts the linear constraints \"natural at "
            "the begin (x)\" and \"natural at the begin (y)\"");
  EXPECT_EQ(WhyNot(Constrained(3, 8, "point/free=2/x=0/y=1,point/free=2/x=0/y=2")),
            "constraints \"point/free=2/x=0/y=1\" and \"point/free=2/x=0/y=2\" contradict each "
            "other");
  EXPECT_EQ(WhyNot(Constrained(3, 8, "point/free=1/x=0/y=1,point/free=2/x=0/y=2")), "");
}

TEST(NonlinearConstraints, OfCurvaturesWhereTheCurveStandsStillAreRefused) {
  // A periodic polynomial is constant.
  EXPECT_EQ(WhyNot(Constrained(2, 3, "periodic,curvature/t=0.3/kappa=0")),
            "constraint \"curvature/t=0.3/kappa=0\" holds a curvature where C' is 0 by the linear "
            "constraints \"periodic in derivative 0 (x)\" and \"periodic in derivative 0 (y)\" and "
            "\"periodic in derivative 1 (x)\" and \"periodic in derivative 1 (y)\"");
  for (int degree : {3, 5}) {
    EXPECT_THAT(WhyNot(Constrained(degree, degree + 1, "periodic,curvature/t=0.5/kappa=0")),
                HasSubstr("holds a curvature where C' is 0 by the linear constraints \"periodic"));
    EXPECT_THAT(
        WhyNot(Constrained(degree, degree + 1, "periodic,curvature/free=1/kappa=2")),
        HasSubstr("where the curve is a single point by the linear constraints \"periodic"));
  }
  // With one knot in the middle it is even about it.
  EXPECT_THAT(WhyNot(Constrained(3, 5, "periodic,curvature/t=0.5/kappa=0")),
              HasSubstr("\"curvature/t=0.5/kappa=0\" holds a curvature where C' is 0"));
  EXPECT_EQ(WhyNot(Constrained(3, 5, "periodic,curvature/t=0.3/kappa=0")), "");
  EXPECT_EQ(WhyNot(Constrained(3, 5, "periodic,curvature/free=1/kappa=0")), "");
  EXPECT_EQ(WhyNot(Constrained(3, 6, "periodic,curvature/t=0.5/kappa=0")), "");
  EXPECT_THAT(WhyNot(Constrained(3, 8, "derivative/t=0.4/x=0/y=0,curvature/t=0.4/kappa=1")),
              EndsWith("C' is 0 by the linear constraints \"derivative/t=0.4/x=0/y=0 (x)\" and "
                       "\"derivative/t=0.4/x=0/y=0 (y)\""));
  EXPECT_EQ(WhyNot(Constrained(3, 8, "derivative/t=0.4/x=0,curvature/t=0.4/kappa=1")), "");
  FitSpec one = Constrained(3, 1, "curvature/t=0.5/kappa=1");
  one.closed = true;
  EXPECT_THAT(WhyNot(one), EndsWith("C' is 0, wherever the control points are"));
}

TEST(NonlinearConstraints, ThatTheCurveCannotMeetAreRefused) {
  EXPECT_EQ(WhyNot(Constrained(3, 8, "tangent/x=1/y=0")),
            "constraint tangent/x=1/y=0 has no t; allowed: 0 to 1, or free=1 to 99 for a parameter "
            "that is found");
  EXPECT_EQ(WhyNot(Constrained(3, 8, "tangent/t=2/x=1/y=0")),
            "constraint tangent/t=2/x=1/y=0 has t = 2; allowed: 0 to 1");
  EXPECT_EQ(WhyNot(Constrained(3, 8, "tangent/t=0.5/x=1")),
            "constraint tangent/t=0.5/x=1 needs all coordinates of the direction");
  EXPECT_EQ(WhyNot(Constrained(3, 8, "tangent/t=0.5/x=0/y=0")),
            "constraint tangent/t=0.5/x=0/y=0 has a direction of length 0");
  EXPECT_EQ(WhyNot(Constrained(3, 8, "curvature/t=0.5")),
            "constraint curvature/t=0.5 has no kappa");
  EXPECT_EQ(WhyNot(Constrained(1, 8, "curvature/t=0.5/kappa=1")),
            "constraint curvature/t=0.5/kappa=1 needs degree 2 or more; found 1");
  EXPECT_EQ(WhyNot(Constrained(3, 8, "curvature/t=0.5/kappa=-1"), 3),
            "constraint curvature/t=0.5/kappa=-1 needs kappa above 0: in space curvature has no "
            "sign, and a kink at 0");
  EXPECT_EQ(WhyNot(Constrained(4, 8, "derivative/order=3/free=1/x=1")),
            "constraint derivative/order=3/free=1/x=1 has order 3 at a parameter that is found; "
            "allowed: 1 or 2");
  EXPECT_EQ(WhyNot(Constrained(1, 8, "derivative/order=2/free=1/x=1")),
            "constraint derivative/order=2/free=1/x=1 needs degree 2 or more; found 1");
  EXPECT_EQ(WhyNot(Constrained(3, 8, "point/free=1")),
            "constraint point/free=1 holds nothing; give at least one of x, y, z, w");
  EXPECT_EQ(WhyNot(Constrained(3, 8, "point/free=1/z=1")),
            "constraint point/free=1/z=1 gives z, but the data have dimension 2");
  EXPECT_THAT(WhyNot(Constrained(3, 8, "point/free=100/x=1")),
              HasSubstr("must be an integer, 0 to 99"));
}

}  // namespace
}  // namespace batten
