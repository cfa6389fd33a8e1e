#include "experiments/fit_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "problems/fit_problem.h"
#include "tests/experiments/outlines.h"

namespace batten {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

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

TEST(MeasureFit, DoesNotAuditALoss) {
  FitSpec spec;
  spec.terms = {{"interpolation", {{"loss", "huber"}}, nullptr}};
  const auto problem = MakeProblem(Zigzag(40), spec);
  const FitReport report = MeasureFit(*problem, RunSolver(*problem, "ceres_lbfgs", {}), {});
  EXPECT_FALSE(report.audited);
  EXPECT_GT(report.rms, 0.0);
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
