#include "experiments/basins.h"

#include <gtest/gtest.h>

#include <cmath>

#include "experiments/start_comparison.h"
#include "tests/experiments/outlines.h"

namespace batten {
namespace {

/// Closed uniform cubic of n control points on a circle of radius `radius`, the first at `turn`.
BsplineCurve Round(int n, double radius, double turn) {
  std::string error;
  const auto basis =
      BsplineBasis::Make(3, true, UniformKnots(3, n, EndKnots::kPeriodic, 0.0, 1.0), &error);
  Points points(n, 2);
  for (int j = 0; j < n; ++j) {
    const double a = 2.0 * M_PI * (j + turn) / n;
    points.row(j) << radius * std::cos(a), radius * std::sin(a);
  }
  return BsplineCurve(*basis, points);
}

TEST(Basins, DistancesOfCurvesAreThoseOfPointSets) {
  // Turned by a whole control point the curve is the same set of points.
  EXPECT_LT(CurveDistanceBetween(Round(8, 1.0, 0.0), Round(8, 1.0, 3.0)), 1e-14);
  // Concentric copies: the curve's radii times the difference of 1 and 1.5. The radius at control
  // points is (4 + 2 cos(2 pi / n)) / 6, the largest one of the curve.
  const double largest = (4.0 + 2.0 * std::cos(2.0 * M_PI / 8)) / 6.0;
  EXPECT_NEAR(CurveDistanceBetween(Round(8, 1.0, 0.0), Round(8, 1.5, 0.0)), 0.5 * largest, 1e-3);
}

TEST(Basins, EndsOfOneCurveShareABasinWhateverTheirSeam) {
  const auto problem = LoadCatalogueProblem("rhino_free");
  const CurveFit& fit = *problem->curve_fit();
  const RunResult run = RunSolver(*problem, "foot_newton");
  const BasinEnd end = Polish(*problem, run.x);
  EXPECT_TRUE(end.polished);
  EXPECT_LE(end.energy_at_foot_points, end.energy * (1.0 + 1e-12));
  BasinEnd turned = end;
  const Eigen::Index n = end.control_points.rows();
  for (Eigen::Index j = 0; j < n; ++j) {
    turned.control_points.row(j) = end.control_points.row((j + 5) % n);
  }
  BasinEnd moved = end;
  moved.control_points.col(0).array() += 1e-3 * fit.size();
  moved.energy_at_foot_points = EnergyAtFootPoints(fit, moved.control_points);
  turned.energy_at_foot_points = EnergyAtFootPoints(fit, turned.control_points);
  EXPECT_NEAR(turned.energy_at_foot_points, end.energy_at_foot_points,
              1e-10 * end.energy_at_foot_points);
  const std::vector<int> basins = FindBasins(*problem, {moved, end, turned});
  EXPECT_EQ(basins[1], 0);
  EXPECT_EQ(basins[2], 0);
  EXPECT_EQ(basins[0], 1);
}

TEST(Basins, OfCurvesThroughAllPointsAreToldByTheCurves) {
  // Energies of exact fits are rounding: their ratios say nothing.
  const BsplineCurve round = Round(8, 1.0, 0.0);
  std::vector<BasinEnd> ends(4);
  const double energies[] = {1e-31, 3e-30, 2e-31, 7e-31};
  for (int k = 0; k < 4; ++k) {
    ends[k].control_points = k == 3 ? Points(2.0 * round.control_points()) : round.control_points();
    ends[k].energy_at_foot_points = energies[k];
  }
  EXPECT_EQ(FindBasins(round.basis(), 2.0, ends), (std::vector<int>{0, 0, 0, 1}));
}

TEST(Basins, OfCurvesFarLargerThanTheDataAreToldByTheirOwnSize) {
  // 2e4 across beside data of size 1.
  std::vector<BasinEnd> ends(3);
  const double moves[] = {0.0, 1e-3, 0.5};
  for (int k = 0; k < 3; ++k) {
    ends[k].control_points = Round(8, 1e4, 0.0).control_points();
    ends[k].control_points.col(0).array() += moves[k];
    ends[k].energy_at_foot_points = 3.0;
  }
  EXPECT_EQ(FindBasins(Round(8, 1.0, 0.0).basis(), 1.0, ends), (std::vector<int>{0, 0, 1}));
}

TEST(Basins, PolishingABasinAgainFindsTheSameCurve) {
  const auto problem = LoadCatalogueProblem("dolphin_free");
  const CurveFit& fit = *problem->curve_fit();
  const BasinEnd end = Polish(*problem, RunSolver(*problem, "foot_newton").x);
  const Eigen::VectorXd feet = fit.parameters();
  const BasinEnd again = Polish(
      *problem,
      fit.Variables(end.control_points, RunSolver(*problem, "foot_newton").x.tail(feet.size())));
  EXPECT_EQ(FindBasins(*problem, {end, again}), (std::vector<int>{0, 0}));
}

TEST(Basins, OfSeveralMethodsNearOneMinimumAreOne) {
  const auto problem = LoadCatalogueProblem("dolphin_free");
  const Eigen::VectorXd minimum = RunSolver(*problem, "foot_newton").x;
  std::vector<BasinEnd> ends;
  double offset = 1e-4;
  for (const char* solver : {"lbfgs", "lm_schur", "newton", "tdm", "ceres_lbfgs"}) {
    // Each from another place near it.
    RunSpec spec;
    spec.start = minimum;
    for (double& value : spec.start) value += offset *= -0.999;
    spec.max_iterations = 30;
    RunResult run;
    std::string error;
    ASSERT_TRUE(batten::Run(*problem, {solver, {}, nullptr}, spec, &run, &error)) << error;
    ends.push_back(Polish(*problem, run.x));
    EXPECT_TRUE(ends.back().polished) << solver;
  }
  EXPECT_EQ(FindBasins(*problem, ends), std::vector<int>(ends.size(), 0));
}

/// A segment of lines whose first end is compared with six points at (0, 0) and four at (0, 1), its
/// second with ten at (1, 0).
std::unique_ptr<Problem> TwoHeaps(const std::string& terms) {
  DataSet data;
  data.name = "heaps";
  data.points.resize(20, 2);
  data.parameters = Eigen::VectorXd(20);
  for (int i = 0; i < 20; ++i) {
    data.points.row(i) << (i < 10 ? 0.0 : 1.0), (i >= 6 && i < 10 ? 1.0 : 0.0);
    (*data.parameters)[i] = i < 10 ? 0.0 : 1.0;
  }
  FitSpec spec;
  spec.degree = 1;
  spec.control_points = 2;
  spec.parameters.reset();
  std::string error;
  EXPECT_TRUE(ParseNameSpecList(terms, &spec.terms, &error)) << error;
  auto problem = MakeFitProblem(data, spec, &error);
  EXPECT_NE(problem, nullptr) << error;
  return problem;
}

// By hand: with Tukey's loss of scale b the points of the other heap, farther away than b, count
// b^2 / 3 each, and those of the own heap nothing.
TEST(Basins, OfALossThatIsNotConvexAreItsMinimaAtFixedParameters) {
  const auto problem = TwoHeaps("interpolation/loss=tukey/loss_scale=0.2");
  ASSERT_TRUE(MayHaveSeveralMinima(*problem));
  std::vector<BasinEnd> ends;
  for (const double y : {0.98, 0.03, -0.04, 1.05}) {
    Points start(2, 2);
    start << 0.02, y, 0.99, 0.01;
    ends.push_back(Polish(*problem, problem->curve_fit()->Variables(start)));
    EXPECT_TRUE(ends.back().polished);
    const double expected = (y > 0.5 ? 6 : 4) * 0.2 * 0.2 / 3.0;
    EXPECT_NEAR(ends.back().energy, expected, 1e-14);
  }
  EXPECT_EQ(FindBasins(*problem, ends), (std::vector<int>{1, 0, 0, 1}));
}

TEST(Basins, AreLookedForWhereEMayHaveSeveral) {
  for (const char* one : {"interpolation", "interpolation/loss=huber/loss_scale=0.1",
                          "interpolation/loss=soft_l1/loss_scale=0.1,fairing/derivative=1"}) {
    EXPECT_FALSE(MayHaveSeveralMinima(*TwoHeaps(one))) << one;
  }
  EXPECT_TRUE(MayHaveSeveralMinima(*TwoHeaps("interpolation/loss=cauchy/loss_scale=0.1")));
  EXPECT_TRUE(MayHaveSeveralMinima(*LoadCatalogueProblem("rhino_free")));
  EXPECT_FALSE(MayHaveSeveralMinima(*LoadCatalogueProblem("rhino")));
}

TEST(StartComparison, StartsDependOnSeedAndNumberAlone) {
  const auto problem = LoadCatalogueProblem("cat_free");
  std::string error;
  const auto start = [&](std::uint64_t seed, int k) {
    return FromDisturbedCircle(*problem, 0.3, seed, k, &error)->start();
  };
  EXPECT_EQ(start(1, 0), start(1, 0));
  EXPECT_NE(start(1, 0), start(1, 1));
  EXPECT_NE(start(1, 0), start(2, 0));
}

}  // namespace
}  // namespace batten
