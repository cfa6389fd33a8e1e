#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "splines/closest_point.h"
#include "tests/solvers/contract_cases.h"
#include "tests/solvers/thrown_points.h"

namespace batten {
namespace {

using ::testing::HasSubstr;

TEST(Irls, ReachesTheMinimumThatGradientMethodsFind) {
  const ThrownPoints thrown(11, true);
  for (const char* loss : {"huber", "cauchy", "tukey", "soft_l1"}) {
    const auto problem = thrown.Fit("interpolation/loss=" + std::string(loss) +
                                    "/loss_scale=0.02,fairing/weight=1e-6");
    const SolverTrial ours(*problem, "irls:banded_qr", {2000, 1e-9, true});
    EXPECT_TRUE(IsSuccess(ours.outcome.reason)) << loss << ToString(ours.outcome.reason);
    const SolverTrial lbfgs(*problem, "lbfgs", {2000, 1e-9, true});
    EXPECT_LE((ours.x - lbfgs.x).cwiseAbs().maxCoeff(), 1e-6) << loss;
    const SolverTrial cholesky(*problem, "irls:banded_cholesky", {2000, 1e-9, true});
    EXPECT_LE((ours.x - cholesky.x).cwiseAbs().maxCoeff(), 1e-6) << loss;
  }
}

TEST(Irls, NeverRaisesTheEnergy) {
  const auto problem = ThrownPoints(12, true).Fit("interpolation/loss=tukey/loss_scale=0.05");
  const SolverTrial trial(*problem, "irls:banded_qr", {100, 1e-9, true});
  Objective objective(problem.get(), nullptr);
  double before = std::numeric_limits<double>::infinity();
  for (const Eigen::VectorXd& x : trial.context.iterates()) {
    double energy = 0.0;
    ASSERT_EQ(objective.Energy(x, &energy), Status::kOk);
    EXPECT_LE(energy, before * (1.0 + 1e-13));
    before = energy;
  }
}

TEST(Irls, OfATermWithoutLossIsItsBase) {
  const auto problem = ThrownPoints(13, false).Fit("interpolation");
  const SolverTrial ours(*problem, "irls:banded_qr");
  const SolverTrial direct(*problem, "banded_qr");
  EXPECT_LE((ours.x - direct.x).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(Irls, SaysWhichBasesItTakes) {
  const auto problem = ThrownPoints(13, false).Fit("interpolation");
  EXPECT_THAT(WhyUnsupported(*problem, "irls:lspia"),
              HasSubstr("irls solves by a direct method, and lspia is none; use a base such as"));
}

TEST(RobustFits, AreHardlyWorseThanCleanOnesWhenATenthOfThePointsIsThrownAway) {
  for (const char* loss : {"cauchy", "tukey"}) {
    for (const char* solver : {"irls:banded_qr", "lbfgs", "ceres_lm", "ceres_lbfgs"}) {
      std::vector<double> ratios;
      for (unsigned seed = 100; seed < 150; ++seed) {
        const ThrownPoints clean(seed, false), thrown(seed, true);
        const auto plain = clean.Fit("interpolation");
        const double reference = clean.Error(*plain, SolverTrial(*plain, "banded_qr").x);
        const auto robust =
            thrown.Fit("interpolation/loss=" + std::string(loss) + "/loss_scale=mad");
        const SolverTrial trial(*robust, solver, {500, 1e-6, true});
        ratios.push_back(thrown.Error(*robust, trial.x) / reference);
      }
      EXPECT_LE(Median(ratios), 1.15) << solver << " " << loss;
      RecordProperty(std::string("worst ") + solver + " " + loss,
                     NumberText(*std::max_element(ratios.begin(), ratios.end())));
    }
  }
}

TEST(RobustStart, FreezesTheEstimatedScaleNearTheNoise) {
  const ThrownPoints thrown(14, true);
  const auto problem = thrown.Fit("interpolation/loss=huber/loss_scale=mad");
  const NameSpec& term = problem->curve_fit()->spec().terms.front();
  double scale = 0.0;
  ASSERT_TRUE(ParseNumber(term.options.back().second, &scale)) << term.ToString();
  const double sigma = scale * problem->curve_fit()->size() / 1.345;
  // A tenth of outliers moves the median from the 50th to the 56th percentile, 20 control points
  // take a tenth of the freedom.
  EXPECT_NEAR(sigma, 0.01, 0.002);
}

TEST(RobustStart, FreezesTheEstimatedScaleOfMovingParametersNearTheNoise) {
  for (const bool is_free : {true, false}) {
    const ThrownPoints thrown(14, true);
    const auto problem = thrown.Fit(
        std::string(is_free ? "free_parameter" : "foot_point") + "/loss=huber/loss_scale=mad",
        is_free ? ParameterKind::kFree : ParameterKind::kProjected);
    const NameSpec& term = problem->curve_fit()->spec().terms.front();
    double scale = 0.0;
    ASSERT_TRUE(ParseNumber(term.options.back().second, &scale)) << term.ToString();
    const double sigma = scale * problem->curve_fit()->size() / 1.345;
    // 20 control points of two coordinates take a fifth of what is across the curve; a tenth of
    // outliers adds about as much.
    EXPECT_NEAR(sigma, 0.01, 0.002);
  }
}

std::vector<NameSpec> GuardedTerms(const std::string& term, ParameterKind kind,
                                   const std::optional<NameSpec>& guard = std::nullopt) {
  FitSpec spec = MakeSpec(3, true, 20, term);
  spec.parameter_kind = kind;
  spec.guard = guard;
  return MakeFit(ThrownPoints(14, true).data, spec)->curve_fit()->spec().terms;
}

TEST(RobustStart, GuardsMovingParametersByTheVarianceOfTheNoise) {
  for (const ParameterKind kind : {ParameterKind::kFree, ParameterKind::kProjected}) {
    const std::string name = DistanceTermOf(kind);
    const auto terms = GuardedTerms(name + "/weight=3/loss=huber/loss_scale=mad", kind);
    ASSERT_EQ(terms.size(), 2U);
    double scale = 0.0, weight = 0.0;
    ASSERT_TRUE(ParseNumber(terms[0].options.back().second, &scale));
    ASSERT_TRUE(ParseNumber(terms[1].options.back().second, &weight));
    EXPECT_THAT(terms[1].ToString(), HasSubstr("fairing/derivative=1/weight="));
    const double sigma = scale / 1.345;
    EXPECT_NEAR(weight, 3 * 200 * sigma * sigma, 1e-9 * weight);
    // A guard or fairing that is asked for, none too, stays what it is.
    const std::string estimated = name + "/loss=cauchy/loss_scale=mad";
    EXPECT_EQ(GuardedTerms(estimated, kind, NameSpec{"none", {}, nullptr}).size(), 1U);
    EXPECT_THAT(GuardedTerms(estimated, kind, NameSpec{"bending", {}, nullptr}).at(1).ToString(),
                HasSubstr("derivative=2"));
    EXPECT_EQ(GuardedTerms(estimated + ",fairing/weight=1e-9", kind).size(), 2U);
    EXPECT_EQ(GuardedTerms(name + "/loss=cauchy/loss_scale=0.01", kind).size(), 1U);
  }
  EXPECT_EQ(GuardedTerms("interpolation/loss=cauchy/loss_scale=mad", ParameterKind::kFixed).size(),
            1U);
}

TEST(RobustStart, OfMovingParametersLiesAtFeetNearTheTruth) {
  const ThrownPoints thrown(16, true);
  const auto problem = thrown.Fit("free_parameter/loss=tukey/loss_scale=mad", ParameterKind::kFree);
  const CurveFit& fit = *problem->curve_fit();
  const BsplineCurve curve = fit.Curve(problem->start());
  Eigen::VectorXd t = fit.Parameters(problem->start());
  const Points at_start = curve.Sample(t);
  ClosestPoint(curve).FindAll(thrown.data.points, 1, &t, nullptr);
  EXPECT_LT((curve.Sample(t) - at_start).cwiseAbs().maxCoeff(), 1e-10);
  Eigen::VectorXd squared;
  ClosestPoint(curve).FindAll(thrown.truth, 1, &t, &squared);
  // Least squares is drawn away from the truth by the thrown points, to some 0.06.
  EXPECT_LT(std::sqrt(squared.mean()), 0.01);
}

TEST(RobustStart, OfLossesThatAreNotConvexIsHubersAnswer) {
  const ThrownPoints thrown(15, true);
  // Scales whose ratio is that of the tuning constants.
  const auto tukey = thrown.Fit("interpolation/loss=tukey/loss_scale=0.04685");
  const auto huber = thrown.Fit("interpolation/loss=huber/loss_scale=0.01345");
  const SolverTrial answer(*huber, "irls:banded_qr", {2000, 1e-9, true});
  EXPECT_LE((tukey->start() - answer.all).cwiseAbs().maxCoeff(), 1e-4);
  EXPECT_GT((huber->start() - answer.all).cwiseAbs().maxCoeff(), 1e-2) << "its own start stays";
}

double ScaleOf(const Problem& problem, std::size_t term) {
  double scale = 0.0;
  EXPECT_TRUE(
      ParseNumber(problem.curve_fit()->spec().terms.at(term).options.back().second, &scale));
  return scale;
}

TEST(RobustStart, HasFairingInsteadOfCurveFairing) {
  const ThrownPoints thrown(15, true);
  const std::string term = "interpolation/loss=tukey/loss_scale=mad";
  const auto plain = thrown.Fit(term);
  for (const char* measure : {"bending/weight=1e-7", "variation/weight=1e-10"}) {
    const auto fair = thrown.Fit(term + ",curve_fairing/measure=" + measure);
    // Light fairing hardly changes a fit of few control points.
    EXPECT_NEAR(ScaleOf(*fair, 0), ScaleOf(*plain, 0), 0.05 * ScaleOf(*plain, 0)) << measure;
    EXPECT_GT((fair->start() - plain->start()).norm(), 1e-9) << measure;
    // The start is near the minimum of its own E.
    const SolverTrial end(*fair, "lbfgs", {2000, 1e-6, true});
    EXPECT_LT((end.all - fair->start()).cwiseAbs().maxCoeff(), 0.02) << measure;
  }
  const auto free = thrown.Fit("free_parameter/loss=huber/loss_scale=mad,curve_fairing/weight=1e-7",
                               ParameterKind::kFree);
  EXPECT_EQ(free->terms().size(), 3U) << "curve_fairing is no guard";
}

TEST(RobustStart, EstimatesNoiseWhereCurveFairingAloneKeepsFromIt) {
  // As many control points as points would meet them all.
  const ThrownPoints thrown(15, true);
  FitSpec spec =
      MakeSpec(3, true, static_cast<int>(thrown.data.points.rows()),
               "interpolation/loss=huber/loss_scale=mad,curve_fairing/weight=1e-4/loss=huber/"
               "loss_scale=mad");
  spec.parameters = Parameterization::kUniform;
  const auto problem = MakeFit(thrown.data, spec);
  const double sigma = ScaleOf(*problem, 0) * problem->curve_fit()->size() / 1.345;
  EXPECT_NEAR(sigma, 0.01, 0.003);
  EXPECT_GT(ScaleOf(*problem, 1), 0.0);
}

TEST(RobustStart, SaysWhatItCannotEstimate) {
  std::string error;
  FitSpec spec = MakeSpec(3, true, 200, "interpolation/loss=huber/loss_scale=mad");
  EXPECT_EQ(MakeFitProblem(ThrownPoints(1, true).data, spec, &error), nullptr);
  EXPECT_THAT(error, HasSubstr("too small for a scale; give a number instead of mad"));
}

}  // namespace
}  // namespace batten
