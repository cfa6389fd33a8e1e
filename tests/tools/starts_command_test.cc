// `compare --starts`, run as a process.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include "cost_functions/options.h"
#include "tests/tools/program.h"

namespace batten {
namespace {

using ::testing::HasSubstr;

/// The rows of a CSV text as cells by column. No cell may hold a comma.
std::vector<std::map<std::string, std::string>> Rows(const std::string& text) {
  const auto split = [](const std::string& line) {
    std::vector<std::string> cells;
    std::stringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
    if (!line.empty() && line.back() == ',') cells.emplace_back();
    return cells;
  };
  const std::vector<std::string> lines = Lines(text);
  std::vector<std::map<std::string, std::string>> rows;
  for (std::size_t k = 1; k < lines.size(); ++k) {
    const auto columns = split(lines[0]), cells = split(lines[k]);
    EXPECT_EQ(cells.size(), columns.size()) << lines[k];
    rows.emplace_back();
    for (std::size_t c = 0; c < std::min(cells.size(), columns.size()); ++c) {
      rows.back()[columns[c]] = cells[c];
    }
  }
  return rows;
}

TEST(CompareStarts, CountsBasinsOfEverySolver) {
  const TemporaryFolder folder;
  const Ended ended =
      RunBatten({"compare", "--problems=dolphin_free", "--solvers=foot_newton,newton", "--starts=3",
                 "--out=" + (folder / "out"), "--quiet"});
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("From 3 disturbed circles"));
  EXPECT_THAT(ended.out, HasSubstr("dolphin_free: best known E at feet"));
  const auto solvers = Lines(ReadFile(folder / "out/starts_solvers.csv"));
  ASSERT_EQ(solvers.size(), 3U);
  EXPECT_THAT(solvers[1], HasSubstr("dolphin_free,foot_newton,3,"));
  EXPECT_EQ(Lines(ReadFile(folder / "out/starts_runs.csv")).size(), 7U);
  EXPECT_GE(Lines(ReadFile(folder / "out/starts_basins_dolphin_free.csv")).size(), 2U);
}

TEST(CompareStarts, LeavesFieldsEmptyOfASolverThatDoesNotRun) {
  const TemporaryFolder folder;
  const Ended ended = RunBatten({"compare", "--problems=rhino_free", "--solvers=gim,foot_newton",
                                 "--starts=1", "--out=" + (folder / "out"), "--quiet"});
  ASSERT_EQ(ended.status, 0) << ended.err;
  const auto solvers = Lines(ReadFile(folder / "out/starts_solvers.csv"));
  ASSERT_EQ(solvers.size(), 3U);
  EXPECT_EQ(solvers[1], "rhino_free,gim,0,0,0,0,,,,,,");
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
  auto solvers = Rows(ReadFile(folder / "out/starts_solvers.csv"));
  ASSERT_EQ(solvers.size(), 1U);
  // All ends are this circle, in other basins where the knots lie elsewhere along it.
  EXPECT_NEAR(std::stod(solvers[0]["median_length"]), 2.0 * M_PI, 2.0 * M_PI * kOff);
  EXPECT_EQ(solvers[0]["loop_share"], "0");
}

/// Two stretches of a cubic Bezier curve that cross each other, at their t, and nothing of the loop
/// behind the crossing: the one cubic with these points at these t has that loop.
TEST(CompareStarts, SaysHowLongTheCurvesOfASolverAreAndHowManyHaveALoop) {
  const auto at = [](double t, int axis) {
    const double points[4][2] = {{0, 0}, {6, 4}, {-5, 4}, {1, 0}};
    const double s = 1.0 - t;
    return s * s * s * points[0][axis] + 3.0 * s * s * t * points[1][axis] +
           3.0 * s * t * t * points[2][axis] + t * t * t * points[3][axis];
  };
  const TemporaryFolder folder;
  std::string points = "t,x,y\n";
  constexpr int kEach = 11;
  for (int i = 0; i < 2 * kEach; ++i) {
    const double t = i < kEach ? 0.01 * i : 1.0 - 0.01 * (2 * kEach - 1 - i);
    points += NumberText(t) + "," + NumberText(at(t, 0)) + "," + NumberText(at(t, 1)) + "\n";
  }
  folder.Write("loop.csv", points);
  // The loss bends downwards only farther out than any point is from any curve here.
  folder.Write("loop.json",
               R"({"name": "loop", "summary": "a loop", "data": "loop.csv", "parameters": "given",
                   "terms": ["interpolation/loss=cauchy/loss_scale=1000"],
                   "spline": {"degree": 3, "control_points": 4, "domain": [0, 1]}})");
  const Ended ended = RunBatten({"compare", "--problems=" + (folder / "loop.json"),
                                 "--solvers=newton,irls:banded_qr", "--starts=3",
                                 "--out=" + (folder / "out"), "--quiet"});
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("median_length  loop_share"));
  double length = 0.0;
  constexpr int kPieces = 20'000;  // chords: too short by less than 1e-7
  for (int k = 0; k < kPieces; ++k) {
    const double a = static_cast<double>(k) / kPieces, b = static_cast<double>(k + 1) / kPieces;
    length += std::hypot(at(b, 0) - at(a, 0), at(b, 1) - at(a, 1));
  }
  const auto solvers = Rows(ReadFile(folder / "out/starts_solvers.csv"));
  ASSERT_EQ(solvers.size(), 2U);
  for (auto row : solvers) {
    EXPECT_EQ(row["runs"], "3") << row["solver"];
    EXPECT_NEAR(std::stod(row["median_length"]), length, 1e-5 * length) << row["solver"];
    EXPECT_EQ(row["loop_share"], "1") << row["solver"];
  }
}

TEST(CompareStarts, CountsLoopsAndLengthsOverTheEndsOfEachSolver) {
  const TemporaryFolder folder;
  const Ended ended =
      RunBatten({"compare", "--problems=dolphin_free", "--solvers=newton,foot_newton", "--starts=8",
                 "--out=" + (folder / "out"), "--quiet"});
  ASSERT_EQ(ended.status, 0) << ended.err;
  auto basins = Rows(ReadFile(folder / "out/starts_basins_dolphin_free.csv"));
  auto runs = Rows(ReadFile(folder / "out/starts_runs.csv"));
  std::set<std::string> shares;
  for (auto row : Rows(ReadFile(folder / "out/starts_solvers.csv"))) {
    std::vector<double> lengths;
    int with_loops = 0;
    for (auto& run : runs) {
      if (run["solver"] != row["solver"]) continue;
      auto& basin = basins.at(std::stoul(run["basin"]) - 1);
      lengths.push_back(std::stod(basin["length"]));
      with_loops += basin["num_free_loops"] == "0" ? 0 : 1;
    }
    ASSERT_EQ(lengths.size(), 8U);
    std::sort(lengths.begin(), lengths.end());
    EXPECT_EQ(std::stod(row["median_length"]), (lengths[3] + lengths[4]) / 2) << row["solver"];
    EXPECT_EQ(std::stod(row["loop_share"]), with_loops / 8.0) << row["solver"];
    shares.insert(row["loop_share"]);
  }
  EXPECT_THAT(shares,
              ::testing::Contains(::testing::AllOf(::testing::Ne("0"), ::testing::Ne("1"))));
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

TEST(CompareStarts, RefusesDataOnTheLine) {
  const TemporaryFolder folder;
  folder.Write("line.csv", "x\n0\n1\n4\n2\n3\n5\n");
  folder.Write("line.json",
               R"({"name": "line", "summary": "on a line", "data": "line.csv",
                   "terms": ["interpolation/loss=cauchy"],
                   "spline": {"degree": 2, "control_points": 4}})");
  const Ended line = RunBatten({"compare", "--problems=" + (folder / "line.json"),
                                "--solvers=newton", "--starts=2", "--out=" + (folder / "out")});
  EXPECT_EQ(line.status, 2);
  EXPECT_THAT(line.err, HasSubstr("start is circle, which needs points of dimension 2 or more"));
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
