// The flag --max_distance of the command `fit`.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/tools/program.h"

namespace batten {
namespace {

constexpr char kAirfoil[] = BATTEN_SOURCE_DIR "/data/airfoils/naca2412_open.csv";

Ended Search(const std::vector<std::string>& flags) {
  std::vector<std::string> arguments = {"fit", kAirfoil, "--max_distance=0.001"};
  arguments.insert(arguments.end(), flags.begin(), flags.end());
  return RunBatten(arguments);
}

TEST(MaxDistanceCommand, WritesAFitWithinTheBound) {
  const TemporaryFolder folder;
  const std::string out = folder / "fit.json";
  const Ended ended = Search({"--out=" + out});
  EXPECT_EQ(ended.status, 0) << ended.err;
  const auto fit = nlohmann::json::parse(ReadFile(out));
  EXPECT_EQ(fit["solver"], "max_distance");
  EXPECT_EQ(fit["options"]["bound"], "0.001");
  EXPECT_LE(fit["distance"]["max_orthogonal"].get<double>(), 0.001);
  EXPECT_TRUE(fit["audit"]["verified"].get<bool>());
  // An airfoil's two sides and its nose, to a thousandth of the chord.
  EXPECT_LE(fit["spline"]["control_points"].size(), 12U);
}

TEST(MaxDistanceCommand, TakesAnotherDegreeAndClosedCurves) {
  EXPECT_EQ(Search({"--degree=2"}).status, 0);
  EXPECT_EQ(Search({"--degree=5"}).status, 0);
  const Ended closed = RunBatten({"fit", BATTEN_SOURCE_DIR "/data/animals/dolphin_80.csv",
                                  "--closed", "--max_distance=5", "--parameters=centripetal"});
  EXPECT_EQ(closed.status, 0) << closed.err;
}

TEST(MaxDistanceCommand, RefusesABoundThatIsNoLength) {
  for (const std::string bound : {"0", "-1", "nan", "1e200", "much"}) {
    ExpectRefused(RunBatten({"fit", kAirfoil, "--max_distance=" + bound}),
                  {"--max_distance", "allowed: "});
  }
}

TEST(MaxDistanceCommand, RefusesABoundBelowRounding) {
  ExpectRefused(RunBatten({"fit", kAirfoil, "--max_distance=1e-17"}),
                {kAirfoil, "1e-17", "rounding", "allowed: at least"});
}

TEST(MaxDistanceCommand, RefusesFlagsOfFitsWithGivenKnots) {
  for (const std::string flag :
       {"--control_points=9", "--solver=lbfgs", "--knots=averaged", "--terms=interpolation",
        "--parameter_kind=free", "--constraints=ends", "--fairing=gcv", "--max_seconds=1",
        "--trace=/nowhere/trace.csv"}) {
    ExpectRefused(Search({flag}), {flag.substr(0, flag.find('=')), "beside --max_distance"});
  }
  ExpectRefused(Search({"--parameters=given"}), {"--parameters", "allowed: "});
}

TEST(MaxDistanceCommand, RefusesPointsThatMakeNoCurve) {
  const auto refuse = [](const std::string& points, const std::string& found) {
    ExpectRefused(RunBatten({"fit", "-", "--max_distance=0.1"}, points), {"stdin", found});
  };
  refuse("x,y\n1,1\n1,1\n1,1\n1,1\n1,1\n", "at least 4");
  refuse("x,y\n1,1\n2,1\n", "at least 4");
  refuse("x\n1\n2\n3\n4\n5\n", "dimension 1");
}

}  // namespace
}  // namespace batten
