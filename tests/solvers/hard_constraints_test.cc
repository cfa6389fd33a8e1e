#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "problems/curve_constraints.h"
#include "splines/basis_functions.h"
#include "tests/solvers/contract_cases.h"
#include "tests/splines/example_splines.h"

namespace batten {
namespace {

using ::testing::HasSubstr;

/// Of what hard constraints must hold to, in units of the data's size.
constexpr double kHeld = 1e-12;

FitSpec WithConstraints(FitSpec spec, const std::string& constraints) {
  std::string error;
  CHECK(ParseNameSpecList(constraints, &spec.constraints, &error)) << error;
  return spec;
}

DataSet OpenData() {
  DataSet data = WithoutWeights(MakeNoisyLoop(40, 2, 12));
  for (int i = 0; i < 40; ++i) data.points(i, 0) += 0.2 * i + 100.0;
  return data;
}

/// C^(order)(t) in the user's units.
Eigen::RowVectorXd CurveAt(const Problem& problem, const Eigen::VectorXd& x, double t, int order) {
  const CurveFit& fit = *problem.curve_fit();
  const BsplineBasis& basis = fit.basis();
  const int span = basis.FindSpan(t);
  std::vector<double> values((kMaxDegree + 1) * kMaxOrder);
  EvaluateBasisDerivatives(basis.degree(), basis.knots().data(), span, t, order, values.data());
  const Points control_points = fit.ControlPoints(x);
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(fit.dimension());
  for (int j = 0; j <= basis.degree(); ++j) {
    sum += values[order * basis.order() + j] *
           control_points.row(basis.ControlPointIndex(span - basis.degree() + j));
  }
  return sum;
}

Eigen::VectorXd Solve(const Problem& problem, const std::string& solver) {
  const SolverTrial trial(problem, solver, {5000, 1e-8, true});
  EXPECT_TRUE(IsSuccess(trial.outcome.reason))
      << solver << ": " << ToString(trial.outcome.reason) << " " << trial.outcome.message;
  return trial.all;
}

TEST(CurveConstraints, HoldPointsAndDerivativesWhateverTheSolver) {
  const auto problem = MakeFit(
      OpenData(), WithConstraints(MakeSpec(3, false, 14, "interpolation,fairing/weight=1e-6"),
                                  "point/t=0.35/x=103/y=1,derivative/t=0.8/order=1/x=5/y=-3,"
                                  "derivative/t=1/order=2/x=0/y=0,ends/end=begin"));
  const double size = problem->curve_fit()->size();
  const Eigen::VectorXd direct = Solve(*problem, "banded_qr");
  for (const char* solver :
       {"banded_qr", "banded_cholesky", "dense_qr", "lbfgs", "ceres_lm", "lspia", "cg"}) {
    SCOPED_TRACE(solver);
    const Eigen::VectorXd x = Solve(*problem, solver);
    const auto near = [&](double t, int order, double a, double b) {
      // A derivative's own unit: control points over the length of a span.
      const double unit = size * std::pow(11.0, order) * (order == 0 ? 1 : order == 1 ? 3 : 6);
      EXPECT_LE((CurveAt(*problem, x, t, order) - Eigen::RowVector2d(a, b)).cwiseAbs().maxCoeff(),
                kHeld * unit);
    };
    near(0.35, 0, 103, 1);
    near(0.8, 1, 5, -3);
    near(1.0, 2, 0, 0);
    const Points& data = problem->curve_fit()->data().points;
    near(0.0, 0, data(0, 0), data(0, 1));
    EXPECT_LE((x - direct).cwiseAbs().maxCoeff(), 1e-6);
  }
}

TEST(CurveConstraints, HoldSingleCoordinatesAndLeaveTheOthersAlone) {
  for (const bool closed : {false, true}) {
    const auto problem =
        MakeFit(OpenData(), WithConstraints(MakeSpec(3, closed, 14), "point/t=0.5/y=2.5"));
    const auto unbound = MakeFit(OpenData(), MakeSpec(3, closed, 14));
    const Eigen::VectorXd without = Solve(*unbound, "banded_qr");
    for (const char* solver : {"banded_qr", "banded_cholesky", "dense_qr", "lspia", "cg", "newton",
                               "irls:banded_qr", "lbfgs", "ceres_lm"}) {
      SCOPED_TRACE(solver);
      const Eigen::VectorXd x = Solve(*problem, solver);
      EXPECT_NEAR(CurveAt(*problem, x, 0.5, 0)[1], 2.5, kHeld * problem->curve_fit()->size());
      EXPECT_GT(std::abs(CurveAt(*unbound, without, 0.5, 0)[1] - 2.5), 0.1);
      // The energy is a sum over the coordinates: x is fitted as if y were not there.
      for (const double t : {0.0, 0.31, 0.5, 0.97}) {
        EXPECT_NEAR(CurveAt(*problem, x, t, 0)[0], CurveAt(*unbound, without, t, 0)[0],
                    1e-6 * problem->curve_fit()->size());
      }
    }
  }
}

TEST(CurveConstraints, OnCoordinatesOfAPolygonThroughItsDataHaveKnownAnswers) {
  // Degree 1 and knots at the data: control points are the points themselves, E the sum of their
  // squared distances.
  DataSet data;
  data.name = "corners";
  data.points = PointsOf({{0, 0}, {1, 1}, {2, 0}, {3, 4}});
  data.parameters = Eigen::Vector4d(0, 1, 2, 3);
  FitSpec spec = MakeSpec(1, false, 0);
  spec.parameters.reset();
  spec.given_knots = {0, 0, 1, 2, 3, 3};
  const auto problem = MakeFit(data, spec);
  const CurveFit& fit = *problem->curve_fit();
  // Inside, points are scaled and centred: the last one's coordinates tell by how much.
  const double scale = fit.setting().scale;
  const auto inside = [&](int point, int coordinate) {
    return problem->start()[2 * point + coordinate];
  };
  problem->SetStart(Solve(*problem, "banded_qr"));
  // y of P_1 is 5; x of P_2 less its place is y of P_3 less its own and 3 more: each gives way by
  // half.
  SetConstraints(
      {{"y of P_1", {{3, 1.0}}, inside(1, 1) + 4.0 * scale},
       {"x of P_2 and y of P_3", {{4, 1.0}, {7, -1.0}}, inside(2, 0) - inside(3, 1) + 3.0 * scale}},
      problem.get());
  for (const char* solver : {"banded_qr", "banded_cholesky", "dense_qr", "lspia", "cg", "lbfgs"}) {
    SCOPED_TRACE(solver);
    const Points found = fit.ControlPoints(Solve(*problem, solver));
    const Points expected = PointsOf({{0, 0}, {1, 5}, {3.5, 0}, {3, 2.5}});
    EXPECT_LE((found - expected).cwiseAbs().maxCoeff(), 1e-7);
  }
}

TEST(CurveConstraints, NaturalEndsOfACubicThroughItsDataAreTheKnownSpline) {
  // Knots at the data, two more control points than points: the natural spline of (0, 0), (1, 1),
  // (2, 0) has second derivatives 0, -3, 0 (tridiagonal system 4 m_1 = 6 (0 - 2 + 0)).
  DataSet data;
  data.name = "hat";
  data.points = PointsOf({{0, 0}, {1, 1}, {2, 0}});
  data.parameters = Eigen::Vector3d(0, 1, 2);
  FitSpec spec = WithConstraints(MakeSpec(3, false, 0), "natural");
  spec.parameters.reset();
  spec.given_knots = {0, 0, 0, 0, 1, 2, 2, 2, 2};
  const auto problem = MakeFit(data, spec);
  const Eigen::VectorXd x = Solve(*problem, "banded_qr");
  EXPECT_NEAR(CurveAt(*problem, x, 0, 2)[1], 0.0, 1e-13);
  EXPECT_NEAR(CurveAt(*problem, x, 1, 2)[1], -3.0, 1e-13);
  EXPECT_NEAR(CurveAt(*problem, x, 0, 1)[1], 1.5, 1e-13);
  EXPECT_NEAR(CurveAt(*problem, x, 1, 0)[1], 1.0, 1e-13);
}

TEST(CurveConstraints, HoldADerivativeOverItsLargestCoefficientToRounding) {
  // docs/constraints.md: at the ends of n uniform spans max |N_j''| is 9 n^2 (and |N_j'| 3 n).
  const int spans = 997;
  DataSet data;
  data.name = "wave";
  data.points.resize(2 * spans, 2);
  const double far = 1e3;
  for (int i = 0; i < 2 * spans; ++i) data.points.row(i) << far + i, far * std::sin(0.01 * i);
  const double largest = far + 2 * spans;
  for (const char* solver : {"banded_qr", "lbfgs"}) {
    const auto problem =
        MakeFit(data, WithConstraints(MakeSpec(3, false, spans + 3), "natural,clamped/x=2000/y=5"));
    const Eigen::VectorXd x = Solve(*problem, solver);
    for (const double t : {0.0, 1.0}) {
      const double allowed = 8.0 * kEpsilon * largest;
      EXPECT_LE(CurveAt(*problem, x, t, 2).cwiseAbs().maxCoeff() / (9.0 * spans * spans), allowed);
      EXPECT_NEAR(CurveAt(*problem, x, t, 1)[0] / (3.0 * spans), 2000.0 / (3.0 * spans), allowed);
      EXPECT_NEAR(CurveAt(*problem, x, t, 1)[1] / (3.0 * spans), 5.0 / (3.0 * spans), allowed);
    }
  }
}

TEST(CurveConstraints, NotAKnotMakesOneCubicOfTheFirstTwoSpans) {
  // Five points of a cubic: with not-a-knot at both inner knots the spline is the cubic itself.
  const auto cubic = [](double t) { return t * t * t - 2.0 * t * t + 0.5; };
  DataSet data;
  data.name = "cubic";
  data.points.resize(5, 2);
  data.parameters = Eigen::VectorXd(5);
  const double places[] = {0.0, 0.7, 1.5, 2.6, 3.0};
  for (int i = 0; i < 5; ++i) {
    (*data.parameters)[i] = places[i];
    data.points.row(i) << cubic(places[i]), places[i];
  }
  FitSpec spec = WithConstraints(MakeSpec(3, false, 0), "not-a-knot");
  spec.parameters.reset();
  spec.given_knots = {0, 0, 0, 0, 0.7, 1.5, 2.6, 3, 3, 3, 3};
  const auto problem = MakeFit(data, spec);
  const Eigen::VectorXd x = Solve(*problem, "banded_qr");
  for (const double t : {0.2, 1.1, 2.0, 2.9}) {
    EXPECT_NEAR(CurveAt(*problem, x, t, 0)[0], cubic(t), 1e-12) << t;
  }
}

TEST(CurveConstraints, PeriodicEndsAreTheClosedCurve) {
  DataSet data = WithoutWeights(MakeNoisyLoop(30, 2, 3));
  data.parameters = Eigen::VectorXd(30);
  for (int i = 0; i < 30; ++i) (*data.parameters)[i] = i / 30.0;
  FitSpec spec = MakeSpec(3, true, 8);
  spec.parameters.reset();
  const auto closed = MakeFit(data, spec);
  FitSpec open = WithConstraints(MakeSpec(3, false, 11), "periodic");
  open.parameters.reset();
  open.domain = {0.0, 1.0};
  const auto tied = MakeFit(data, open);
  const Eigen::VectorXd x = Solve(*closed, "banded_qr"), y = Solve(*tied, "banded_qr");
  for (const double t : {0.0, 0.13, 0.5, 0.99}) {
    EXPECT_LE((CurveAt(*closed, x, t, 0) - CurveAt(*tied, y, t, 0)).norm(), 1e-10) << t;
  }
  for (int order = 0; order < 3; ++order) {
    const double unit = std::pow(8.0, order) * 10.0;
    EXPECT_LE((CurveAt(*tied, y, 0.0, order) - CurveAt(*tied, y, 1.0, order)).norm(),
              kHeld * unit * tied->curve_fit()->size());
  }
}

TEST(CurveConstraints, ClampedEndsHaveBesselsTangents) {
  const auto problem = MakeFit(OpenData(), WithConstraints(MakeSpec(3, false, 14), "clamped"));
  const CurveFit& fit = *problem->curve_fit();
  const Eigen::VectorXd x = Solve(*problem, "banded_qr");
  const auto& q = fit.data().points;
  const auto& t = fit.parameters();
  const Eigen::RowVectorXd first = (q.row(1) - q.row(0)) / (t[1] - t[0]);
  const Eigen::RowVectorXd second = (q.row(2) - q.row(1)) / (t[2] - t[1]);
  // Through three points: a mean of the two slopes, weighted by the other step.
  const Eigen::RowVectorXd bessel = first - (second - first) * (t[1] - t[0]) / (t[2] - t[0]);
  EXPECT_LE((CurveAt(*problem, x, 0.0, 1) - bessel).norm(), 1e-10 * bessel.norm());
}

std::string WhyNot(const std::string& constraints, bool closed = false) {
  std::string error;
  const auto problem =
      MakeFitProblem(OpenData(), WithConstraints(MakeSpec(3, closed, 14), constraints), &error);
  return problem == nullptr ? error : "";
}

TEST(CurveConstraints, ThatContradictEachOtherAreNamed) {
  EXPECT_EQ(
      WhyNot("point/t=0.4/x=1/y=2,point/t=0.4/x=1.5"),
      "linear constraints \"point/t=0.4/x=1/y=2 (x)\" and \"point/t=0.4/x=1.5 (x)\" contradict "
      "each other");
  EXPECT_EQ(WhyNot("point/t=0.4/x=1/y=2,point/t=0.4/x=1"), "") << "said twice";
}

TEST(CurveConstraints, ThatTheCurveCannotMeetAreRefused) {
  EXPECT_EQ(WhyNot("point/t=1.5/x=1"), "constraint point/t=1.5/x=1 has t = 1.5; allowed: 0 to 1");
  EXPECT_EQ(WhyNot("point/x=1"), "constraint point/x=1 has no t; allowed: 0 to 1");
  EXPECT_EQ(WhyNot("point/t=0.5"),
            "constraint point/t=0.5 holds nothing; give at least one of x, y, z, w");
  EXPECT_EQ(WhyNot("point/t=0.5/z=1"),
            "constraint point/t=0.5/z=1 gives z, but the data have dimension 2");
  EXPECT_EQ(WhyNot("derivative/t=0.5/order=4/x=1"),
            "constraint derivative/t=0.5/order=4/x=1 needs degree 4 or more; found 3");
  EXPECT_EQ(WhyNot("natural", true),
            "constraint natural needs an open curve; a closed one has no ends");
  EXPECT_THAT(WhyNot("naturl"), HasSubstr("unknown constraint \"naturl\"; did you mean natural?"));
}

}  // namespace
}  // namespace batten
