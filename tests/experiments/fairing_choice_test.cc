#include "experiments/fairing_choice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "problems/curve_view.h"
#include "splines/brent_minimum.h"
#include "splines/normal_band.h"
#include "tests/experiments/noisy_curve.h"
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

/// Errors over the least one, in order, of the weights that the rule chooses for 100 curves from
/// `share` of their true noise.
std::vector<double> Ratios(FairingRule rule, double share) {
  static const std::vector<double>* const least_errors = [] {
    auto* const errors = new std::vector<double>;
    for (unsigned seed = 1; seed <= 100; ++seed) errors->push_back(LeastError(NoisyCurve(seed)));
    return errors;
  }();
  std::vector<double> ratios;
  for (unsigned seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(testing::Message() << ToString(rule) << " seed " << seed);
    const NoisyCurve curve(seed);
    FairingChoice choice;
    FitSpec spec = curve.spec;
    std::string error;
    EXPECT_TRUE(ChooseFairingWeight(curve.data, rule, share * curve.noise, &spec, &choice, &error))
        << error;
    ratios.push_back(curve.Error(choice.weight) / (*least_errors)[seed - 1]);
    // Of the rules that look for a least score; others go on to a root or a corner.
    const bool is_short = rule == FairingRule::kGcv || rule == FairingRule::kRisk;
    EXPECT_LE(choice.samples.size(), is_short ? 30U : 80U);
  }
  std::sort(ratios.begin(), ratios.end());
  return ratios;
}

void ExpectAtMost(const std::vector<double>& ratios, const std::string& name, double median,
                  double nine_of_ten) {
  testing::Test::RecordProperty(name + "_median", NumberText(ratios[50]));
  testing::Test::RecordProperty(name + "_nine_of_ten", NumberText(ratios[89]));
  testing::Test::RecordProperty(name + "_worst", NumberText(ratios.back()));
  EXPECT_GE(ratios.front(), 1.0 - 1e-6) << name;
  EXPECT_LE(ratios[50], median) << name;
  EXPECT_LE(ratios[89], nine_of_ten) << name;
}

/// docs/fairing_weight.md has these numbers; --gtest_output=xml:FILE shows them.
TEST(FairingChoice, IsNearTheBestPossibleWeight) {
  ExpectAtMost(Ratios(FairingRule::kGcv, 1.0), "gcv", 1.1, 1.3);
  ExpectAtMost(Ratios(FairingRule::kRisk, 1.0), "risk", 1.1, 1.3);
  ExpectAtMost(Ratios(FairingRule::kLCurve, 1.0), "lcurve", 1.1, 1.3);
  ExpectAtMost(Ratios(FairingRule::kDiscrepancy, 1.0), "discrepancy", 1.2, 1.75);
}

/// Too much noise costs little; with too little the curve follows it.
TEST(FairingChoice, ByRiskBearsTooMuchNoiseBetterThanTooLittle) {
  ExpectAtMost(Ratios(FairingRule::kRisk, 1.25), "risk_high", 1.1, 1.3);
  ExpectAtMost(Ratios(FairingRule::kRisk, 0.8), "risk_low", 1.2, 1.75);
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

// The curve belongs to the ratio of the weights; noise is that of the points, whatever they count.
TEST(FairingChoice, TakesNoiseInTheUnitOfTheDataWhateverTheDataWeigh) {
  for (const FairingRule rule :
       {FairingRule::kGcv, FairingRule::kRisk, FairingRule::kDiscrepancy}) {
    SCOPED_TRACE(ToString(rule));
    const NoisyCurve curve(14);
    FairingChoice plain, heavy;
    std::string error;
    FitSpec spec = curve.spec;
    ASSERT_TRUE(ChooseFairingWeight(curve.data, rule, curve.noise, &spec, &plain, &error)) << error;
    spec = curve.spec;
    ASSERT_TRUE(ParseNameSpecList("interpolation/weight=100,fairing", &spec.terms, &error));
    ASSERT_TRUE(ChooseFairingWeight(curve.data, rule, curve.noise, &spec, &heavy, &error)) << error;
    EXPECT_NEAR(heavy.weight, 100.0 * plain.weight, 0.01 * heavy.weight);
    EXPECT_NEAR(heavy.noise, plain.noise, 1e-3 * plain.noise);
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
  curve.spec.guard = NameSpec{"none", {}, nullptr};  // is no guard
  ASSERT_TRUE(curve.spec.constraints.empty());
  curve.spec.constraints = {Named("curvature/t=0.5/kappa=1")};
  EXPECT_EQ(why_not("interpolation", ParameterKind::kFixed),
            "fairing=gcv cannot judge the constraint curvature/t=0.5/kappa=1, which is not linear; "
            "give a weight");
}

}  // namespace
}  // namespace batten
