#include "experiments/curve_fairness.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "experiments/curvature_figure.h"
#include "tests/experiments/outlines.h"
#include "tests/splines/example_splines.h"

namespace batten {
namespace {

/// A closed quintic that interpolates an ellipse to many digits: n control points fitted to it.
BsplineCurve Ellipse(double a, double b, int n) {
  const int m = 8 * n;
  DataSet data;
  data.name = "ellipse";
  data.points.resize(m, 2);
  for (int i = 0; i < m; ++i) {
    const double t = 2.0 * M_PI * i / m;
    data.points.row(i) << a * std::cos(t), b * std::sin(t);
  }
  FitSpec spec;
  spec.degree = 5;
  spec.closed = true;
  spec.control_points = n;
  std::string error;
  const auto problem = MakeFitProblem(data, spec, &error);
  return problem->curve_fit()->Curve(RunSolver(*problem, "banded_qr").x);
}

TEST(CurveFairness, OfACircleIsThatOfItsRadius) {
  const double radius = 2.5;
  const CurveFairness fairness = MeasureFairness(Ellipse(radius, radius, 60));
  // A quintic with 60 control points is off the circle by (pi / 30)^6 / 720 of it, its second
  // derivative by that over a squared step.
  const double tolerance = 1e-6;
  EXPECT_NEAR(fairness.bending_energy, 2.0 * M_PI / radius, tolerance);
  EXPECT_NEAR(fairness.max_curvature, 1.0 / radius, tolerance);
  EXPECT_NEAR(fairness.curvature_variation, 0.0, 240 * tolerance);
  EXPECT_EQ(fairness.num_inflections, 0);
}

TEST(CurveFairness, OfAnEllipseHasItsFourVertices) {
  const double a = 3.0, b = 1.0;
  const CurveFairness fairness = MeasureFairness(Ellipse(a, b, 90));
  // Curvature goes from b / a^2 to a / b^2 and back, twice.
  EXPECT_NEAR(fairness.max_curvature, a / (b * b), 1e-3);
  EXPECT_NEAR(fairness.curvature_variation, 4.0 * (a / (b * b) - b / (a * a)), 1e-2);
  // The seam is at a vertex: three are inside.
  EXPECT_GE(fairness.num_curvature_extrema, 3);
  EXPECT_LE(fairness.num_curvature_extrema, 4);
  EXPECT_EQ(fairness.num_inflections, 0);
  double energy = 0.0;  // of the ellipse, by the trapezoidal rule over its period
  const int steps = 4000;
  for (int i = 0; i < steps; ++i) {
    const double t = 2.0 * M_PI * i / steps;
    const double speed = std::hypot(a * std::sin(t), b * std::cos(t));
    energy += std::pow(a * b / std::pow(speed, 3), 2) * speed * 2.0 * M_PI / steps;
  }
  EXPECT_NEAR(fairness.bending_energy, energy, 1e-4);
}

TEST(CurveFairness, CountsInflectionsInThePlaneOnly) {
  // C(t) = (t, t^3 - t) bends one way, then the other, at t = 0.
  const BsplineBasis basis = BasisOf(3, false, {-1, -1, -1, -1, 1, 1, 1, 1});
  const Points plane = PointsOf({{-1, 0}, {-1.0 / 3, 4.0 / 3}, {1.0 / 3, -4.0 / 3}, {1, 0}});
  const CurveFairness fairness = MeasureFairness(BsplineCurve(basis, plane));
  EXPECT_EQ(fairness.num_inflections, 1);
  EXPECT_EQ(fairness.num_curvature_extrema, 2);
  ASSERT_EQ(fairness.inflections.size(), 1U);
  EXPECT_NEAR(fairness.inflections[0], 0.0, 1e-12);
  // Where 45 t^4 - 12 t^2 - 2 = 0; it is read at 32 places over a length of 2.
  const double extremum = std::sqrt((12.0 + std::sqrt(504.0)) / 90.0);
  ASSERT_EQ(fairness.curvature_extrema.size(), 2U);
  EXPECT_NEAR(fairness.curvature_extrema[0], -extremum, 2.0 / 32.0);
  EXPECT_NEAR(fairness.curvature_extrema[1], extremum, 2.0 / 32.0);
  Points space = Points::Zero(4, 3);
  space.leftCols(2) = plane;
  const CurveFairness lifted = MeasureFairness(BsplineCurve(basis, space));
  EXPECT_EQ(lifted.num_inflections, -1);
  EXPECT_TRUE(lifted.inflections.empty());
  EXPECT_NEAR(lifted.bending_energy, fairness.bending_energy, 1e-12 * fairness.bending_energy);
  EXPECT_NEAR(lifted.max_curvature, fairness.max_curvature, 1e-12 * fairness.max_curvature);
}

TEST(CurveFairness, KeepsTheFirstThousandPlacesOnly) {
  constexpr int kZigzags = 3000;
  std::vector<double> knots(4, 0.0);
  for (int i = 1; i < kZigzags - 3; ++i) knots.push_back(i);
  knots.insert(knots.end(), 4, kZigzags - 3.0);
  Points points(kZigzags, 2);
  for (int i = 0; i < kZigzags; ++i) points.row(i) << i, i % 2;
  const CurveFairness fairness =
      MeasureFairness(BsplineCurve(BasisOf(3, false, std::move(knots)), points));
  EXPECT_GT(fairness.num_inflections, kZigzags - 10);
  EXPECT_EQ(fairness.inflections.size(), 1000U);
  EXPECT_EQ(fairness.curvature_extrema.size(), 1000U);
  EXPECT_TRUE(std::is_sorted(fairness.inflections.begin(), fairness.inflections.end()));
}

TEST(CurveFairness, OfAStraightLineIsNothing) {
  const BsplineBasis basis = BasisOf(2, false, {0, 0, 0, 1, 3, 3, 3});
  const CurveFairness fairness =
      MeasureFairness(BsplineCurve(basis, PointsOf({{0, 0}, {1, 0}, {4, 0}, {6, 0}})));
  EXPECT_EQ(fairness.bending_energy, 0.0);
  EXPECT_EQ(fairness.max_curvature, 0.0);
  EXPECT_EQ(fairness.num_curvature_extrema, 0);
}

TEST(CurvatureSamples, KnowArcLengthPlaceAndNormal) {
  const double radius = 2.0;
  const std::vector<CurvatureSample> samples = SampleCurvature(Ellipse(radius, radius, 40), 8);
  EXPECT_EQ(samples.size(), 40U * 9U);
  EXPECT_NEAR(samples.back().s, 2.0 * M_PI * radius, 1e-5);
  for (const CurvatureSample& sample : samples) {
    EXPECT_NEAR(std::hypot(sample.point[0], sample.point[1]), radius, 1e-5);
    // The circle bends towards its centre, to the left.
    EXPECT_NEAR(sample.normal[0], -sample.point[0] / radius, 1e-4);
    EXPECT_NEAR(sample.kappa, 1.0 / radius, 1e-4);
  }
}

TEST(CurvatureFigure, ShowsTheFitBesideTheOneWithoutFairing) {
  const auto rhino = LoadCatalogueProblem("rhino");
  FitSpec spec = rhino->curve_fit()->spec();
  std::string error;
  ASSERT_TRUE(ParseNameSpecList("interpolation,fairing/weight=1e-2", &spec.terms, &error));
  const auto problem = MakeFitProblem(rhino->curve_fit()->data(), spec, &error);
  ASSERT_NE(problem, nullptr) << error;
  const std::vector<NamedCurve> curves =
      FitBesideTheUnfaired(*problem, RunSolver(*problem, "banded_qr").x);
  ASSERT_EQ(curves.size(), 2U);
  EXPECT_LT(MeasureFairness(curves[0].curve).curvature_variation,
            0.5 * MeasureFairness(curves[1].curve).curvature_variation);
  const std::vector<PlotPanel> panels = CurvaturePanels(curves);
  ASSERT_EQ(panels.size(), 3U);
  EXPECT_EQ(panels[2].series.size(), 2U);
  EXPECT_EQ(FitBesideTheUnfaired(*rhino, RunSolver(*rhino, "banded_qr").x).size(), 1U);
}

}  // namespace
}  // namespace batten
