#include <gtest/gtest.h>

#include "splines/closest_point.h"
#include "tests/solvers/contract_cases.h"

namespace batten {
namespace {

TEST(BestOf, EndsLowerTheMoreStartsItHas) {
  const auto problem = MakeFileFit("animals/rhino_100.csv", MakeFreeSpec(3, true, 12));
  double before = std::numeric_limits<double>::infinity();
  for (const int starts : {1, 5, 25}) {
    SolverTrial trial(*problem, "best_of/starts=" + std::to_string(starts) + ":foot_newton");
    const double energy = trial.context.Energy(trial.x);
    // The same starts and more; the polishing of another basin may gain less than that of the last.
    EXPECT_LE(energy, before * (1.0 + 1e-3)) << starts;
    EXPECT_EQ(trial.context.notes().count("best start"), 1U);
    before = energy;
  }
  SolverTrial once(*problem, "foot_newton");
  EXPECT_LT(before, 0.8 * once.context.Energy(once.x));
}

TEST(BestOf, BooksNothingHigherThanWhatItHas) {
  for (const char* base : {"newton", "foot_newton"}) {
    const auto problem =
        MakeFit(WithoutWeights(MakeNoisyBean(60, 2, 321)), MakeFreeSpec(3, true, 12));
    SolverTrial trial(*problem, std::string("best_of/starts=4:") + base, {3000});
    ASSERT_GT(trial.iterations(), 1);
    double before = std::numeric_limits<double>::infinity();
    for (const Eigen::VectorXd& iterate : trial.context.iterates()) {
      const double energy = trial.context.Energy(iterate);
      EXPECT_LE(energy, before * (1.0 + 1e-9)) << base;
      before = energy;
    }
  }
}

TEST(BestOf, ComparesEndsAtTheirFeetAndGoesOnFromThere) {
  const auto problem = MakeFileFit("animals/cat_110.csv", MakeFreeSpec(3, true, 12));
  const CurveFit& fit = *problem->curve_fit();
  const auto at_feet = [&](const Eigen::VectorXd& x) {
    const BsplineCurve curve = fit.Curve(x);
    Eigen::VectorXd feet = fit.Parameters(x);
    Eigen::VectorXd squared_distances;
    ClosestPoint(curve).FindAll(fit.data().points, 1, &feet, &squared_distances);
    return squared_distances.sum() / problem->units().energy;
  };
  // Five steps of a method that does not project leave t behind.
  SolverTrial alone(*problem, "lbfgs", {5});
  ASSERT_GT(alone.context.Energy(alone.x), 1.01 * at_feet(alone.x));
  SolverTrial several(*problem, "best_of/starts=3/steps=5:lbfgs");
  ASSERT_GT(several.context.iterates().size(), 2U);
  const Eigen::VectorXd& first_end = several.context.iterates()[1];
  const double energy = several.context.Energy(first_end);
  EXPECT_NEAR(at_feet(first_end), energy, 1e-9 * energy);
}

TEST(BestOf, DisturbsTheStartByNothingIfSoAsked) {
  const auto problem = MakeFileFit("animals/cat_110.csv", MakeFreeSpec(3, true, 12));
  SolverTrial still(*problem, "best_of/starts=3/disturbance=0:foot_newton");
  SolverTrial once(*problem, "best_of/starts=1:foot_newton");
  const double energy = once.context.Energy(once.x);
  EXPECT_NEAR(still.context.Energy(still.x), energy, 1e-9 * energy);
}

}  // namespace
}  // namespace batten
