// `compare --starts`, run as a process.
#include <gmock/gmock.h>

#include <cmath>
#include <sstream>

#include "cost_functions/options.h"
#include "tests/tools/program.h"

namespace batten {
namespace {

using ::testing::HasSubstr;

TEST(CompareStarts, CountsBasinsOfEverySolver) {
  const TemporaryFolder folder;
  const Ended ended =
      RunBatten({"compare", "--problems=dolphin_free", "--solvers=foot_newton,newton", "--starts=3",
                 "--out=" + (folder / "out"), "--quiet"});
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("From 3 disturbed circles"));
  const auto solvers = Lines(ReadFile(folder / "out/starts_solvers.csv"));
  ASSERT_EQ(solvers.size(), 3U);
  EXPECT_THAT(solvers[1], HasSubstr("dolphin_free,foot_newton,3,"));
  EXPECT_EQ(Lines(ReadFile(folder / "out/starts_runs.csv")).size(), 7U);
  EXPECT_GE(Lines(ReadFile(folder / "out/starts_basins_dolphin_free.csv")).size(), 2U);
}

TEST(CompareStarts, SaysOfEveryBasinWhatItsCurveIsLike) {
  // 60 points of a circle of radius 1: 2 pi long, turning by 2 pi, farthest from the data half-way
  // between two of them.
  constexpr int kPoints = 60;
  const TemporaryFolder folder;
  std::string points = "x,y\n";
  for (int i = 0; i < kPoints; ++i) {
    const double angle = 2.0 * M_PI * i / kPoints;
    points += NumberText(std::cos(angle)) + "," + NumberText(std::sin(angle)) + "\n";
  }
  folder.Write("round.csv", points);
  folder.Write("round.json",
               R"({"name": "round", "summary": "a circle", "data": "round.csv",
                   "parameter_kind": "free", "start": "circle",
                   "spline": {"degree": 3, "closed": true, "control_points": 12}})");
  const Ended ended =
      RunBatten({"compare", "--problems=" + (folder / "round.json"), "--solvers=newton",
                 "--starts=3", "--out=" + (folder / "out"), "--quiet"});
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("num_free_loops"));
  const auto lines = Lines(ReadFile(folder / "out/starts_basins_round.csv"));
  ASSERT_GE(lines.size(), 2U);
  EXPECT_EQ(lines[0],
            "problem,basin,energy,energy_at_foot_points,length,turning,num_free_loops,"
            "max_distance_to_data,newton,newton seconds");
  std::stringstream cells(lines[1]);
  std::vector<std::string> best;
  for (std::string cell; std::getline(cells, cell, ',');) best.push_back(cell);
  ASSERT_GT(best.size(), 7U);
  // A closed cubic of 12 control points is off a circle by about (2 pi / 12)^4 / 384.
  constexpr double kOff = 2e-4;
  EXPECT_LT(std::stod(best[3]), kPoints * kOff * kOff);
  EXPECT_NEAR(std::stod(best[4]), 2.0 * M_PI, 2.0 * M_PI * kOff);
  EXPECT_NEAR(std::stod(best[5]), 2.0 * M_PI, 1e-6);  // convex
  EXPECT_EQ(best[6], "0");
  // Found to 0.1 %, and the curve is off the circle.
  const double half_way = 2.0 * std::sin(M_PI / (2.0 * kPoints));
  EXPECT_NEAR(std::stod(best[7]), half_way, 1e-3 * half_way + kOff);
}

TEST(CompareStarts, GivesTheSameNumbersTwiceButForTimes) {
  const auto energies = [] {
    const TemporaryFolder folder;
    RunBatten({"compare", "--problems=cat_free", "--solvers=newton", "--starts=2",
               "--out=" + (folder / "out"), "--quiet"});
    std::string text;
    for (const std::string& line : Lines(ReadFile(folder / "out/starts_runs.csv"))) {
      // problem,solver,start,status,iterations,seconds,energy,...
      std::size_t comma = 0;
      for (int k = 0; k < 5; ++k) comma = line.find(',', comma) + 1;
      text += line.substr(0, comma) + line.substr(line.find(',', comma)) + "\n";
    }
    return text;
  };
  EXPECT_EQ(energies(), energies());
}

TEST(CompareStarts, RefusesFixedParametersAndNoStarts) {
  const Ended fixed = RunBatten({"compare", "--problems=rhino", "--solvers=cg", "--starts=2"});
  EXPECT_EQ(fixed.status, 2);
  EXPECT_THAT(fixed.err, HasSubstr("rhino: starts are compared where E may have several minima"));
  const Ended none =
      RunBatten({"compare", "--problems=rhino_free", "--solvers=newton", "--starts=0"});
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.err, HasSubstr("--starts: found 0"));
}

}  // namespace
}  // namespace batten
