// What the catalogue says of problems with many minima, and what compare makes of it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

TEST(BestKnown, OfTheRhinoIsFoundFromTheStartThatItsSourceNames) {
  constexpr double kDisturbance = 0.3;
  constexpr std::uint64_t kSeed = 1;
  constexpr int kStart = 26;
  const CatalogueEntry entry = Entry("rhino_free");
  std::string error;
  const auto problem = LoadProblem(entry, &error);
  ASSERT_NE(problem, nullptr) << error;
  const auto from = FromDisturbedCircle(*problem, kDisturbance, kSeed, kStart, &error);
  ASSERT_NE(from, nullptr) << error;
  const BasinEnd end = Polish(*from, RunSolver(*from, "foot_newton", {}).x);
  EXPECT_TRUE(end.polished);
  EXPECT_NEAR(end.energy_at_foot_points, entry.reference_energy, 1e-9 * entry.reference_energy);
}

TEST(BestKnown, OfTheDolphinIsTheMinimumNearTheCurveThatItsSourcePointsTo) {
  // Which minimum a run from a circle ends in, roundings decide: the curve itself, to a decimal.
  constexpr double kControlPoints[][2] = {{-66.7, 95.2},    {681.9, -121.0}, {251.6, -129.4},
                                          {46.7, -524.1},   {118.7, 8.7},    {714.0, -22.9},
                                          {-403.8, -682.5}, {216.0, -350.9}, {127.2, -599.7},
                                          {71.7, -38.4},    {241.8, 35.6},   {549.8, -562.9}};
  const CatalogueEntry entry = Entry("dolphin_free");
  std::string error;
  const auto problem = LoadProblem(entry, &error);
  ASSERT_NE(problem, nullptr) << error;
  const CurveFit& fit = *problem->curve_fit();
  Points control_points(static_cast<Eigen::Index>(std::size(kControlPoints)), 2);
  for (Eigen::Index j = 0; j < control_points.rows(); ++j) {
    control_points.row(j) << kControlPoints[j][0], kControlPoints[j][1];
  }
  Eigen::VectorXd feet = fit.parameters();
  ClosestPoint(BsplineCurve(fit.basis(), control_points))
      .FindAll(fit.data().points, 1, &feet, nullptr);
  const BasinEnd end = Polish(*problem, fit.Variables(control_points, feet));
  EXPECT_TRUE(end.polished);
  EXPECT_NEAR(end.energy_at_foot_points, entry.reference_energy, 1e-9 * entry.reference_energy);
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
              Contains("rhino_free: best known E at feet 274.2809, the lowest of these runs "
                       "411.4214, 50.0 % above"));
  result.rows[0].report.energy_at_foot_points = best * (1 + 1e-12);
  EXPECT_THAT(ComparisonNotes(result), Contains(HasSubstr("the lowest of these runs equals it")));
  result.rows[0].report.energy_at_foot_points = 0.9 * best;
  EXPECT_THAT(ComparisonNotes(result), Contains(HasSubstr("10.0 % below, which is news")));
  // A least energy is no best known one.
  EXPECT_THAT(ComparisonNotes(result), Not(Contains(HasSubstr("rhino: best known"))));
}

}  // namespace
}  // namespace batten
