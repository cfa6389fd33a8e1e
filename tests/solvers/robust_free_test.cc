// Losses where parameters are free or projected.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "tests/solvers/contract_cases.h"
#include "tests/solvers/thrown_points.h"

namespace batten {
namespace {

constexpr const char* kLosses[] = {"huber", "cauchy", "tukey", "soft_l1"};
constexpr const char* kSolvers[] = {"newton", "foot_newton", "lm_schur", "varpro",      "pdm",
                                    "tdm",    "sdm",         "gi",       "anderson:pdm"};

/// Where the methods end to rounding within some hundred iterations; others near it.
bool IsFast(const std::string& solver) {
  return solver == "newton" || solver == "foot_newton" || solver == "lm_schur";
}

std::string RobustTerm(bool is_free, const std::string& loss, const std::string& scale) {
  return (is_free ? "free_parameter/loss=" : "foot_point/loss=") + loss + "/loss_scale=" + scale;
}

ParameterKind KindOf(bool is_free) {
  return is_free ? ParameterKind::kFree : ParameterKind::kProjected;
}

/// From near the truth, with few control points and all residuals of about the losses' scales (but
/// for thrown points), so that all find one basin.
std::unique_ptr<Problem> MakeRobust(unsigned seed, bool is_free, const std::string& loss,
                                    bool with_thrown_points = true) {
  constexpr int kControlPoints = 10;
  const ThrownPoints points(seed, with_thrown_points);
  const auto fit = [&](const std::string& name, const std::string& scale) {
    return points.Fit(RobustTerm(is_free, name, scale), KindOf(is_free), kControlPoints);
  };
  const auto tukey = fit("tukey", "0.02");
  auto problem = fit(loss, loss == "tukey" ? "0.02" : "0.004");
  problem->SetStart(tukey->start());
  return problem;
}

class RobustFreeFits : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Kinds, RobustFreeFits, ::testing::Bool(),
                         [](const auto& is_free) { return is_free.param ? "Free" : "Projected"; });

/// E of a minimum that newton finds from x, by the functors' own gradient.
double PolishedEnergy(Problem* problem, const Eigen::VectorXd& x) {
  const Eigen::VectorXd start = problem->start();
  problem->SetStart(x);
  SolverTrial trial(*problem, "newton", {300, -1.0, true});
  problem->SetStart(start);
  EXPECT_TRUE(IsSuccess(trial.outcome.reason)) << ToString(trial.outcome.reason);
  return trial.context.Energy(trial.x);
}

TEST_P(RobustFreeFits, EndInTheMinimumOfLbfgs) {
  for (const char* loss : kLosses) {
    SCOPED_TRACE(loss);
    const auto problem = MakeRobust(21, GetParam(), loss, false);
    SolverTrial lbfgs(*problem, "lbfgs", {400, 1e-9});
    const double least = PolishedEnergy(problem.get(), lbfgs.all);
    // That is the minimum next to where lbfgs is, not another one.
    ASSERT_NEAR(lbfgs.context.Energy(lbfgs.x), least, 0.01 * least);
    for (const char* solver : kSolvers) {
      if (!WhyUnsupported(*problem, solver).empty()) continue;
      SCOPED_TRACE(solver);
      SolverTrial trial(*problem, solver, {500, 1e-9});
      const double energy = trial.context.Energy(trial.x);
      EXPECT_TRUE(IsSuccess(trial.outcome.reason) || !IsFast(solver))
          << ToString(trial.outcome.reason);
      // E is flat at a minimum: of a gradient small by 1e-9 the square counts.
      EXPECT_NEAR(energy, least, (IsSuccess(trial.outcome.reason) ? 1e-9 : 0.05) * least);
      EXPECT_NEAR(PolishedEnergy(problem.get(), trial.all), least, 1e-9 * least);
    }
  }
}

TEST_P(RobustFreeFits, NeverRaiseTheEnergy) {
  for (const char* loss : kLosses) {
    const auto problem = MakeRobust(22, GetParam(), loss);
    for (const char* solver : kSolvers) {
      if (!WhyUnsupported(*problem, solver).empty()) continue;
      SCOPED_TRACE(std::string(solver) + " " + loss);
      SolverTrial trial(*problem, solver, {60, 1e-9});
      Objective objective(problem.get(), nullptr);
      double before = std::numeric_limits<double>::infinity();
      for (const Eigen::VectorXd& x : trial.context.iterates()) {
        const double energy = trial.context.Energy(x);
        const double noise = Objective::EnergyRoundingFloor(energy, objective.ResidualSize(x));
        ASSERT_LE(energy, before + noise);
        before = energy;
      }
      EXPECT_LT(before, trial.context.Energy(objective.start()));
    }
  }
}

TEST_P(RobustFreeFits, OfNewtonEndQuadratically) {
  for (const char* loss : {"cauchy", "tukey", "soft_l1"}) {
    const auto problem = MakeRobust(23, GetParam(), loss, false);
    SolverTrial trial(*problem, "newton", {200, -1.0, true});
    EXPECT_TRUE(IsSuccess(trial.outcome.reason)) << loss << " " << ToString(trial.outcome.reason);
    const double floor = Objective(problem.get(), nullptr).GradientRoundingFloor(trial.x);
    std::vector<double> above;
    for (const double norm : trial.context.gradient_norms()) {
      if (norm > 10.0 * floor) above.push_back(norm);
    }
    ASSERT_GE(above.size(), 2U);
    // Without rho'' weights settle linearly, at a rate near 1/2.
    EXPECT_LT(above.back(), 0.02 * above[above.size() - 2]) << loss;
  }
}

/// Ends that a user gets. Methods that settle linearly have fewer iterations, as each looks for all
/// feet: benchmarks/robust_fits.py has more of them.
Eigen::VectorXd EndOf(const Problem& problem, const std::string& solver) {
  const std::set<std::string> linear = {"pdm", "tdm", "sdm", "gi", "anderson:pdm"};
  return SolverTrial(problem, solver, {linear.count(solver) > 0 ? 50 : 1000, 1e-3, true}).all;
}

std::vector<std::string> SolversOfThrownPoints(bool is_free) {
  std::vector<std::string> solvers = {"newton", "lm_schur",    "anderson:pdm",
                                      "lbfgs",  "ceres_lbfgs", "ceres_lm"};
  // Of these the first four do the same with projected parameters.
  const std::vector<std::string> of_free = {
      "pdm", "tdm", "sdm", "gi", "foot_newton", "varpro", "best_of:foot_newton"};
  if (is_free) solvers.insert(solvers.end(), of_free.begin(), of_free.end());
  return solvers;
}

TEST_P(RobustFreeFits, AreHardlyWorseThanCleanOnesWhenATenthOfThePointsIsThrownAway) {
  std::map<std::string, std::vector<double>> ratios;
  for (unsigned seed = 100; seed < 150; ++seed) {
    const ThrownPoints clean(seed, false), thrown(seed, true);
    const auto fit = [&](const char* loss) {
      return thrown.Fit(RobustTerm(GetParam(), loss, "mad"), KindOf(GetParam()));
    };
    const auto cauchy = fit("cauchy"), tukey = fit("tukey");
    // Under the same guard, which goes with the estimated noise.
    const std::string guard = cauchy->curve_fit()->spec().terms.back().ToString();
    const auto plain =
        clean.Fit((GetParam() ? "free_parameter," : "foot_point,") + guard, KindOf(GetParam()));
    for (const std::string& solver : SolversOfThrownPoints(GetParam())) {
      const double reference = clean.ErrorAtFeet(*plain, EndOf(*plain, solver));
      for (const Problem* robust : {cauchy.get(), tukey.get()}) {
        ratios[solver + (robust == tukey.get() ? " tukey" : " cauchy")].push_back(
            thrown.ErrorAtFeet(*robust, EndOf(*robust, solver)) / reference);
      }
    }
  }
  for (const auto& [name, of_seeds] : ratios) {
    EXPECT_LE(Median(of_seeds), 1.15) << name;
    RecordProperty("worst " + name,
                   NumberText(*std::max_element(of_seeds.begin(), of_seeds.end())));
  }
}

TEST(RobustFreeFits, TakeLossesOnOtherTermsToo) {
  const ThrownPoints thrown(24, true);
  for (const char* solver : {"newton", "foot_newton", "lm_schur", "pdm", "tdm", "sdm", "gi"}) {
    SCOPED_TRACE(solver);
    const auto problem = thrown.Fit(
        "free_parameter/loss=huber/loss_scale=0.02,fairing/weight=1e-4/loss=cauchy/loss_scale=0.5",
        ParameterKind::kFree);
    SolverTrial trial(*problem, solver, {300, 1e-9});
    EXPECT_LT(trial.context.Energy(trial.x), trial.context.Energy(StartOf(*problem)));
    problem->SetStart(trial.all);
    SolverTrial lbfgs(*problem, "lbfgs", {20000, 1e-7});
    EXPECT_GE(lbfgs.context.Energy(lbfgs.x), (IsSuccess(trial.outcome.reason) ? 1.0 - 1e-9 : 0.98) *
                                                 trial.context.Energy(trial.x));
  }
}

TEST(RobustFreeFits, OfVarproRefuseLossesOnOtherTerms) {
  const auto problem =
      ThrownPoints(25, true).Fit("free_parameter,fairing/loss=cauchy", ParameterKind::kFree);
  const std::string why = WhyUnsupported(*problem, "varpro");
  ExpectOneSentenceWithAWayOut(why, "varpro");
  EXPECT_THAT(why, ::testing::HasSubstr("must be affine and without loss"));
}

}  // namespace
}  // namespace batten
