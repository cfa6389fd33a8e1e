#include "experiments/comparison_reference.h"

#include <gtest/gtest.h>

#include <cmath>

#include "problems/fit_problem.h"
#include "tests/roundoff.h"

namespace batten {
namespace {

/// Degree 1, as many control points as points: A is the identity, P* the data.
std::unique_ptr<Problem> Polyline() {
  DataSet data;
  data.name = "polyline";
  data.points.resize(5, 2);
  data.points << 0, 0, 3, 1, 4, 4, 8, 2, 6, 0;
  FitSpec spec;
  spec.degree = 1;
  spec.control_points = 5;
  spec.start = "centroid";
  std::string error;
  return MakeFitProblem(data, spec, &error);
}

TEST(DirectReference, KnowsThePolyline) {
  const auto problem = Polyline();
  const DirectReference direct(*problem);
  ASSERT_TRUE(direct.known());
  EXPECT_TRUE(direct.unique());
  const CurveFit& fit = *problem->curve_fit();
  const Points& data = fit.data().points;
  const double start = (data.rowwise() - data.colwise().mean()).squaredNorm();  // E at the centroid
  EXPECT_NEAR(direct.minimum_energy(), 0.0, 100 * std::pow(8 * kEpsilon, 2));
  EXPECT_NEAR(direct.Gap(problem->start()), 1.0, 8 * kEpsilon);
  for (const double move : {2.0, 1e-3, 1e-12}) {
    Points moved = data;
    moved(2, 0) += move;
    const Eigen::VectorXd x = fit.Variables(moved);
    // Coordinates up to 8 are rounded, the difference of neighbours no further.
    const double rounding = 32 * kEpsilon / move;
    EXPECT_NEAR(direct.Gap(x), move * move / start, 4 * rounding * move * move / start);
    EXPECT_NEAR(direct.Excess(x), move * move, 4 * rounding * move * move);
    EXPECT_NEAR(direct.Distance(x), move / 8, 4 * rounding * move / 8);
  }
}

TEST(DirectReference, AllowsADistanceByGradientAndCondition) {
  const auto problem = Polyline();
  const DirectReference direct(*problem);
  RunResult run;
  run.x = problem->start();
  run.gradient_norm = 1e-3;
  // ||P - P*|| <= |g| / (2 lambda), lambda = 1, doubled, over the size 8.
  EXPECT_NEAR(direct.AllowedDistance(run), 1e-3 / 8, 1e-12);
  run.gradient_norm = 0.0;
  EXPECT_LT(direct.AllowedDistance(run), 1e-13);
  EXPECT_GT(direct.Distance(run.x), direct.AllowedDistance(run));  // a lie would be caught
}

TEST(DirectReference, IsUnknownWhereTheEnergyIsNotQuadratic) {
  DataSet data;
  data.points.resize(8, 1);
  data.points << 0, 1, 0, 2, 5, 1, 0, 3;
  FitSpec spec;
  spec.control_points = 5;
  spec.terms = {{"interpolation", {{"loss", "huber"}}, nullptr}};
  std::string error;
  const auto problem = MakeFitProblem(data, spec, &error);
  ASSERT_NE(problem, nullptr) << error;
  const DirectReference direct(*problem);
  EXPECT_FALSE(direct.known());
  EXPECT_TRUE(std::isnan(direct.minimum_energy()));
  EXPECT_TRUE(std::isnan(direct.Gap(problem->start())));
  EXPECT_TRUE(std::isnan(direct.Distance(problem->start())));
}

}  // namespace
}  // namespace batten
