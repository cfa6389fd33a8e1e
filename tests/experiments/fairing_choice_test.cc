#include "experiments/fairing_choice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <random>
#include <sstream>

#include "problems/curve_view.h"
#include "splines/brent_minimum.h"
#include "splines/normal_band.h"
#include "tests/experiments/outlines.h"

namespace batten {
namespace {

using ::testing::HasSubstr;

/// Rows of scipy_smoothing.csv, which scipy_smoothing.py beside it writes: name, kind, numbers.
using ScipyRows = std::map<std::string, std::map<std::string, std::vector<double>>>;
ScipyRows ReadScipyRows() {
  std::ifstream file(BATTEN_SOURCE_DIR "/tests/experiments/scipy_smoothing.csv");
  ScipyRows rows;
  for (std::string line; std::getline(file, line);) {
    std::istringstream fields(line);
    std::string name, kind, field;
    std::getline(fields, name, ',');
    std::getline(fields, kind, ',');
    while (std::getline(fields, field, ',')) rows[name][kind].push_back(std::stod(field));
  }
  return rows;
}

/// y over x with a knot at each x.
struct FunctionFit {
  explicit FunctionFit(const std::map<std::string, std::vector<double>>& rows) {
    const std::vector<double>& x = rows.at("x");
    const auto m = static_cast<Eigen::Index>(x.size());
    data.name = "function";
    data.points = Eigen::Map<const Eigen::VectorXd>(rows.at("y").data(), m);
    data.parameters = Eigen::Map<const Eigen::VectorXd>(x.data(), m);
    spec.parameters.reset();
    spec.given_knots = x;
    spec.given_knots.insert(spec.given_knots.begin(), 3, x.front());
    spec.given_knots.insert(spec.given_knots.end(), 3, x.back());
  }
  std::unique_ptr<Problem> Make(double weight) const {
    FitSpec weighted = spec;
    std::string error;
    EXPECT_TRUE(ParseNameSpecList("interpolation,fairing/weight=" + NumberText(weight),
                                  &weighted.terms, &error));
    auto problem = MakeFitProblem(data, weighted, &error);
    EXPECT_NE(problem, nullptr) << error;
    return problem;
  }
  DataSet data;
  FitSpec spec;
};

TEST(FairingAndScipy, GiveTheSameSmoothingSplineAtTheSameWeight) {
  for (const auto& [name, rows] : ReadScipyRows()) {
    const FunctionFit function(rows);
    const std::vector<double>& x = rows.at("x");
    for (const double weight : {1e-9, 1e-6, 1e-4, 1e-3}) {
      const std::string text = weight == 1e-9   ? "1e-09"
                               : weight == 1e-6 ? "1e-06"
                               : weight == 1e-4 ? "0.0001"
                                                : "0.001";
      const std::vector<double>& theirs = rows.at("weight " + text);
      const auto problem = function.Make(weight);
      const BsplineCurve curve = problem->curve_fit()->Curve(RunSolver(*problem, "banded_qr").x);
      Eigen::VectorXd middles(static_cast<Eigen::Index>(theirs.size()));
      for (Eigen::Index i = 0; i < middles.size(); ++i) {
        const auto k = static_cast<std::size_t>(i);
        middles[i] = 0.5 * (x[k] + x[k + 1]);
      }
      const Points ours = curve.Sample(middles);
      for (Eigen::Index i = 0; i < middles.size(); ++i) {
        EXPECT_NEAR(ours(i, 0), theirs[static_cast<std::size_t>(i)], 1e-8)
            << name << " weight " << weight;
      }
    }
  }
}

/// V = (RSS / m) / (1 - tr(H) / m)^2 by dense algebra in long double.
double DenseGcv(const FunctionFit& function, double weight) {
  using LongMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
  const auto problem = function.Make(1.0);
  const NormalBand data = NormalBand::FromRows(*problem->terms()[0].family->rows());
  const NormalBand fairing = NormalBand::FromRows(*problem->terms()[1].family->rows());
  const LongMatrix n = data.ToDense().cast<long double>();
  const LongMatrix h = n + static_cast<long double>(weight) * fairing.ToDense().cast<long double>();
  const Eigen::LDLT<LongMatrix> ldlt(h);
  const Eigen::MatrixXd p =
      ldlt.solve(LongMatrix(data.right_hand_side().cast<long double>())).cast<double>();
  const auto m = static_cast<double>(function.data.points.rows());
  const double trace = static_cast<double>(ldlt.solve(n).trace());
  Eigen::VectorXd residuals;
  EXPECT_EQ(problem->terms()[0].family->Residuals(
                Eigen::Map<const Eigen::VectorXd>(p.data(), p.size()), &residuals),
            Status::kOk);
  return residuals.squaredNorm() / m / std::pow(1.0 - trace / m, 2);
}

TEST(FairingAndScipy, GcvFindsNoWorseAWeight) {
  for (const auto& [name, rows] : ReadScipyRows()) {
    FunctionFit function(rows);
    FairingChoice choice;
    std::string error;
    ASSERT_TRUE(
        ChooseFairingWeight(function.data, FairingRule::kGcv, 0.0, &function.spec, &choice, &error))
        << error;
    const double ours = DenseGcv(function, choice.weight);
    EXPECT_LE(ours, DenseGcv(function, rows.at("gcv").front()) * (1.0 + 1e-8)) << name;
    // What was judged is that number, in the user's units.
    const auto chosen = std::find_if(choice.samples.begin(), choice.samples.end(),
                                     [&](const auto& s) { return s.weight == choice.weight; });
    ASSERT_NE(chosen, choice.samples.end());
    const double unit = 1.0 / std::pow(function.Make(1.0)->curve_fit()->setting().scale, 2);
    EXPECT_NEAR(chosen->score, ours * unit, 1e-6 * ours * unit) << name;
    EXPECT_LE(choice.samples.size(), 30U);
  }
}

/// A noisy curve of known truth; open or closed.
struct NoisyCurve {
  explicit NoisyCurve(unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0.0, 1.0);
    closed = seed % 2 == 0;
    const int m = 100 + static_cast<int>(seed % 5) * 25;
    noise = 0.01 * std::pow(10.0, (seed % 3) * 0.5);
    double waves[2][6];
    for (auto& row : waves) {
      for (double& wave : row) wave = normal(random);
    }
    data.name = "noisy";
    data.points.resize(m, 2);
    data.parameters = Eigen::VectorXd(m);
    truth.resize(m, 2);
    for (int i = 0; i < m; ++i) {
      const double t = closed ? static_cast<double>(i) / m : static_cast<double>(i) / (m - 1);
      (*data.parameters)[i] = t;
      for (int c = 0; c < 2; ++c) {
        double value = 0.0;
        for (int k = 0; k < 3; ++k) {
          const double a = (closed ? 2.0 : 1.3) * M_PI * (k + 1) * t;
          value += (waves[c][2 * k] * std::cos(a) + waves[c][2 * k + 1] * std::sin(a)) / (k + 1);
        }
        truth(i, c) = value;
        data.points(i, c) = value + noise * normal(random);
      }
    }
    spec.closed = closed;
    spec.control_points = m / 2;
    spec.parameters.reset();
    spec.domain = {0.0, 1.0};
  }
  double Error(double weight) const {
    FitSpec weighted = spec;
    std::string error;
    EXPECT_TRUE(ParseNameSpecList("interpolation,fairing/weight=" + NumberText(weight),
                                  &weighted.terms, &error));
    const auto problem = MakeFitProblem(data, weighted, &error);
    const CurveFit& fit = *problem->curve_fit();
    const BsplineCurve curve = fit.Curve(RunSolver(*problem, "banded_qr").x);
    return (curve.Sample(fit.parameters()) - truth).norm();
  }
  bool closed = false;
  double noise = 0.0;
  DataSet data;
  Points truth;
  FitSpec spec;
};

/// The least error of any weight: the best of a grid of quarters of decades, then Brent's minimum
/// beside it, so that no chosen weight looks better than it is by what the grid misses.
double LeastError(const NoisyCurve& curve) {
  constexpr double kStep = 0.25;
  const auto error_at = [&](double power) { return curve.Error(std::pow(10.0, power)); };
  double best = -11.0;
  double least = error_at(best);
  for (double power = best + kStep; power <= -2.0; power += kStep) {
    const double error = error_at(power);
    if (error < least) best = power;
    least = std::min(least, error);
  }
  constexpr double kTolerance = 1e-3;
  constexpr int kMostCalls = 20;
  const double refined =
      BrentMinimum(error_at, best - kStep, best, least, best + kStep, kTolerance, kMostCalls)
          .second;
  return std::min(least, refined);
}

/// docs/fairing_weight.md has these numbers; --gtest_output=xml:FILE shows them.
TEST(FairingChoice, IsNearTheBestPossibleWeight) {
  constexpr FairingRule kRules[] = {FairingRule::kGcv, FairingRule::kDiscrepancy,
                                    FairingRule::kLCurve};
  std::map<FairingRule, std::vector<double>> ratios;
  for (unsigned seed = 1; seed <= 100; ++seed) {
    const NoisyCurve curve(seed);
    const double least = LeastError(curve);
    for (const FairingRule rule : kRules) {
      FairingChoice choice;
      FitSpec spec = curve.spec;
      std::string error;
      ASSERT_TRUE(ChooseFairingWeight(curve.data, rule, curve.noise, &spec, &choice, &error))
          << ToString(rule) << " seed " << seed << ": " << error;
      ratios[rule].push_back(curve.Error(choice.weight) / least);
    }
  }
  for (auto& [rule, sorted] : ratios) {
    std::sort(sorted.begin(), sorted.end());
    RecordProperty(std::string(ToString(rule)) + "_median", NumberText(sorted[50]));
    RecordProperty(std::string(ToString(rule)) + "_nine_of_ten", NumberText(sorted[89]));
    RecordProperty(std::string(ToString(rule)) + "_worst", NumberText(sorted.back()));
    EXPECT_GE(sorted.front(), 1.0 - 1e-6) << ToString(rule);
  }
  const auto expect_at_most = [&](FairingRule rule, double median, double nine_of_ten) {
    EXPECT_LE(ratios[rule][50], median) << ToString(rule);
    EXPECT_LE(ratios[rule][89], nine_of_ten) << ToString(rule);
  };
  expect_at_most(FairingRule::kGcv, 1.1, 1.3);
  expect_at_most(FairingRule::kDiscrepancy, 1.4, 1.9);
  expect_at_most(FairingRule::kLCurve, 1.1, 1.4);
}

TEST(FairingChoice, ByDiscrepancyLeavesTheKnownNoise) {
  NoisyCurve curve(7);
  FairingChoice choice;
  std::string error;
  const double noise = 0.01 * std::sqrt(10.0);
  ASSERT_TRUE(ChooseFairingWeight(curve.data, FairingRule::kDiscrepancy, noise, &curve.spec,
                                  &choice, &error))
      << error;
  const auto problem = MakeFitProblem(curve.data, curve.spec, &error);
  const RunResult run = RunSolver(*problem, "banded_qr");
  const double residual =
      Objective(problem.get(), nullptr).TermEnergies(run.x)[0] * problem->units().energy;
  const double expected = static_cast<double>(curve.data.points.size()) * noise * noise;
  EXPECT_NEAR(residual, expected, 1e-6 * expected);
  EXPECT_FALSE(ChooseFairingWeight(curve.data, FairingRule::kDiscrepancy, 1e-6, &curve.spec,
                                   &choice, &error));
  EXPECT_THAT(error, HasSubstr("give a larger noise"));
  EXPECT_FALSE(ChooseFairingWeight(curve.data, FairingRule::kDiscrepancy, 1e6, &curve.spec, &choice,
                                   &error));
  EXPECT_THAT(error, HasSubstr("give a smaller noise"));
}

FairingChoice ChosenByTheLCurve(NoisyCurve* curve) {
  FairingChoice choice;
  std::string error;
  EXPECT_TRUE(
      ChooseFairingWeight(curve->data, FairingRule::kLCurve, 0.0, &curve->spec, &choice, &error))
      << error;
  return choice;
}

TEST(FairingChoice, ByTheLCurveLiesBetweenNoiseAndBend) {
  NoisyCurve curve(8);
  const FairingChoice choice = ChosenByTheLCurve(&curve);
  // Half as good as no fairing at all and as a line would be far worse than this.
  EXPECT_LE(curve.Error(choice.weight), 0.9 * curve.Error(1e-14));
  EXPECT_LE(curve.Error(choice.weight), 0.1 * curve.Error(1e6));
}

TEST(FairingChoice, ByTheLCurveIsNotMisledWhereControlPointsAreAsManyAsPoints) {
  for (const double share : {1.0, 0.98, 0.9}) {
    for (const unsigned seed : {8U, 9U, 10U, 11U}) {
      SCOPED_TRACE(testing::Message() << "share " << share << " seed " << seed);
      NoisyCurve curve(seed);
      curve.spec.control_points = static_cast<int>(share * curve.data.points.rows());
      FairingChoice choice;
      std::string error;
      FitSpec spec = curve.spec;
      ASSERT_TRUE(
          ChooseFairingWeight(curve.data, FairingRule::kLCurve, 0.0, &spec, &choice, &error))
          << error;
      EXPECT_LE(choice.samples.size(), 70U);
      FairingChoice by_gcv;
      ASSERT_TRUE(
          ChooseFairingWeight(curve.data, FairingRule::kGcv, 0.0, &curve.spec, &by_gcv, &error))
          << error;
      EXPECT_LE(curve.Error(choice.weight), 3.0 * curve.Error(by_gcv.weight)) << choice.weight;
    }
  }
}

TEST(FairingChoice, ByTheLCurveRefusesAnLWithoutCorner) {
  // A parabola without noise is in the space: residuals are rounding until it is bent away.
  NoisyCurve curve(9);
  for (Eigen::Index i = 0; i < curve.data.points.rows(); ++i) {
    const double t = (*curve.data.parameters)[i];
    curve.data.points.row(i) << t, t * t;
  }
  curve.spec.control_points = static_cast<int>(curve.data.points.rows());
  FairingChoice choice;
  std::string error;
  EXPECT_FALSE(
      ChooseFairingWeight(curve.data, FairingRule::kLCurve, 0.0, &curve.spec, &choice, &error))
      << choice.weight;
  EXPECT_THAT(error, HasSubstr("fairing=lcurve finds no corner"));
}

TEST(FairingChoice, ByTheLCurveIsAsSharpAsTheCornerBetweenSamples) {
  NoisyCurve curve(8);
  const FairingChoice choice = ChosenByTheLCurve(&curve);
  // The figure shows the L and its corner.
  const std::vector<PlotPanel> panels = FairingChoicePanels(choice);
  ASSERT_EQ(panels.size(), 4U);
  EXPECT_EQ(panels[1].x_label, "RSS");
  ASSERT_EQ(panels[1].series[1].x.size(), 1U);
  const auto chosen = std::find_if(choice.samples.begin(), choice.samples.end(),
                                   [&](const auto& s) { return s.weight == choice.weight; });
  ASSERT_NE(chosen, choice.samples.end());
  EXPECT_EQ(panels[1].series[1].y[0], chosen->bend);
  for (const FairingSample& sample : choice.samples) {
    EXPECT_FALSE(sample.score > chosen->score) << sample.weight;
  }
}

/// Dense algebra from the functors' own derivatives: the hat matrix A (A'A + w D'D)^-1 A' of what
/// constraints leave, all coordinates together.
TEST(FairingChoice, JudgesConstraintsOnSingleCoordinatesByTheHatMatrixOfAllOfThem) {
  for (const char* constraints : {"point/t=0.3/x=0.4", "derivative/t=0/order=1/y=2,ends"}) {
    SCOPED_TRACE(constraints);
    NoisyCurve curve(11);
    std::string error;
    ASSERT_TRUE(ParseNameSpecList(constraints, &curve.spec.constraints, &error)) << error;
    FitSpec asked = curve.spec;
    FairingChoice choice;
    ASSERT_TRUE(ChooseFairingWeight(curve.data, FairingRule::kGcv, 0.0, &asked, &choice, &error))
        << error;
    ASSERT_TRUE(ParseNameSpecList("interpolation,fairing", &curve.spec.terms, &error)) << error;
    const auto problem = MakeFitProblem(curve.data, curve.spec, &error);
    ASSERT_NE(problem, nullptr) << error;
    Objective objective(problem.get(), nullptr);
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(objective.num_variables());
    Eigen::VectorXd residuals;
    SparseRows sparse;
    ASSERT_EQ(objective.Jacobian(zero, &residuals, &sparse), Status::kOk);
    const Eigen::MatrixXd jacobian = sparse;
    const Eigen::Index md = curve.data.points.size();
    const Eigen::MatrixXd a = jacobian.topRows(md);
    const Eigen::MatrixXd d = jacobian.bottomRows(jacobian.rows() - md);
    // Rows that constraints leave nothing of are no data.
    const auto num_data = static_cast<double>((a.rowwise().norm().array() > 1e-12).count());
    int compared = 0;
    double least = std::numeric_limits<double>::infinity(), chosen = least;
    for (const FairingSample& sample : choice.samples) {
      const Eigen::MatrixXd matrix = a.transpose() * a + sample.weight * d.transpose() * d;
      const Eigen::LDLT<Eigen::MatrixXd> factor(matrix);
      if (factor.rcond() < 1e-9) continue;  // normal equations have no digits to compare there
      const Eigen::VectorXd y =
          -factor.solve(a.transpose() * residuals.head(md) +
                        sample.weight * d.transpose() * residuals.tail(d.rows()));
      const double squared = (a * y + residuals.head(md)).squaredNorm() * problem->units().energy;
      const double trace = (factor.solve(a.transpose()) * a).trace();
      const double freedom = 1.0 - trace / num_data;
      const double score = squared / num_data / (freedom * freedom);
      EXPECT_NEAR(sample.residual, squared, 1e-6 * squared) << sample.weight;
      EXPECT_NEAR(sample.trace, trace / curve.data.points.cols(), 1e-6 * trace) << sample.weight;
      EXPECT_NEAR(sample.score, score, 1e-5 * score) << sample.weight;
      least = std::min(least, score);
      if (sample.weight == choice.weight) chosen = score;
      ++compared;
    }
    EXPECT_GE(compared, 5);
    EXPECT_NEAR(chosen, least, 1e-6 * least);
  }
}

TEST(FairingChoice, CountsNoTermAtTheEndsAsData) {
  NoisyCurve curve(11);
  FairingChoice plain, choice;
  std::string error;
  FitSpec spec = curve.spec;
  ASSERT_TRUE(ChooseFairingWeight(curve.data, FairingRule::kGcv, 0.0, &spec, &plain, &error));
  // Far too long, and so heavy that it holds: residuals of its own that no weight changes.
  ASSERT_TRUE(ParseNameSpecList("interpolation,fairing,end_tangent/x=30/y=40/weight=1e9",
                                &curve.spec.terms, &error));
  ASSERT_TRUE(ChooseFairingWeight(curve.data, FairingRule::kGcv, 0.0, &curve.spec, &choice, &error))
      << error;
  const auto problem = MakeFitProblem(curve.data, curve.spec, &error);
  const double residual =
      Objective(problem.get(), nullptr).TermEnergies(RunSolver(*problem, "banded_qr").x)[0] *
      problem->units().energy;
  const auto chosen = std::find_if(choice.samples.begin(), choice.samples.end(),
                                   [&](const auto& s) { return s.weight == choice.weight; });
  ASSERT_NE(chosen, choice.samples.end());
  EXPECT_NEAR(chosen->residual, residual, 1e-6 * residual);
  // Control points that it holds are none that the data decide on: less than n of the lightest.
  const double n = problem->curve_fit()->basis().num_control_points();
  EXPECT_NEAR(plain.samples.front().trace, n, 0.1);
  EXPECT_NEAR(choice.samples.front().trace, n - 2.0, 0.2);
  const auto md = static_cast<double>(curve.data.points.size());
  const double freedom = 1.0 - chosen->trace / static_cast<double>(curve.data.points.rows());
  EXPECT_NEAR(chosen->score, residual / md / (freedom * freedom), 1e-6 * chosen->score);
}

TEST(FairingChoice, RefusesWhatItCannotJudge) {
  NoisyCurve curve(9);
  const auto why_not = [&](const std::string& terms, ParameterKind kind) {
    FitSpec spec = curve.spec;
    FairingChoice choice;
    std::string error;
    EXPECT_TRUE(terms.empty() || ParseNameSpecList(terms, &spec.terms, &error));
    spec.parameter_kind = kind;
    EXPECT_FALSE(ChooseFairingWeight(curve.data, FairingRule::kGcv, 0.0, &spec, &choice, &error));
    return error;
  };
  EXPECT_EQ(why_not("interpolation/loss=huber/loss_scale=0.1", ParameterKind::kFixed),
            "fairing=gcv cannot judge a loss, which makes the fit no linear one; give a weight");
  EXPECT_EQ(why_not("free_parameter", ParameterKind::kFree),
            "fairing=gcv cannot judge free parameters, which are no linear fit; give a weight");
  EXPECT_EQ(why_not("interpolation,fairing,fairing/derivative=3", ParameterKind::kFixed),
            "fairing=gcv chooses one weight; found 2 fairing terms");
  EXPECT_EQ(
      why_not("", ParameterKind::kProjected),
      "fairing=gcv cannot judge projected parameters, which are no linear fit; give a weight");
  EXPECT_EQ(why_not("interpolation,curve_fairing/weight=0.1", ParameterKind::kFixed),
            "fairing=gcv cannot judge the term curve_fairing/weight=0.1, which is not affine in "
            "the control points; give a weight");
  EXPECT_EQ(why_not("end_point,fairing", ParameterKind::kFixed),
            "fairing=gcv judges the residuals of the term interpolation, which is not among the "
            "terms");
  EXPECT_THAT(why_not("foot_point", ParameterKind::kFixed), HasSubstr("foot_point"));
  curve.spec.guard = NameSpec{"bending", {}, nullptr};
  EXPECT_EQ(why_not("interpolation", ParameterKind::kFixed),
            "fairing=gcv chooses the weight of the only fairing term, and the guard bending is "
            "another; leave the guard out or give a weight");
  curve.spec.guard.reset();
  ASSERT_TRUE(curve.spec.constraints.empty());
  curve.spec.constraints = {Named("curvature/t=0.5/kappa=1")};
  EXPECT_EQ(why_not("interpolation", ParameterKind::kFixed),
            "fairing=gcv cannot judge the constraint curvature/t=0.5/kappa=1, which is not linear; "
            "give a weight");
}

}  // namespace
}  // namespace batten
