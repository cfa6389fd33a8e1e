// What the catalogue says of problems with many minima, and what compare makes of it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "experiments/basins.h"
#include "experiments/comparison.h"
#include "experiments/comparison_tables.h"
#include "experiments/start_comparison.h"
#include "splines/closest_point.h"
#include "tests/experiments/outlines.h"

namespace batten {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

CatalogueEntry Entry(const std::string& name) {
  CatalogueEntry entry;
  std::string error;
  EXPECT_TRUE(FindProblem(name, &entry, &error)) << error;
  return entry;
}

/// Which minimum a run from a circle ends in, roundings decide: the curves that the sources point
/// to, to six digits.
struct BestCurve {
  std::string problem;
  std::vector<std::array<double, 2>> control_points;
};
std::vector<BestCurve> BestCurves() {
  return {
      {"rhino_free",
       {{198.656, -84.1938},
        {-978.735, 873.925},
        {134.516, -179.52},
        {118.029, -88.4593},
        {131.481, -18.087},
        {12.3083, -49.6054},
        {57.557, -6.23679},
        {11.8673, -95.4123},
        {4.93501, -0.850287},
        {3.03053, -119.451},
        {64.5487, -70.1402},
        {27.853, -140.412}}},
      {"cat_free",
       {{85.4537, -43.2655},
        {104.941, -219.582},
        {20.5757, 103.964},
        {43.8486, -210.586},
        {92.174, -14.1291},
        {-24.9026, -85.4269},
        {75.1291, 22.7475},
        {88.0297, -94.8174},
        {-44.4686, -27.6354},
        {231.889, -105.315},
        {-295.839, 215.976},
        {171.046, -66.3973}}},
      {"squirrel_free",
       {{201.546, -463.864},
        {548.463, -573.632},
        {237.128, 665.084},
        {545.432, -694.358},
        {-151.715, -346.396},
        {302.936, -105.243},
        {-145.041, -124.454},
        {555.243, 108.323},
        {-238.742, -903.933},
        {449.292, 123.333},
        {511.507, -412.101},
        {301.746, -262.454}}},
      {"dolphin_free",
       {{-160.477, -25.6432},
        {1070.92, -78.796},
        {-1580.45, -494.852},
        {1545.33, -55.2798},
        {52.6555, -101.701},
        {120.305, -693.037},
        {187.337, -205.006},
        {-146.408, -669.687},
        {665.101, 57.4744},
        {41.3067, -66.0299},
        {98.954, -625.308},
        {279.391, 11.855}}},
  };
}

TEST(BestKnown, IsTheMinimumNearTheCurveThatItsSourcePointsTo) {
  for (const BestCurve& best : BestCurves()) {
    SCOPED_TRACE(best.problem);
    const CatalogueEntry entry = Entry(best.problem);
    std::string error;
    const auto problem = LoadProblem(entry, &error);
    ASSERT_NE(problem, nullptr) << error;
    const CurveFit& fit = *problem->curve_fit();
    Points control_points(static_cast<Eigen::Index>(best.control_points.size()), 2);
    for (Eigen::Index j = 0; j < control_points.rows(); ++j) {
      const std::array<double, 2>& point = best.control_points[static_cast<std::size_t>(j)];
      control_points.row(j) << point[0], point[1];
    }
    Eigen::VectorXd feet = fit.parameters();
    ClosestPoint(BsplineCurve(fit.basis(), control_points))
        .FindAll(fit.data().points, 1, &feet, nullptr);
    const BasinEnd end = Polish(*problem, fit.Variables(control_points, feet));
    EXPECT_TRUE(end.polished);
    EXPECT_NEAR(end.energy_at_foot_points, entry.reference_energy, 1e-9 * entry.reference_energy);
  }
}

TEST(BestKnown, IsOneOfFreeAndProjectedParameters) {
  EXPECT_EQ(Entry("rhino_free").reference_energy, Entry("rhino_projected").reference_energy);
}

TEST(BestKnown, StandsInTheNotesBesideTheLowestOfTheRuns) {
  ComparisonResult result;
  result.spec.problems = {"rhino_free", "rhino"};
  std::string error;
  for (const std::string& name : result.spec.problems) {
    result.problems.push_back(LoadProblem(Entry(name), &error));
  }
  result.minimum_energies = {std::nan(""), 4.486845758379909};
  const double best = Entry("rhino_free").reference_energy;
  for (const double factor : {2.0, 1.5}) {
    ComparisonRow row;
    row.problem = "rhino_free";
    row.solver = "lbfgs";
    row.parameter_kind = ParameterKind::kFree;
    row.report.energy_at_foot_points = factor * best;
    result.rows.push_back(row);
  }
  EXPECT_THAT(ComparisonNotes(result),
              Contains("rhino_free: best known E at feet 200.2370, the lowest of these runs "
                       "300.3556, 50.0 % above"));
  result.rows[0].report.energy_at_foot_points = best * (1 + 1e-12);
  EXPECT_THAT(ComparisonNotes(result), Contains(HasSubstr("the lowest of these runs equals it")));
  result.rows[0].report.energy_at_foot_points = 0.9 * best;
  EXPECT_THAT(ComparisonNotes(result), Contains(HasSubstr("10.0 % below, which is news")));
  // A least energy is no best known one.
  EXPECT_THAT(ComparisonNotes(result), Not(Contains(HasSubstr("rhino: best known"))));
}

}  // namespace
}  // namespace batten
