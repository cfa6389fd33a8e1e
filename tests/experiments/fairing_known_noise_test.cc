// What the rules that choose a fairing weight judge, against dense algebra; what those that know
// the noise find, and when they refuse.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "experiments/fairing_choice.h"
#include "problems/objective.h"
#include "tests/experiments/noisy_curve.h"

namespace batten {
namespace {

using ::testing::HasSubstr;

constexpr FairingRule kRulesOfTheTrace[] = {FairingRule::kGcv, FairingRule::kRisk,
                                            FairingRule::kDiscrepancy};

/// Dense algebra from the functors' own derivatives: the hat matrix A (A'A + w D'D)^-1 A' of what
/// constraints leave, all coordinates together.
struct DenseHat {
  explicit DenseHat(const NoisyCurve& curve) {
    FitSpec spec = curve.spec;
    std::string error;
    EXPECT_TRUE(ParseNameSpecList("interpolation,fairing", &spec.terms, &error)) << error;
    const auto problem = MakeFitProblem(curve.data, spec, &error);
    EXPECT_NE(problem, nullptr) << error;
    Objective objective(problem.get(), nullptr);
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(objective.num_variables());
    Eigen::VectorXd residuals;
    SparseRows sparse;
    EXPECT_EQ(objective.Jacobian(zero, &residuals, &sparse), Status::kOk);
    const Eigen::MatrixXd jacobian = sparse;
    const Eigen::Index md = curve.data.points.size();
    a = jacobian.topRows(md);
    d = jacobian.bottomRows(jacobian.rows() - md);
    q = -residuals.head(md);
    g = -residuals.tail(d.rows());
    // Rows that constraints or weights leave nothing of are no data.
    num_data = static_cast<double>((a.rowwise().norm().array() > 1e-12).count());
    unit = problem->units().energy;
  }
  /// RSS and trace of all coordinates; false where normal equations have no digits to compare.
  bool At(double weight, double* squared, double* trace) const {
    const Eigen::MatrixXd matrix = a.transpose() * a + weight * d.transpose() * d;
    const Eigen::LDLT<Eigen::MatrixXd> factor(matrix);
    if (factor.rcond() < 1e-9) return false;
    const Eigen::VectorXd y = factor.solve(a.transpose() * q + weight * d.transpose() * g);
    *squared = (a * y - q).squaredNorm() * unit;
    *trace = (factor.solve(a.transpose()) * a).trace();
    return true;
  }
  double Score(FairingRule rule, double noise, double squared, double trace) const {
    const double freedom = 1.0 - trace / num_data;
    const double mean = squared / num_data;
    if (rule == FairingRule::kGcv) return mean / (freedom * freedom);
    if (rule == FairingRule::kRisk) return mean / (noise * noise) + 2.0 * trace / num_data;
    return mean / (noise * noise * freedom);
  }
  Eigen::MatrixXd a, d;
  Eigen::VectorXd q, g;
  double num_data = 0.0;
  double unit = 1.0;
};

void ExpectJudgedByTheHatMatrix(const NoisyCurve& curve, double noise, FairingRule rule) {
  SCOPED_TRACE(ToString(rule));
  FitSpec asked = curve.spec;
  FairingChoice choice;
  std::string error;
  ASSERT_TRUE(ChooseFairingWeight(curve.data, rule, noise, &asked, &choice, &error)) << error;
  const DenseHat hat(curve);
  int compared = 0;
  double least = std::numeric_limits<double>::infinity(), chosen = least;
  for (const FairingSample& sample : choice.samples) {
    double squared = 0.0, trace = 0.0;
    if (!hat.At(sample.weight, &squared, &trace)) continue;
    const double score = hat.Score(rule, noise, squared, trace);
    EXPECT_NEAR(sample.residual, squared, 1e-6 * squared) << sample.weight;
    const auto dimension = static_cast<double>(curve.data.points.cols());
    EXPECT_NEAR(sample.trace, trace / dimension, 1e-6 * trace) << sample.weight;
    EXPECT_NEAR(sample.score, score, 1e-5 * score) << sample.weight;
    least = std::min(least, score);
    if (sample.weight == choice.weight) chosen = score;
    if (rule == FairingRule::kDiscrepancy && sample.weight > choice.weight) {
      EXPECT_GT(score, 1.0 - 1e-6) << sample.weight;
    }
    ++compared;
  }
  EXPECT_GE(compared, 5);
  const double sought = rule == FairingRule::kDiscrepancy ? 1.0 : least;
  EXPECT_NEAR(chosen, sought, 1e-6 * sought);
}

TEST(FairingChoice, JudgesConstraintsOnSingleCoordinatesByTheHatMatrixOfAllOfThem) {
  for (const char* constraints : {"point/t=0.3/x=0.4", "derivative/t=0/order=1/y=2,ends"}) {
    SCOPED_TRACE(constraints);
    NoisyCurve curve(11);
    std::string error;
    ASSERT_TRUE(ParseNameSpecList(constraints, &curve.spec.constraints, &error)) << error;
    // What the constraint pulls off the data is more than their noise.
    for (const FairingRule rule : kRulesOfTheTrace) {
      ExpectJudgedByTheHatMatrix(curve, 2.0 * curve.noise, rule);
    }
  }
}

TEST(FairingChoice, JudgesWeightedPointsInSpaceByTheirHatMatrix) {
  for (const unsigned seed : {10U, 11U}) {
    NoisyCurve curve(seed, 3);
    curve.data.weights = Eigen::VectorXd(curve.data.points.rows());
    for (Eigen::Index i = 0; i < curve.data.weights->size(); ++i) {
      (*curve.data.weights)[i] = i % 9 == 4 ? 0.0 : 1.0 - 0.25 * static_cast<double>(i % 3);
    }
    for (const FairingRule rule : kRulesOfTheTrace) {
      ExpectJudgedByTheHatMatrix(curve, curve.noise, rule);
    }
  }
}

TEST(FairingChoice, ByDiscrepancyLeavesTheKnownNoiseToTheFreedomLeft) {
  NoisyCurve curve(7);
  FairingChoice choice;
  std::string error;
  const double noise = 1.1 * curve.noise;  // by chance this curve's own is somewhat more
  ASSERT_TRUE(ChooseFairingWeight(curve.data, FairingRule::kDiscrepancy, noise, &curve.spec,
                                  &choice, &error))
      << error;
  EXPECT_EQ(FairingChoiceWarning(choice), "");
  const auto problem = MakeFitProblem(curve.data, curve.spec, &error);
  const RunResult run = RunSolver(*problem, "banded_qr");
  const double residual =
      Objective(problem.get(), nullptr).TermEnergies(run.x)[0] * problem->units().energy;
  const double freedom =
      2.0 * (static_cast<double>(curve.data.points.rows()) - choice.chosen.trace);
  const double expected = freedom * noise * noise;
  EXPECT_NEAR(residual, expected, 1e-6 * expected);
}

TEST(FairingChoice, ByDiscrepancyRefusesANoiseThatTheResidualsContradict) {
  NoisyCurve curve(7);
  FairingChoice choice;
  std::string error;
  for (const double noise : {1e-6, 0.5 * curve.noise}) {
    EXPECT_FALSE(ChooseFairingWeight(curve.data, FairingRule::kDiscrepancy, noise, &curve.spec,
                                     &choice, &error));
    EXPECT_THAT(error, HasSubstr("fairing=discrepancy: the squared residuals are at each weight, "
                                 "without fairing too, at least "));
    EXPECT_THAT(error, HasSubstr(" times what the noise makes; give a larger noise"));
  }
  EXPECT_FALSE(ChooseFairingWeight(curve.data, FairingRule::kDiscrepancy, 1e6, &curve.spec, &choice,
                                   &error));
  EXPECT_THAT(error, HasSubstr("the squared residuals of the fairest curve are "));
  EXPECT_THAT(error, HasSubstr("give a smaller noise"));
}

TEST(FairingChoice, ByDiscrepancyTakesTheLeastWhereChanceLeavesNoRoot) {
  int without = 0;
  for (unsigned seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(seed);
    NoisyCurve curve(seed);
    FairingChoice choice;
    std::string error;
    ASSERT_TRUE(ChooseFairingWeight(curve.data, FairingRule::kDiscrepancy, curve.noise, &curve.spec,
                                    &choice, &error))
        << error;
    if (FairingChoiceWarning(choice).empty()) {
      EXPECT_NEAR(choice.chosen.score, 1.0, 1e-6);
      continue;
    }
    ++without;
    EXPECT_THAT(FairingChoiceWarning(choice), HasSubstr("by no more than chance can"));
    EXPECT_GT(choice.chosen.score, 1.0);
    EXPECT_LT(choice.chosen.score, 1.3);
    for (const FairingSample& sample : choice.samples) {
      EXPECT_GE(sample.score, choice.chosen.score);
    }
  }
  EXPECT_EQ(without, 9);
}

TEST(FairingChoice, ByRiskTakesAnEndOfTheScanWhereTheNoiseIsFarOff) {
  const NoisyCurve curve(7);
  for (const double noise : {1e-6, 1e6}) {
    FitSpec spec = curve.spec;
    FairingChoice choice;
    std::string error;
    ASSERT_TRUE(ChooseFairingWeight(curve.data, FairingRule::kRisk, noise, &spec, &choice, &error))
        << error;
    EXPECT_THAT(FairingChoiceWarning(choice),
                HasSubstr(noise < 1.0 ? "the lightest weight" : "the heaviest weight"));
  }
}

}  // namespace
}  // namespace batten
