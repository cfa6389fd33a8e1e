// What the catalogue says of problems with many minima, and what compare makes of it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/basins.h"
#include "experiments/comparison.h"
#include "experiments/comparison_tables.h"
#include "experiments/start_comparison.h"
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

TEST(BestKnown, IsFoundFromTheStartThatItsSourceNames) {
  constexpr double kDisturbance = 0.3;
  constexpr std::uint64_t kSeed = 1;
  for (const auto& [name, start] : {std::pair("rhino_free", 26), std::pair("dolphin_free", 222)}) {
    const CatalogueEntry entry = Entry(name);
    std::string error;
    const auto problem = LoadProblem(entry, &error);
    ASSERT_NE(problem, nullptr) << error;
    const auto from = FromDisturbedCircle(*problem, kDisturbance, kSeed, start, &error);
    ASSERT_NE(from, nullptr) << error;
    const BasinEnd end = Polish(*from, RunSolver(*from, "foot_newton", {}).x);
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
