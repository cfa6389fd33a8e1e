// The command `fit` on good input, run as a process.
#include <gmock/gmock.h>

#include <cmath>

#include "cost_functions/options.h"
#include "tests/tools/program.h"

namespace batten {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kRhino = DataFile("animals/rhino_100.csv");
// SciPy 1.10: BSpline.design_matrix, linalg.lstsq; as in problems/catalogue/rhino.json.
constexpr double kRhinoEnergy = 4.486845758379909;
constexpr double kEnergyTolerance = 1e-9 * kRhinoEnergy;

/// `fit` with --out, which must succeed; its fit.json.
json FitJson(std::vector<std::string> arguments, const std::string& input = "") {
  const TemporaryFolder folder;
  arguments.insert(arguments.begin(), "fit");
  arguments.push_back("--out=" + (folder / "fit.json"));
  const Ended ended = RunBatten(std::move(arguments), input);
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(ended.err, "");
  return json::parse(ReadFile(folder / "fit.json"), nullptr, false);
}

TEST(FitCommand, FitsTheRhinocerosAndWritesAllFilesItIsAskedFor) {
  const TemporaryFolder folder;
  const Ended ended = RunBatten({"fit", kRhino, "--closed", "--control_points=80", "--solver=lbfgs",
                                 "--out=" + (folder / "fit.json"), "--trace", folder / "trace.csv",
                                 "--iterates=" + (folder / "iterates.jsonl"),
                                 "--figure=" + (folder / "rhino.svg")});
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(ended.err, "");
  EXPECT_THAT(ended.out,
              HasSubstr("100 points in 2-D, closed curve of degree 3, 80 control points"));
  EXPECT_THAT(ended.out, HasSubstr("gradient_small"));
  EXPECT_THAT(ended.out, HasSubstr("verified"));
  EXPECT_THAT(folder.Names(), ::testing::ElementsAre("fit.json", "iterates.jsonl", "rhino.dat",
                                                     "rhino.gp", "rhino.svg", "trace.csv"));

  const json fit = json::parse(ReadFile(folder / "fit.json"));
  EXPECT_EQ(fit["format"], "batten.fit/1");
  EXPECT_EQ(fit["spline"]["degree"], 3);
  EXPECT_EQ(fit["spline"]["periodic"], true);
  EXPECT_EQ(fit["spline"]["control_points"].size(), 80u);
  EXPECT_EQ(fit["spline"]["knots"].size(), 80u + 2 * 3 + 1);
  EXPECT_EQ(fit["parameters"].size(), 100u);
  EXPECT_NEAR(fit["energy"].get<double>(), kRhinoEnergy, kEnergyTolerance);
  EXPECT_EQ(fit["audit"]["verified"], true);
  EXPECT_EQ(fit["stop"], "gradient_small");

  const size_t num_rows = fit["iterations"].get<size_t>() + 1;  // the start is row 0
  const auto trace = Lines(ReadFile(folder / "trace.csv"));
  ASSERT_EQ(trace.size(), num_rows + 1);
  EXPECT_THAT(trace[0], HasSubstr("iteration,energy_calls,gradient_calls"));
  const auto iterates = Lines(ReadFile(folder / "iterates.jsonl"));
  ASSERT_EQ(iterates.size(), num_rows);
  EXPECT_EQ(json::parse(iterates.back())["control_points"], fit["spline"]["control_points"]);
  EXPECT_THAT(ReadFile(folder / "rhino.svg"), HasSubstr("</svg>"));
}

TEST(FitCommand, ReachesTheMinimumWithEverySolverOfTheList) {
  // As many control points as points, so that gim applies too: the curve passes through all.
  const json list = RunBatten({"list", "solvers", "--json"}).Json();
  for (const json& solver : list["solvers"]) {
    std::string name = solver["name"];
    if (solver["needs"] == json::array({"free parameters"})) continue;
    if (!solver["usual_base"].is_null()) name += ":" + solver["usual_base"].get<std::string>();
    const json fit = FitJson({"--problem=rhino_interpolation", "--solver=" + name});
    EXPECT_LT(fit["distance"]["max"].get<double>(), 1e-6) << name;
    EXPECT_EQ(fit["audit"]["verified"], true) << name;
  }
}

TEST(FitCommand, FitsFreeParametersAndReportsThemWhereTheyEnd) {
  const TemporaryFolder folder;
  const auto fit = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = {"fit",
                                          kRhino,
                                          "--control_points=20",
                                          "--parameter_kind=free",
                                          "--solver=foot_newton",
                                          "--out=" + (folder / "fit.json")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Ended ended = RunBatten(arguments);
    EXPECT_EQ(ended.status, 0) << ended.err;
    return ended.out;
  };
  const std::string circle = fit({"--closed", "--start=circle"});
  EXPECT_THAT(circle, HasSubstr("parameters    free, start at the feet on the circle\n"));
  EXPECT_THAT(circle, HasSubstr("verified"));
  const json closed = json::parse(ReadFile(folder / "fit.json"));
  EXPECT_EQ(closed["parameter_kind"], "free");
  EXPECT_EQ(closed["audit"]["verified"], true);
  EXPECT_EQ(closed["parameters"].size(), 100u);
  EXPECT_LE(closed["energy_at_foot_points"].get<double>(), closed["energy"].get<double>());
  // E is that of the parameters written: the mean square beside it says the same.
  const double rms = closed["distance"]["rms"];
  EXPECT_NEAR(100 * rms * rms, closed["energy"].get<double>(), 1e-9 * rms * rms);

  const std::string held = fit({"--hold_ends", "--parameters=uniform"});
  EXPECT_THAT(held, HasSubstr("parameters    free, start uniform, ends held\n"));
  const json open = json::parse(ReadFile(folder / "fit.json"));
  EXPECT_EQ(open["parameters"][0], 0.0);
  EXPECT_EQ(open["parameters"][99], 1.0);
}

TEST(FitCommand, SaysWhatShapeTheCurveHas) {
  const TemporaryFolder folder;
  const Ended ended = RunBatten({"fit", "-", "--control_points=4", "--degree=1", "--closed",
                                 "--out=" + (folder / "fit.json")},
                                "x,y\n0,0\n1,0\n1,1\n0,1\n");
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.out,
              HasSubstr("shape         length 4.00000, turning 1.00000 x 2 pi, curve to data "
                        "0.500000; no loops without data\n"));
  const json fit = json::parse(ReadFile(folder / "fit.json"));
  EXPECT_NEAR(fit["shape"]["length"].get<double>(), 4.0, 1e-9);
  EXPECT_EQ(fit["shape"]["num_free_loops"], 0);
}

TEST(FitCommand, LowersTheEnergyWithEverySolverOfFreeParameters) {
  const json list = RunBatten({"list", "solvers", "--json"}).Json();
  int num_solvers = 0;
  for (const json& solver : list["solvers"]) {
    if (solver["needs"] != json::array({"free parameters"}) || solver["wraps_solver"]) continue;
    ++num_solvers;
    const TemporaryFolder folder;
    const std::string name = solver["name"];
    const Ended ended = RunBatten({"fit", "--problem=rhino_free", "--solver=" + name,
                                   "--max_iterations=20", "--out=" + (folder / "fit.json")});
    // Slow ones do not reach the target in 20 iterations: a result all the same.
    EXPECT_LE(ended.status, 1) << ended.err;
    const json fit = json::parse(ReadFile(folder / "fit.json"), nullptr, false);
    ASSERT_TRUE(fit.is_object()) << name;
    // 11,567 is E of the circle at its feet.
    EXPECT_LT(fit["energy"].get<double>(), 0.5 * 11567.0) << name;
    EXPECT_LE(fit["energy_at_foot_points"].get<double>(),
              fit["energy"].get<double>() * (1.0 + 1e-9))
        << name;
  }
  EXPECT_GE(num_solvers, 7);
}

TEST(FitCommand, TakesFreeParametersAndTheirStarts) {
  const TemporaryFolder folder;
  const std::string fit = folder / "fit.json";
  const std::vector<std::string> common = {"fit",
                                           kRhino,
                                           "--closed",
                                           "--control_points=12",
                                           "--parameter_kind=free",
                                           "--solver=foot_newton"};
  const auto with = [&common](std::vector<std::string> more) {
    more.insert(more.begin(), common.begin(), common.end());
    return RunBatten(std::move(more));
  };
  for (const char* start : {"circle", "ellipse", "data"}) {
    EXPECT_EQ(with({std::string("--start=") + start, "--out=" + fit}).status, 0) << start;
  }
  // From its own end a run has nothing left to do.
  const Ended again = with({"--start=" + fit});
  EXPECT_LE(again.status, 1) << again.err;
  ExpectRefused(with({"--start=" + (folder / "none.json")}), {"--start", "none.json", "allowed: "});
  ExpectRefused(with({"--start=sphere"}), {"--start", "sphere", "data, centroid, circle, ellipse"});
  // Control points of another kind of curve are another curve's.
  ExpectRefused(with({"--start=" + fit, "--degree=4"}), {"--start", "a closed one of degree 4"});
  ExpectRefused(with({"--start=" + fit, "--noclosed"}), {"--start", "an open one of degree 3"});
  EXPECT_EQ(with({"--hold_ends"}).status, 2);
  EXPECT_EQ(RunBatten({"fit", kRhino, "--control_points=12", "--hold_ends"}).status, 2);
}

TEST(FitCommand, GuardsEstimatedRobustFitsUnlessToldNotTo) {
  const auto terms = [](const char* guard) {
    return FitJson({kRhino, "--closed", "--control_points=12", "--parameter_kind=free",
                    "--terms=free_parameter/loss=tukey/loss_scale=mad", "--solver=foot_newton",
                    guard})["terms"];
  };
  EXPECT_EQ(terms("--guard=none").size(), 1U);
  EXPECT_THAT(terms("--guard=bending").at(1)["name"], HasSubstr("fairing/derivative=2"));
  EXPECT_THAT(terms("--quiet").at(1)["name"], HasSubstr("fairing/derivative=1"));
}

TEST(FitCommand, ReadsPointsFromStandardInput) {
  const json fit = FitJson({"-", "--closed", "--control_points=80"}, ReadFile(kRhino));
  EXPECT_NEAR(fit["energy"].get<double>(), kRhinoEnergy, kEnergyTolerance);
}

TEST(FitCommand, ReproducesAStraightLine) {
  const json fit = FitJson({"-", "--control_points=5", "--parameters=chord_length"},
                           "x,y,z\n0,0,0\n1,2,3\n2,4,6\n4,8,12\n5,10,15\n7,14,21\n");
  EXPECT_EQ(fit["spline"]["dimension"], 3);
  EXPECT_LT(fit["distance"]["max"].get<double>(), 1e-8);
}

TEST(FitCommand, FitsOneCoordinate) {
  const json fit = FitJson({"-", "--control_points=4"}, "0\n1\n4\n9\n16\n25\n");
  EXPECT_EQ(fit["spline"]["dimension"], 1);
  EXPECT_LT(fit["distance"]["max"].get<double>(), 1e-7);  // a parabola is a cubic
}

TEST(FitCommand, TakesKnotsAsAListOrFromAFile) {
  const TemporaryFolder folder;
  const std::string points = folder.Write("points.csv", "x,y\n0,0\n1,3\n2,-1\n3,4\n5,2\n6,0\n");
  const std::string knots = folder.Write("knots.txt", "# clamped\n0 0 0\n0.5 # middle\n1, 1 1\n");
  const json uniform = FitJson({points, "--degree=2", "--control_points=4"});
  const json list = FitJson({points, "--degree=2", "--knots=0,0,0,.5,1,1,1"});
  const json file = FitJson({points, "--degree=2", "--knots=" + knots});
  EXPECT_EQ(list["spline"], uniform["spline"]);
  EXPECT_EQ(file["spline"], uniform["spline"]);
}

TEST(FitCommand, TakesGivenParametersAndTheirDomain) {
  const std::string points = "t,x,y\n1,0,0\n2,1,3\n3,2,-1\n4,3,4\n";
  const json range = FitJson({"-", "--parameters=given", "--control_points=4"}, points);
  EXPECT_EQ(range["parameters"], json({1.0, 2.0, 3.0, 4.0}));
  EXPECT_EQ(range["spline"]["knots"], json({1.0, 1.0, 1.0, 1.0, 4.0, 4.0, 4.0, 4.0}));
  const json wider =
      FitJson({"-", "--parameters=given", "--control_points=4", "--domain", "-1,6"}, points);
  EXPECT_EQ(wider["spline"]["knots"][0], -1.0);
  EXPECT_EQ(wider["spline"]["knots"][7], 6.0);
}

TEST(FitCommand, FollowsKnotAndEndRules) {
  const std::string points = "x,y\n0,0\n1,3\n2,-1\n3,4\n5,2\n6,0\n7,1\n";
  const std::vector<std::string> common = {"-", "--degree=2", "--control_points=4"};
  const auto knots = [&](const std::string& flag) {
    std::vector<std::string> arguments = common;
    arguments.push_back(flag);
    return FitJson(arguments, points)["spline"]["knots"];
  };
  EXPECT_EQ(knots("--knots=uniform"), json({0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0}));
  EXPECT_EQ(knots("--ends=floating"), json({-1.0, -0.5, 0.0, 0.5, 1.0, 1.5, 2.0}));
  // NURBS Book 9.68, 9.69: d = 7 / 2, i = 3, alpha = 1/2: half way between t_2 and t_3.
  EXPECT_NEAR(knots("--knots=averaged")[3].get<double>(), 2.5 / 6.0, 1e-15);
}

TEST(FitCommand, LetsFlagsOverrideAProblemOfTheCatalogue) {
  const json plain = FitJson({"--problem=rhino"});
  EXPECT_NEAR(plain["energy"].get<double>(), kRhinoEnergy, kEnergyTolerance);
  const json smaller = FitJson({"--problem=rhino", "--control_points=40", "--degree=2"});
  EXPECT_EQ(smaller["spline"]["control_points"].size(), 40u);
  EXPECT_EQ(smaller["spline"]["degree"], 2);
  EXPECT_EQ(smaller["spline"]["periodic"], true);
  const json open = FitJson({"--problem=rhino", "--noclosed"});
  EXPECT_EQ(open["spline"]["periodic"], false);
}

TEST(FitCommand, GivesTheSameAnswerWithoutCompilation) {
  const json fit = FitJson({"--problem=rhino", "--nocompile", "--gradient_tolerance=1e-8"});
  EXPECT_NEAR(fit["energy"].get<double>(), kRhinoEnergy, kEnergyTolerance);
}

TEST(FitCommand, TakesTermsAndSolversWithOptions) {
  const json fit = FitJson({"--problem=rhino", "--terms=interpolation/weight=2",
                            "--solver=lbfgs/memory=5/wolfe=strong"});
  EXPECT_NEAR(fit["energy"].get<double>(), 2 * kRhinoEnergy, 2 * kEnergyTolerance);
  EXPECT_EQ(fit["options"]["memory"], "5");
  EXPECT_EQ(fit["options"]["wolfe"], "strong");
}

TEST(FitCommand, RunsInNativeMode) {
  const json fit = FitJson({"--problem=rhino", "--mode=native", "--solver=lspia"});
  EXPECT_EQ(fit["mode"], "native");
  EXPECT_EQ(fit["stop"], "step_small");
}

TEST(FitCommand, CountsTheEndOfALineSearchNearTheFloorAsReached) {
  for (const char* problem : {"rhino", "squirrel", "dolphin", "cat", "airfoil", "hike"}) {
    for (const char* form : {"objective", "problem", "spans"}) {
      const Ended ended =
          RunBatten({"fit", std::string("--problem=") + problem,
                     std::string("--solver=ceres_lbfgs/form=") + form, "--gradient_tolerance=0"});
      EXPECT_EQ(ended.status, 0) << problem << " " << form << ended.err;
    }
  }
}

TEST(FitCommand, ExitsWithOneWhereTheLimitCameFirstAndStillWritesTheFit) {
  const TemporaryFolder folder;
  const Ended ended = RunBatten({"fit", "--problem=rhino", "--solver=lspia", "--max_iterations=3",
                                 "--out=" + (folder / "fit.json")});
  EXPECT_EQ(ended.status, 1);
  EXPECT_EQ(Lines(ended.err).size(), 1u);
  EXPECT_THAT(ended.err, HasSubstr("iteration_limit"));
  const json fit = json::parse(ReadFile(folder / "fit.json"));
  EXPECT_EQ(fit["stop"], "iteration_limit");
  EXPECT_EQ(fit["iterations"], 3);
}

TEST(FitCommand, RefusesASolverThatDoesNotApply) {
  ExpectRefused(RunBatten({"fit", "--problem=rhino", "--solver=gim"}),
                {"--solver: ", "gim needs 100 control points for 100 points"});
}

TEST(FitCommand, PrintsNoNumberThatIsNone) {
  // All points on the centroid: E(start) = 0, every ratio to it is undefined.
  const Ended ended = RunBatten({"fit", "-", "--control_points=4"}, "x,y\n1,1\n1,1\n1,1\n");
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.out, Not(HasSubstr("nan")));
  EXPECT_THAT(ended.out, Not(HasSubstr("inf ")));
}

TEST(FitCommand, ChoosesTheFairingWeightAndDrawsHow) {
  const TemporaryFolder folder;
  const Ended ended = RunBatten({"fit", kRhino, "--closed", "--control_points=80", "--fairing=gcv",
                                 "--solver=banded_qr", "--out=" + (folder / "fit.json"),
                                 "--fairing_figure=" + (folder / "choice.svg"),
                                 "--curvature_figure=" + (folder / "curvature.svg")});
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(folder.Names(),
              ::testing::ElementsAre("choice.dat", "choice.gp", "choice.svg", "curvature.dat",
                                     "curvature.gp", "curvature.svg", "fit.json"));
  const json fit = json::parse(ReadFile(folder / "fit.json"));
  EXPECT_THAT(fit["terms"][1]["name"].get<std::string>(), HasSubstr("fairing/weight="));
  EXPECT_GT(fit["fairness"]["bending_energy"].get<double>(), 0.0);
  EXPECT_GT(fit["fairness"]["num_inflections"].get<int>(), 0);
  EXPECT_EQ(fit["fairness"]["inflections"].size(), fit["fairness"]["num_inflections"]);
  EXPECT_EQ(fit["fairness"]["curvature_extrema"].size(), fit["fairness"]["num_curvature_extrema"]);
  const json& choice = fit["fairing_choice"];
  EXPECT_EQ(choice["rule"], "gcv");
  EXPECT_THAT(fit["terms"][1]["name"].get<std::string>(),
              HasSubstr("weight=" + NumberText(choice["weight"].get<double>())));
  EXPECT_NEAR(choice["residual"].get<double>(), fit["terms"][0]["energy"].get<double>(),
              1e-6 * fit["terms"][0]["energy"].get<double>());
  const double freedom = 1.0 - choice["effective_control_points"].get<double>() / 100.0;
  const double squared = choice["residual"].get<double>() / 200.0;
  EXPECT_NEAR(choice["score"].get<double>(), squared / (freedom * freedom), 1e-9 * squared);
  EXPECT_NEAR(choice["noise"].get<double>(), std::sqrt(squared / freedom), 1e-9);
  EXPECT_GE(choice["solves"].get<int>(), 3);
  EXPECT_GT(choice["seconds"].get<double>(), 0.0);
  EXPECT_THAT(ended.out, HasSubstr(" by gcv: V "));
  EXPECT_THAT(ended.out, HasSubstr(" effective control points, noise "));
}

TEST(FitCommand, ChoosesTheFairingWeightByAKnownNoise) {
  for (const std::string rule : {"risk", "discrepancy"}) {
    const TemporaryFolder folder;
    const Ended ended =
        RunBatten({"fit", kRhino, "--closed", "--control_points=50", "--fairing=" + rule,
                   "--noise=1", "--solver=banded_qr", "--out=" + (folder / "fit.json")});
    ASSERT_EQ(ended.status, 0) << ended.err;
    const json choice = json::parse(ReadFile(folder / "fit.json"))["fairing_choice"];
    EXPECT_EQ(choice["rule"], rule);
    const double squared = choice["residual"].get<double>() / 200.0;
    const double used = choice["effective_control_points"].get<double>() / 100.0;
    const double score = rule == "risk" ? squared + 2.0 * used : squared / (1.0 - used);
    EXPECT_NEAR(choice["score"].get<double>(), score, 1e-9 * score);
    EXPECT_THAT(ended.out,
                HasSubstr(" by " + rule +
                          (rule == "risk" ? ": estimated risk over " : ": RSS over what ")));
  }
}

TEST(FitCommand, WarnsOfAWeightAtAnEndOfTheScan) {
  // Points on either side of a line in turn: the fairest curve is the best one.
  std::string line = "t,x,y\n";
  for (int i = 0; i < 30; ++i) {
    const double off = i % 2 == 0 ? 1e-3 : -1e-3;
    line += NumberText(i / 29.0) + "," + NumberText(i / 29.0 + off) + "," +
            NumberText(2.0 * i / 29.0 - 0.7 * off) + "\n";
  }
  const TemporaryFolder folder;
  const Ended ended =
      RunBatten({"fit", "-", "--parameters=given", "--control_points=15", "--fairing=gcv",
                 "--solver=banded_qr", "--out=" + (folder / "fit.json")},
                line);
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("warning: fairing=gcv is best at the heaviest weight"));
  const json fit = json::parse(ReadFile(folder / "fit.json"));
  EXPECT_THAT(fit["fairing_choice"]["warning"].get<std::string>(), HasSubstr("heaviest"));
}

TEST(FitCommand, GivesTheUnitsToTheFairingTermThatARuleAdds) {
  const auto term = [](const std::string& units) {
    const json fit = FitJson({kRhino, "--closed", "--control_points=80", "--fairing=gcv",
                              "--solver=banded_qr", "--fairing_units=" + units});
    return fit["terms"][1]["name"].get<std::string>();
  };
  EXPECT_THAT(term("source"), HasSubstr("units=source"));
  EXPECT_THAT(term("scale_free"), HasSubstr("units=scale_free"));
}

TEST(FitCommand, HoldsConstraintsAndWeighsSpans) {
  const json held = FitJson({kRhino, "--control_points=20", "--solver=banded_qr",
                             "--constraints=point/t=0/x=100/y=50,natural"});
  EXPECT_NEAR(held["spline"]["control_points"][0][0].get<double>(), 100.0, 1e-9);
  EXPECT_NEAR(held["spline"]["control_points"][0][1].get<double>(), 50.0, 1e-9);
  // Twice the weight in every span is twice the weight of the term.
  const json spans = FitJson({"-", "--control_points=6", "--solver=banded_qr",
                              "--terms=interpolation,fairing/weight=1e-3", "--span_weights=2,2,2"},
                             "0 0\n1 1\n2 0\n3 3\n4 1\n5 2\n6 0\n");
  const json term = FitJson({"-", "--control_points=6", "--solver=banded_qr",
                             "--terms=interpolation,fairing/weight=2e-3"},
                            "0 0\n1 1\n2 0\n3 3\n4 1\n5 2\n6 0\n");
  EXPECT_NEAR(spans["energy"].get<double>(), term["energy"].get<double>(), 1e-13);
  EXPECT_EQ(spans["span_weights"], json({2.0, 2.0, 2.0}));
  EXPECT_TRUE(term["span_weights"].is_null());
  EXPECT_TRUE(term["fairing_choice"].is_null());
}

}  // namespace
}  // namespace batten
