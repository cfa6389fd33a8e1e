// The command `subdivide`, run as a process.
#include <gmock/gmock.h>

#include <cmath>

#include "tests/tools/program.h"

namespace batten {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr char kCubic[] = "x,y\n0,0\n1,3\n2,-3\n3,0\n";

nlohmann::json ReadJson(const std::string& path) { return nlohmann::json::parse(ReadFile(path)); }

TEST(SubdivideCommand, WritesPolylineReportAndFigure) {
  const TemporaryFolder folder;
  const std::string curve = folder.Write("curve.csv", kCubic);
  const Ended ended =
      RunBatten({"subdivide", curve, "--rule=flatness", "--relative_tolerance=1e-4",
                 "--out=" + (folder / "polyline.csv"), "--figure=" + (folder / "cut.svg"),
                 "--report=" + (folder / "cut.json")});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(folder.Names(),
              ElementsAre("curve.csv", "cut.dat", "cut.gp", "cut.json", "cut.svg", "polyline.csv"));
  const nlohmann::json report = ReadJson(folder / "cut.json");
  EXPECT_EQ(report["format"], "batten.subdivision/1");
  EXPECT_EQ(report["rule"], "flatness");
  EXPECT_EQ(report["rule_options"]["rounds"], "3");
  EXPECT_EQ(report["end"], "all_pass");
  EXPECT_GT(report["seconds"], 0.0);
  EXPECT_LE(report["true_error"]["at_least"], report["true_error"]["at_most"]);
  EXPECT_LE(report["true_error"]["relative_at_most"], 1e-4);
  const std::vector<std::string> lines = Lines(ReadFile(folder / "polyline.csv"));
  ASSERT_EQ(lines.size(), report["pieces"].get<std::size_t>() + 2);
  EXPECT_EQ(lines[0], "t,x,y");
  EXPECT_EQ(lines[1], "0,0,0");
  EXPECT_EQ(lines.back(), "1,3,0");
  EXPECT_THAT(ended.out, HasSubstr("true error at most"));
}

TEST(SubdivideCommand, APolylineCanBeFitted) {
  const TemporaryFolder folder;
  const std::string polyline = folder / "polyline.csv";
  EXPECT_EQ(RunBatten({"subdivide", folder.Write("c.csv", kCubic), "--out=" + polyline}).status, 0);
  // A cubic through its own points at its own parameters leaves rounding.
  const Ended ended = RunBatten({"fit", polyline, "--control_points=4", "--parameters=given",
                                 "--solver=banded_qr", "--out=" + (folder / "fit.json")});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_LT(ReadJson(folder / "fit.json")["energy"].get<double>(), 1e-25);
}

TEST(SubdivideCommand, CutsAFitSpanBySpan) {
  const TemporaryFolder folder;
  const std::string fit = folder / "fit.json";
  EXPECT_EQ(RunBatten({"fit", DataFile("animals/rhino_100.csv"), "--closed", "--control_points=30",
                       "--out=" + fit})
                .status,
            0);
  const Ended ended = RunBatten({"subdivide", fit, "--stop=segment", "--relative_tolerance=1e-4",
                                 "--out=" + (folder / "p.csv"), "--report=" + (folder / "r.json")});
  EXPECT_EQ(ended.status, 0) << ended.err;
  const nlohmann::json report = ReadJson(folder / "r.json");
  EXPECT_EQ(report["curves"], 30);
  EXPECT_LE(report["true_error"]["relative_at_most"], 1.0001e-4);
  const nlohmann::json knots = ReadJson(fit)["spline"]["knots"];
  const std::vector<std::string> lines = Lines(ReadFile(folder / "p.csv"));
  // The first and the last row are one point to the last bit, at the ends of the domain [u_3,
  // u_33].
  EXPECT_EQ(lines[1].substr(lines[1].find(',')), lines.back().substr(lines.back().find(',')));
  EXPECT_EQ(std::stod(lines[1]), knots[3].get<double>());
  EXPECT_EQ(std::stod(lines.back()), knots[33].get<double>());
}

TEST(SubdivideCommand, CutsThePathsOfAnSvgFile) {
  const TemporaryFolder folder;
  const std::string svg =
      folder.Write("a.svg", "<svg><path d='M0 0Q5 9 9 0Z M1 1C2 3 4 3 5 1'/></svg>");
  const Ended ended = RunBatten({"subdivide", svg, "--out=" + (folder / "p.csv")});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("3 curves"));
  const std::vector<std::string> lines = Lines(ReadFile(folder / "p.csv"));
  EXPECT_EQ(lines[0], "path,t,x,y");
  EXPECT_EQ(lines[1], "0,0,0,0");
  EXPECT_EQ(lines.back(), "1,1,5,1");
}

TEST(SubdivideCommand, CountsWhatDoesNotPassOverAllCurves) {
  const TemporaryFolder folder;
  const std::string svg = folder.Write("a.svg", "M0 0Q5 9 9 0Q13 9 18 0");
  const Ended ended = RunBatten(
      {"subdivide", svg, "--rule=half", "--max_depth=2", "--report=" + (folder / "r.json")});
  EXPECT_EQ(ended.status, 1) << ended.err;
  EXPECT_THAT(ended.err, HasSubstr("8 of 8 pieces of all 2 curves do not pass; of one curve, 4 of "
                                   "4 pieces do not pass: the bound on depth"));
  EXPECT_EQ(ReadJson(folder / "r.json")["failing_pieces"], 8);
}

TEST(SubdivideCommand, SaysWhatItLeavesOutOfAnSvgFile) {
  const TemporaryFolder folder;
  const std::string svg =
      folder.Write("a.svg", "<svg><circle r='2'/><path d='M0 0Q5 9 9 0'/><text>a</text></svg>");
  const Ended ended = RunBatten({"subdivide", svg, "--report=" + (folder / "r.json")});
  EXPECT_EQ(ended.status, 0) << ended.err;
  const std::string sentence = "left out: circle (1), text (1), since only paths are read";
  EXPECT_THAT(ended.out, HasSubstr(sentence));
  EXPECT_EQ(ReadJson(folder / "r.json")["message"], sentence);
}

TEST(SubdivideCommand, KeepsItsToleranceOrSaysThatItDoesNot) {
  const TemporaryFolder folder;
  const std::string overshoot = folder.Write("o.csv", "x,y\n0,0\n4,0\n-3,0\n1,0\n");
  const Ended by_default =
      RunBatten({"subdivide", overshoot, "--report=" + (folder / "default.json")});
  EXPECT_EQ(by_default.status, 0) << by_default.err;
  EXPECT_LE(ReadJson(folder / "default.json")["true_error"]["relative_at_most"], 1e-5 * 1.001);
  EXPECT_THAT(by_default.out, testing::Not(HasSubstr("times the tolerance")));
  const Ended by_lines = RunBatten({"subdivide", overshoot, "--stop=control_points"});
  EXPECT_EQ(by_lines.status, 0) << by_lines.err;
  EXPECT_THAT(by_lines.out, HasSubstr("times the tolerance: control_points measures from the lines "
                                      "of chords"));
}

TEST(SubdivideCommand, TheBoundOnPiecesIsOfAllCurves) {
  const TemporaryFolder folder;
  const std::string svg =
      folder.Write("a.svg", "<svg><path d='M0 0C1 3 2 -3 3 0C4 3 5 -3 6 0L7 0'/></svg>");
  const Ended ended = RunBatten({"subdivide", svg, "--max_pieces=21", "--out=" + (folder / "p.csv"),
                                 "--relative_tolerance=0"});
  EXPECT_EQ(ended.status, 1);
  // 7, then half of 14, then as many as a line needs.
  EXPECT_EQ(Lines(ReadFile(folder / "p.csv")).size(), 1 + 1 + 7 + 7 + 1);
  ExpectRefused(RunBatten({"subdivide", svg, "--max_pieces=2"}),
                {"a.svg: max_pieces is 2, must be at least 3, a piece for each curve"});
}

TEST(SubdivideCommand, TheFigureOfACurveInSpaceNamesItsAxes) {
  const TemporaryFolder folder;
  const Ended ended = RunBatten({"subdivide", folder.Write("c.csv", "x,y,z\n0,0,0\n1,2,0\n2,0,3\n"),
                                 "--figure=" + (folder / "cut.svg")});
  EXPECT_EQ(ended.status, 0) << ended.err;
  const std::string script = ReadFile(folder / "cut.gp");
  EXPECT_THAT(script, HasSubstr("set xlabel 'x'"));
  EXPECT_THAT(script, HasSubstr("set ylabel 'z'"));
  EXPECT_THAT(script, HasSubstr("polyline"));
}

TEST(SubdivideCommand, ReadsStandardInputAndCurvesInSpace) {
  const Ended ended = RunBatten({"subdivide", "-", "--out=/dev/stdout"}, "0 0 0\n1 2 0\n2 0 3\n");
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("t,x,y,z\n0,0,0,0\n"));
}

TEST(SubdivideCommand, AHitBoundIsStatusOneAndSaid) {
  const TemporaryFolder folder;
  const Ended ended = RunBatten({"subdivide", folder.Write("c.csv", kCubic), "--max_pieces=5",
                                 "--out=" + (folder / "p.csv")});
  EXPECT_EQ(ended.status, 1);
  EXPECT_THAT(ended.err, HasSubstr("pieces do not pass: the bound of 5 pieces was hit"));
  EXPECT_EQ(Lines(ReadFile(folder / "p.csv")).size(), 7);  // header and 6 vertices
}

struct BadCurve {
  const char* name;
  const char* file;
  const char* text;
  const char* message;
};
void PrintTo(const BadCurve& bad, std::ostream* stream) { *stream << bad.name; }

class BadCurveFile : public ::testing::TestWithParam<BadCurve> {};
INSTANTIATE_TEST_SUITE_P(
    SubdivideCommand, BadCurveFile,
    ::testing::Values(
        BadCurve{"NotANumber", "c.csv", "x,y\n0,0\n1,nan\n", "c.csv:3:2: "},
        BadCurve{"Weights", "c.csv", "x,y,weight\n0,0,1\n1,0,1\n",
                 "c.csv: found the column weight"},
        BadCurve{"BrokenJson", "c.json", "{\"spline\": ", "c.json: line 1"},
        BadCurve{"NoSpline", "c.json", "{\"a\": 1}", "c.json: /spline"},
        BadCurve{
            "RaggedPoints", "c.json", "{\"control_points\": [[0, 0], [1]]}",
            "c.json: /control_points/1: found a list; allowed: a point of 2 coordinates, as the "
            "first"},
        BadCurve{"ATextAmongNumbers", "c.json", "{\"control_points\": [[0, 0], [1, \"a\"]]}",
                 "c.json: /control_points/1/1: found \"a\"; allowed: a number"},
        BadCurve{
            "NoPoints", "c.json", "{\"control_points\": []}",
            "c.json: /control_points: found an empty list; allowed: a list of points of 1 to 4 "
            "coordinates"},
        BadCurve{"FiveCoordinates", "c.json", "{\"control_points\": [[0, 0, 0, 0, 0]]}",
                 "c.json: /control_points/0: found"},
        BadCurve{"TooWide", "c.json", "{\"control_points\": [[-1.7e308, 0], [1.7e308, 1]]}",
                 "c.json: the box of all control points is wider than the largest number"},
        BadCurve{"HalfAFile", "c.svg", "<svg><path d='M0 0L1 1'/>", "c.svg:1:"},
        BadCurve{"TooFewPoints", "c.json",
                 "{\"spline\": {\"degree\": 1, \"periodic\": false, \"knots\": [0, 0, 1, 1], "
                 "\"control_points\": [[0, 0]]}}",
                 "c.json: /spline/control_points: found"},
        BadCurve{"BadKnots", "c.json",
                 "{\"spline\": {\"degree\": 1, \"periodic\": false, \"knots\": [0, 2, 1, 1], "
                 "\"control_points\": [[0, 0], [1, 1]]}}",
                 "c.json: /spline/knots: "},
        BadCurve{"AnArc", "c.svg", "M0 0\nA1 1 0 0 0 2 2", "c.svg:2:1: found \"A1 1"}),
    [](const auto& given) { return std::string(given.param.name); });

TEST_P(BadCurveFile, IsRefusedByItsPlaceAndNothingIsWritten) {
  const TemporaryFolder folder;
  const std::string path = folder.Write(GetParam().file, GetParam().text);
  const Ended ended = RunBatten({"subdivide", path, "--out=" + (folder / "p.csv")});
  ExpectRefused(ended, {GetParam().message});
  EXPECT_THAT(folder.Names(), ElementsAre(GetParam().file));
}

TEST(SubdivideCommand, RefusesTooManyControlPoints) {
  std::string points = "x,y\n";
  for (int i = 0; i < 62; ++i) points += std::to_string(i) + ",0\n";
  ExpectRefused(RunBatten({"subdivide", "-"}, points),
                {"found 62 control points; allowed: 1 to 61"});
}

TEST(SubdivideCommand, RefusesFlagsOutsideTheirRanges) {
  const TemporaryFolder folder;
  const std::string curve = folder.Write("c.csv", kCubic);
  const auto refused = [&](const std::string& flag, const std::string& message) {
    ExpectRefused(RunBatten({"subdivide", curve, flag}), {message});
  };
  refused("--rule=hulk", "--rule: unknown cut rule \"hulk\"; did you mean hull?");
  refused("--rule=hull/rounds=99", "--rule: ");
  refused("--stop=flat", "--stop: found \"flat\"; allowed: ");
  refused("--relative_tolerance=-1", "--relative_tolerance: found -1; allowed: ");
  refused("--max_depth=51", "--max_depth: found 51; allowed: 1 to 50");
  refused("--subdivision=both", "--subdivision: found \"both\"; allowed: adaptive, uniform");
  refused("--figure=a.png", "--figure: found \"a.png\"; allowed: NAME.svg");
  ExpectRefused(RunBatten({"subdivide", curve, "--stop=angle", "--relative_tolerance=2"}),
                {"--relative_tolerance is 2.000000, must be in [0, pi / 2)"});
  ExpectRefused(RunBatten({"subdivide", curve, "--rule=longest", "--subdivision=uniform"}),
                {"longest takes one piece after the other"});
  ExpectRefused(RunBatten({"subdivide", curve, "--out=" + curve}), {"--out: found"});
  ExpectRefused(RunBatten({"subdivide"}), {"subdivide: found 0 files; allowed: one"});
  EXPECT_THAT(folder.Names(), ElementsAre("c.csv"));
}

TEST(SubdivideCommand, TheListKnowsTheRules) {
  const Ended ended = RunBatten({"list", "rules", "--json"});
  EXPECT_EQ(ended.status, 0);
  const nlohmann::json rules = nlohmann::json::parse(ended.out)["rules"];
  std::vector<std::string> names;
  for (const nlohmann::json& rule : rules) names.push_back(rule["name"]);
  EXPECT_THAT(names, ElementsAre("flatness", "half", "hull", "longest", "share"));
  EXPECT_THAT(RunBatten({"list", "rules"}).out, HasSubstr("/rounds=3"));
}

}  // namespace
}  // namespace batten
