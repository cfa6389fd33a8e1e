#include "experiments/fit_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "problems/fit_problem.h"
#include "tests/experiments/outlines.h"
#include "tests/roundoff.h"

namespace batten {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

/// An open cubic through noise-free points of a parabola: minimum 0, reproduced exactly.
DataSet Parabola(int m) {
  DataSet data;
  data.name = "parabola";
  data.points.resize(m, 2);
  for (int i = 0; i < m; ++i) {
    const double t = static_cast<double>(i) / (m - 1);
    data.points.row(i) << 10 * t, 3 * t * t;
  }
  return data;
}

/// Points on two rows, one above the other: no curve with few control points meets them.
DataSet Zigzag(int m) {
  DataSet data = Parabola(m);
  for (int i = 0; i < m; i += 2) data.points(i, 1) += 1.0;
  return data;
}

std::unique_ptr<Problem> MakeProblem(DataSet data, FitSpec spec) {
  std::string error;
  if (spec.control_points == 0) spec.control_points = 8;
  std::unique_ptr<Problem> problem = MakeFitProblem(std::move(data), std::move(spec), &error);
  EXPECT_NE(problem, nullptr) << error;
  return problem;
}

TEST(MeasureFit, FindsTheParabolaThatWasDrawn) {
  const auto problem = MakeProblem(Parabola(40), {});
  const RunResult run = RunSolver(*problem, "banded_qr", {});
  const FitReport report = MeasureFit(*problem, run, {});
  // Numbers up to 10, a condition below 100.
  const double tolerance = 1000 * 10 * kEpsilon;
  EXPECT_LT(report.max, tolerance);
  EXPECT_LE(report.rms, report.max);
  EXPECT_LT(report.max_orthogonal, tolerance);
  EXPECT_TRUE(report.audited);
  EXPECT_TRUE(report.verdict.holds) << report.verdict.failure;
}

TEST(MeasureFit, AgreesWithTheAuditOnTheDistances) {
  const auto problem = MakeProblem(Zigzag(40), {});
  const RunResult run = RunSolver(*problem, "banded_qr", {});
  const FitReport report = MeasureFit(*problem, run, {});
  const double tolerance = 64 * 10 * kEpsilon;
  EXPECT_NEAR(report.rms, report.audit.rms_distance, tolerance);
  EXPECT_NEAR(report.max, report.audit.max_distance, tolerance);
  EXPECT_LT(report.rms_orthogonal, report.rms);
  EXPECT_LT(report.energy_at_foot_points, run.energy);
  EXPECT_NEAR(report.energy_at_foot_points, 40 * report.rms_orthogonal * report.rms_orthogonal,
              1e-12 * run.energy);
}

TEST(MeasureFit, WeighsFootPointsAsTheEnergyDoes) {
  DataSet data = Zigzag(40);
  data.weights = Eigen::VectorXd::LinSpaced(40, 0.0, 2.0);
  FitSpec spec;
  spec.terms = {{"interpolation", {{"weight", "3"}}, nullptr}};
  const auto problem = MakeProblem(data, spec);
  const RunResult run = RunSolver(*problem, "banded_qr", {});
  const FitReport report = MeasureFit(*problem, run, {});
  EXPECT_TRUE(report.verdict.holds) << report.verdict.failure;
  EXPECT_NEAR(report.audit.energy, run.energy, 1e-12 * run.energy);
  EXPECT_LT(report.energy_at_foot_points, run.energy);
  EXPECT_GT(report.energy_at_foot_points, 0.0);
}

TEST(MeasureFit, CatchesALyingRun) {
  const auto problem = MakeProblem(Zigzag(40), {});
  RunResult run = RunSolver(*problem, "banded_qr", {});
  run.energy *= 0.5;
  EXPECT_THAT(MeasureFit(*problem, run, {}).verdict.failure, HasSubstr("claims energy"));

  run = RunSolver(*problem, "banded_qr", {});
  run.x[3] += 1e-4;  // another point than the one that was measured
  EXPECT_FALSE(MeasureFit(*problem, run, {}).verdict.holds);

  RunSpec short_spec;
  short_spec.max_iterations = 2;
  run = RunSolver(*problem, "lspia", short_spec);
  EXPECT_EQ(run.outcome.reason, StopReason::kIterationLimit);
  EXPECT_TRUE(MeasureFit(*problem, run, short_spec).verdict.holds);
  run.outcome.reason = StopReason::kGradientSmall;
  EXPECT_THAT(MeasureFit(*problem, run, short_spec).verdict.failure, HasSubstr("claims a minimum"));
}

/// A wave of 60 points, open or closed, with weights; parameters are free.
std::unique_ptr<Problem> FreeWave(int degree, bool closed, bool hold_ends) {
  DataSet data;
  data.name = "wave";
  data.points.resize(60, 2);
  for (int i = 0; i < 60; ++i) {
    const double a = 2 * M_PI * i / 60;
    if (closed) {
      data.points.row(i) << 50 + 9 * std::cos(a), 5 * std::sin(a) + std::sin(3 * a);
    } else {
      data.points.row(i) << 50 + 3 * a, 5 * std::sin(a) + 0.3 * std::sin(9 * a);
    }
  }
  data.weights = Eigen::VectorXd::LinSpaced(60, 0.0, 2.0);
  FitSpec spec;
  spec.degree = degree;
  spec.closed = closed;
  spec.hold_ends = hold_ends;
  spec.parameter_kind = ParameterKind::kFree;
  spec.terms = {{"free_parameter", {{"weight", "3"}}, nullptr}};
  return MakeProblem(std::move(data), std::move(spec));
}

TEST(MeasureFit, AuditsFreeParametersWhereverARunEnds) {
  for (const int degree : {1, 2, 3, 4}) {
    for (const auto& [closed, hold_ends] :
         {std::pair(true, false), std::pair(false, false), std::pair(false, true)}) {
      const auto problem = FreeWave(degree, closed, hold_ends);
      for (const char* solver : {"foot_newton", "newton", "lm_schur", "tdm", "lbfgs"}) {
        for (const int iterations : {0, 3, 200}) {
          RunSpec spec;
          spec.max_iterations = iterations;
          const RunResult run = RunSolver(*problem, solver, spec);
          const FitReport report = MeasureFit(*problem, run, spec);
          EXPECT_TRUE(report.audited && report.verdict.holds)
              << solver << degree << closed << hold_ends << iterations << report.verdict.failure;
          // E and the distances at the parameters, where they are at the end.
          constexpr double kRounding = 1e-14;  // a few eps of a mean that two programs sum
          EXPECT_NEAR(report.rms, report.audit.rms_distance,
                      kRounding * std::max(100.0, report.rms));
          EXPECT_LE(report.energy_at_foot_points, run.energy * (1 + 1e-12));
        }
      }
    }
  }
}

TEST(MeasureFit, ComesToTheFootPointsWhereParametersAreFree) {
  const auto problem = FreeWave(3, true, false);
  const RunResult run = RunSolver(*problem, "foot_newton", {});
  const FitReport report = MeasureFit(*problem, run, {});
  EXPECT_EQ(run.outcome.reason, StopReason::kGradientSmall);
  EXPECT_NEAR(report.energy_at_foot_points, run.energy, 1e-8 * run.energy);
  EXPECT_GT((problem->curve_fit()->Parameters(run.x) - problem->curve_fit()->parameters())
                .cwiseAbs()
                .maxCoeff(),
            1e-3);
}

TEST(MeasureFit, CatchesALieAboutFreeParameters) {
  const auto problem = FreeWave(3, true, false);
  RunResult run = RunSolver(*problem, "foot_newton", {});
  run.x[problem->curve_fit()->setting().parameter_offset + 40] += 1e-4;
  EXPECT_FALSE(MeasureFit(*problem, run, {}).verdict.holds);
}

TEST(MeasureFit, FollowsParametersPastAnEndAsTheRunDoes) {
  const auto problem = FreeWave(3, false, false);
  const int first = problem->curve_fit()->setting().parameter_offset;
  RunSpec spec;
  spec.max_iterations = 0;
  spec.start = problem->start();
  spec.start[first] = -0.5;
  spec.start[first + 30] = 1.25;  // whose point is in the middle
  const RunResult run = RunSolver(*problem, "lbfgs", spec);
  const FitReport report = MeasureFit(*problem, run, spec);
  EXPECT_TRUE(report.verdict.holds) << report.verdict.failure;
  EXPECT_GT(report.audit.pull_norm, report.audit.gradient_floor);
  const Json json = Json::parse(FitJson(*problem, run, spec, report));
  EXPECT_EQ(json["parameters"][0], 0.0);
  EXPECT_EQ(json["parameters"][30], 1.0);
}

TEST(MeasureFit, SeesTheShapeBesideTheDataThatCount) {
  // A closed curve around a square; the one point far away has no weight.
  DataSet data;
  data.points.resize(5, 2);
  data.points << 0, 0, 1, 0, 1, 1, 0, 1, 1000, 1000;
  data.weights = Eigen::VectorXd::Ones(5);
  (*data.weights)[4] = 0.0;
  data.parameters = Eigen::VectorXd(5);
  *data.parameters << 0.0, 0.25, 0.5, 0.75, 0.8;
  FitSpec spec;
  spec.degree = 1;
  spec.closed = true;
  spec.control_points = 4;
  spec.parameters.reset();
  const auto problem = MakeProblem(std::move(data), std::move(spec));
  const RunResult run = RunSolver(*problem, "banded_qr", {});
  const FitReport report = MeasureFit(*problem, run, {});
  ASSERT_TRUE(report.shape.has_value());
  EXPECT_NEAR(report.shape->length, 4.0, 1e-9);
  EXPECT_NEAR(report.shape->rotation, 1.0, 1e-9);
  EXPECT_NEAR(report.shape->max_distance_to_data, 0.5, 1e-3);
  const Json json = Json::parse(FitJson(*problem, run, {}, report));
  EXPECT_EQ(json["shape"]["length"].get<double>(), report.shape->length);
  EXPECT_EQ(json["shape"]["turning"].get<double>(), report.shape->turning);
  EXPECT_EQ(json["shape"]["rotation"].get<double>(), report.shape->rotation);
  EXPECT_EQ(json["shape"]["num_free_loops"], 0);
  EXPECT_EQ(json["shape"]["longest_free_arc"].get<double>(), report.shape->longest_free_arc);
}

TEST(MeasureFit, CountsThePointsWhoseFootIsATie) {
  // Two legs of a right angle; of points without weight two are on the bisector, one beside it.
  DataSet data;
  data.points.resize(6, 2);
  data.points << 1, -1, 0, 0, 1, 1, 1, 0, 0.5, 0, 1, 0.25;
  data.weights = Eigen::VectorXd::Ones(6);
  data.weights->tail(3).setZero();
  data.parameters = Eigen::VectorXd(6);
  *data.parameters << 0.0, 0.5, 1.0, 0.75, 0.75, 0.75;
  FitSpec spec;
  spec.degree = 1;
  spec.control_points = 3;
  spec.parameters.reset();
  const auto problem = MakeProblem(std::move(data), std::move(spec));
  const RunResult run = RunSolver(*problem, "banded_qr", {});
  const FitReport report = MeasureFit(*problem, run, {});
  EXPECT_EQ(report.num_ties, 2);
  EXPECT_EQ(Json::parse(FitJson(*problem, run, {}, report))["distance"]["num_ties"], 2);
}

TEST(FitJson, HasNoShapeWhereThereIsNone) {
  DataSet line;
  line.points.resize(9, 1);
  for (int i = 0; i < 9; ++i) line.points(i, 0) = i * i;
  const auto problem = MakeProblem(std::move(line), {});
  const RunResult run = RunSolver(*problem, "banded_qr", {});
  const Json json = Json::parse(FitJson(*problem, run, {}, MeasureFit(*problem, run, {})));
  EXPECT_TRUE(json["shape"].is_null());
}

TEST(FitJson, HasTheFreeParametersOfTheEnd) {
  const auto problem = FreeWave(3, true, false);
  RunSpec spec;
  spec.keep_iterates = true;
  const RunResult run = RunSolver(*problem, "foot_newton", spec);
  const Json json = Json::parse(FitJson(*problem, run, spec, MeasureFit(*problem, run, spec)));
  EXPECT_EQ(json["parameter_kind"], "free");
  EXPECT_EQ(json["audit"]["verified"], true);
  const Eigen::VectorXd end = problem->curve_fit()->Parameters(run.x);
  const auto parameters = json["parameters"].get<std::vector<double>>();
  ASSERT_EQ(parameters.size(), 60u);
  EXPECT_EQ(Eigen::Map<const Eigen::VectorXd>(parameters.data(), 60), end);

  std::istringstream lines(IteratesJsonLines(*problem, run));
  std::string line;
  std::string last;
  while (std::getline(lines, line)) last = line;
  EXPECT_EQ(Json::parse(last)["parameters"].get<std::vector<double>>(), parameters);
}

TEST(ClaimOf, AsksOfARunWhatItsReasonSays) {
  RunSpec spec;
  spec.gradient_tolerance = 1e-10;
  spec.native_gradient = 1e-6;
  RunResult run;
  run.start_gradient_norm = 100.0;
  run.gradient_floor = 1e-13;
  const auto claim = [&](StopReason reason, Mode mode) {
    run.outcome.reason = reason;
    spec.mode = mode;
    return ClaimOf(run, spec);
  };
  EXPECT_EQ(claim(StopReason::kGradientSmall, Mode::kRace).gradient_target, 1e-10 * 100.0);
  EXPECT_EQ(claim(StopReason::kGradientSmall, Mode::kNative).gradient_target, 1e-6);
  EXPECT_EQ(claim(StopReason::kRoundingFloor, Mode::kRace).gradient_target, 1e-13);
  EXPECT_TRUE(claim(StopReason::kSolved, Mode::kNative).minimum);
  EXPECT_FALSE(claim(StopReason::kStepSmall, Mode::kNative).minimum);
  EXPECT_FALSE(claim(StopReason::kLineSearchEnded, Mode::kRace).minimum);
  EXPECT_FALSE(claim(StopReason::kIterationLimit, Mode::kRace).minimum);
}

TEST(FitJson, ReadsBackToTheSameNumbers) {
  FitSpec spec;
  spec.closed = true;
  spec.control_points = 9;
  const auto problem = MakeProblem(Zigzag(31), spec);
  const RunResult run = RunSolver(*problem, "lbfgs/memory=5", {});
  const FitReport report = MeasureFit(*problem, run, {});
  const Json json = Json::parse(FitJson(*problem, run, {}, report));
  const CurveFit& fit = *problem->curve_fit();

  EXPECT_EQ(json["format"], "batten.fit/1");
  EXPECT_EQ(json["spline"]["degree"], 3);
  EXPECT_EQ(json["spline"]["periodic"], true);
  EXPECT_EQ(json["spline"]["dimension"], 2);
  EXPECT_EQ(json["spline"]["knots"].get<std::vector<double>>(), fit.basis().knots());
  const auto rows = json["spline"]["control_points"].get<std::vector<std::vector<double>>>();
  const Points control_points = fit.ControlPoints(run.x);
  ASSERT_EQ(rows.size(), 9u);
  for (int j = 0; j < 9; ++j) {
    EXPECT_EQ(rows[j], std::vector<double>({control_points(j, 0), control_points(j, 1)}));
  }
  const auto parameters = json["parameters"].get<std::vector<double>>();
  EXPECT_EQ(Eigen::Map<const Eigen::VectorXd>(parameters.data(), 31), fit.parameters());
  EXPECT_EQ(json["energy"].get<double>(), run.energy);
  EXPECT_EQ(json["gradient_norm"].get<double>(), run.gradient_norm);
  EXPECT_EQ(json["distance"]["rms_orthogonal"].get<double>(), report.rms_orthogonal);
  EXPECT_EQ(json["seconds"].get<double>(), run.seconds);
}

TEST(FitJson, HasTheCurvatureAndItsComb) {
  FitSpec spec;
  spec.closed = true;
  spec.control_points = 9;
  const auto problem = MakeProblem(Zigzag(31), spec);
  const RunResult run = RunSolver(*problem, "banded_qr", {});
  const FitReport report = MeasureFit(*problem, run, {});
  const Json json = Json::parse(FitJson(*problem, run, {}, report));
  const Json& curvature = json["curvature"];
  // 25 a span, and three places where the curve is slow and bends within less than a step.
  const std::size_t num_samples = 9 * 25 + 3;
  for (const char* key : {"t", "arc_length", "kappa", "points", "tips"}) {
    EXPECT_EQ(curvature[key].size(), num_samples) << key;
  }
  EXPECT_NEAR(curvature["arc_length"][num_samples - 1].get<double>(), report.shape->length,
              1e-4 * report.shape->length);
  const BsplineCurve curve = problem->curve_fit()->Curve(run.x);
  const double tooth_length = curvature["tooth_length"].get<double>();
  ASSERT_GT(tooth_length, 0.0);
  for (std::size_t i = 0; i < num_samples; ++i) {
    double values[3 * 2];
    curve.EvaluateUpTo(curvature["t"][i].get<double>(), 2, values);
    const double kappa = (values[2] * values[5] - values[3] * values[4]) /
                         std::pow(std::hypot(values[2], values[3]), 3);
    EXPECT_NEAR(curvature["kappa"][i].get<double>(), kappa, 1e-9 * report.fairness->max_curvature);
    const auto point = curvature["points"][i].get<std::vector<double>>();
    const auto tip = curvature["tips"][i].get<std::vector<double>>();
    const double size = 1e-12 * report.shape->length;
    EXPECT_NEAR(point[0], values[0], size);
    EXPECT_NEAR(point[1], values[1], size);
    // Across the curve, by its curvature, to the right of a left turn.
    const double x = tip[0] - point[0], y = tip[1] - point[1];
    EXPECT_NEAR((values[2] * y - values[3] * x) / std::hypot(values[2], values[3]),
                -tooth_length * kappa, 1e-6 * tooth_length * report.fairness->max_curvature);
  }
  const Json& fairness = json["fairness"];
  EXPECT_GT(fairness["num_curvature_extrema"].get<int>(), 0);
  EXPECT_EQ(fairness["extreme_curvatures"].size(), fairness["curvature_extrema"].size());
  EXPECT_EQ(fairness["extreme_curvatures"][0], report.fairness->curvature_extrema[0].kappa);
}

TEST(FitJson, HasAThousandSamplesOfTheCurvatureAtMost) {
  for (const int n : {100, 700, 3000}) {
    FitSpec spec;
    spec.control_points = n;
    const auto problem = MakeProblem(Zigzag(n + 1), spec);
    const RunResult run = RunSolver(*problem, "banded_qr", {});
    const Json json = Json::parse(FitJson(*problem, run, {}, MeasureFit(*problem, run, {})));
    const auto t = json["curvature"]["t"].get<std::vector<double>>();
    EXPECT_GT(t.size(), 900U);
    EXPECT_LE(t.size(), 1000U);
    EXPECT_TRUE(std::is_sorted(t.begin(), t.end()));
    EXPECT_EQ(t.front(), problem->curve_fit()->basis().domain_begin());
    EXPECT_EQ(t.back(), problem->curve_fit()->basis().domain_end());
  }
}

TEST(FitJson, SaysWhatWasRunAndHowItEnded) {
  const auto problem = MakeProblem(Zigzag(40), {});
  const RunResult run = RunSolver(*problem, "lbfgs/memory=5", {});
  const Json json = Json::parse(FitJson(*problem, run, {}, MeasureFit(*problem, run, {})));
  EXPECT_EQ(json["problem"], "parabola");
  EXPECT_EQ(json["parameter_kind"], "fixed");
  EXPECT_EQ(json["solver"], "lbfgs/memory=5");
  EXPECT_EQ(json["options"]["memory"], "5");
  EXPECT_EQ(json["options"].size(), run.options.size());
  EXPECT_EQ(json["stop"], ToString(run.outcome.reason));
  EXPECT_EQ(json["message"], run.outcome.message);
  EXPECT_EQ(json["iterations"], run.iterations);
  EXPECT_EQ(json["notes"].size(), run.notes.size());
  EXPECT_EQ(json["counts"]["gradient_calls"], run.counts.gradient_calls);
  EXPECT_EQ(json["counts"]["products"], run.counts.products);
  EXPECT_EQ(json["audit"]["verified"], true);
  ASSERT_EQ(json["terms"].size(), 1u);
  EXPECT_EQ(json["terms"][0]["name"], "interpolation");
  // The term is summed block by block, the energy over compiled rows.
  EXPECT_NEAR(json["terms"][0]["energy"].get<double>(), run.energy,
              64 * 40 * kEpsilon * run.energy);
}

TEST(FitJson, WritesNoNumberThatIsNone) {
  const auto problem = MakeProblem(Zigzag(40), {});
  RunResult run = RunSolver(*problem, "banded_qr", {});
  run.x[0] = std::numeric_limits<double>::quiet_NaN();
  run.energy = std::numeric_limits<double>::infinity();
  run.gradient_norm = std::numeric_limits<double>::quiet_NaN();
  const Json json = Json::parse(FitJson(*problem, run, {}, MeasureFit(*problem, run, {})));
  EXPECT_TRUE(json["energy"].is_null());
  EXPECT_TRUE(json["gradient_norm"].is_null());
  EXPECT_TRUE(json["distance"]["max"].is_null());
  EXPECT_TRUE(json["spline"]["control_points"][0][0].is_null());
}

TEST(FitJson, KeepsTextThatNeedsEscaping) {
  DataSet data = Zigzag(40);
  data.name = "a \"b\"\n\xff";
  const auto problem = MakeProblem(data, {});
  const RunResult run = RunSolver(*problem, "banded_qr", {});
  const Json json = Json::parse(FitJson(*problem, run, {}, MeasureFit(*problem, run, {})));
  EXPECT_EQ(json["problem"], "a \"b\"\n\xef\xbf\xbd");  // no UTF-8: the replacement character
}

TEST(WriteFitJson, StreamsTheSameText) {
  const auto problem = MakeProblem(Zigzag(40), {});
  const RunResult run = RunSolver(*problem, "banded_qr", {});
  const FitReport report = MeasureFit(*problem, run, {});
  std::ostringstream stream;
  WriteFitJson(*problem, run, {}, report, &stream);
  EXPECT_EQ(stream.str(), FitJson(*problem, run, {}, report));
}

TEST(IteratesJsonLines, HasOneLinePerKeptIterate) {
  const auto problem = MakeProblem(Zigzag(40), {});
  RunSpec spec;
  spec.keep_iterates = true;
  const RunResult run = RunSolver(*problem, "banded_qr", spec);
  std::istringstream lines(IteratesJsonLines(*problem, run));
  std::string line;
  int count = 0;
  Json last;
  while (std::getline(lines, line)) {
    last = Json::parse(line);
    EXPECT_EQ(last["iteration"], count++);
    EXPECT_EQ(last["parameters"].size(), 40u);
  }
  EXPECT_EQ(count, run.iterations + 1);
  const Points end = problem->curve_fit()->ControlPoints(run.x);
  EXPECT_EQ(last["control_points"][7][1].get<double>(), end(7, 1));
}

/// Small numbers beside a size that is not theirs: E and g are as exact as that size allows.
TEST(MeasureFit, VerifiesFitsWhosePointsThatCountAreFarFromTheCentreOrNearZero) {
  DataSet outlier;
  outlier.points.resize(41, 2);
  outlier.weights = Eigen::VectorXd::Ones(41);
  for (int i = 0; i < 40; ++i) outlier.points.row(i) << std::cos(i * 0.157), std::sin(i * 0.157);
  outlier.points.row(40) << 1e5, 1e5;
  DataSet impulse;
  impulse.points = Points::Zero(30, 1);
  impulse.points(7, 0) = 1.0;
  impulse.weights = Eigen::VectorXd::Ones(30);
  (*impulse.weights)[7] = 0.001;
  for (const double weight : {0.0, 1e-12}) {
    (*outlier.weights)[40] = weight;
    for (const DataSet* data : {&outlier, &impulse}) {
      FitSpec spec;
      spec.closed = true;
      spec.control_points = 7;
      std::string error;
      const auto problem = MakeFitProblem(*data, spec, &error);
      ASSERT_NE(problem, nullptr) << error;
      for (const char* solver : {"banded_qr", "banded_cholesky", "lbfgs", "cg"}) {
        const RunSpec run_spec;
        const RunResult run = RunSolver(*problem, solver, run_spec);
        const FitReport report = MeasureFit(*problem, run, run_spec);
        EXPECT_TRUE(report.audited && report.verdict.holds) << solver << report.verdict.failure;
      }
    }
  }
}

}  // namespace
}  // namespace batten
