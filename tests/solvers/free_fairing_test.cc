// curve_fairing, which is not affine, beside free and projected parameters.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/solvers/contract_cases.h"

namespace batten {
namespace {

struct FairCase {
  const char* name;
  int degree;
  bool closed;
  int control_points;
  int dimension;
  bool projected;
  const char* fairing;
};

const FairCase kFairCases[] = {
    {"Bending", 3, true, 12, 2, false, "curve_fairing/weight=1e-3"},
    {"OpenBending", 3, false, 9, 2, false, "curve_fairing/weight=1e-3"},
    {"VariationInSpace", 4, true, 11, 3, false, "curve_fairing/measure=variation/weight=1e-8"},
    {"BesideAnAffineTerm", 3, true, 12, 2, false, "fairing/weight=1e-4,curve_fairing/weight=1e-4"},
    {"OfFewControlPoints", 3, true, 5, 2, false, "curve_fairing/weight=1e-3"},
    {"Projected", 3, true, 12, 2, true, "curve_fairing/weight=1e-3"},
};

std::unique_ptr<Problem> MakeCase(const FairCase& c) {
  const std::string terms =
      (c.projected ? "foot_point," : "free_parameter,") + std::string(c.fairing);
  const char* start = c.closed ? "ellipse" : "data";
  return MakeFit(MakeNoisyBean(60, c.dimension, 831),
                 c.projected ? MakeProjectedSpec(c.degree, c.closed, c.control_points, start, terms)
                             : MakeFreeSpec(c.degree, c.closed, c.control_points, start, terms));
}

class FreeFairing : public ::testing::TestWithParam<FairCase> {};
INSTANTIATE_TEST_SUITE_P(Fits, FreeFairing, ::testing::ValuesIn(kFairCases),
                         [](const auto& c) { return c.param.name; });

TEST_P(FreeFairing, LeadsAllWhoTakeItToTheMinimumOfLbfgs) {
  for (const char* solver : {"newton", "lm_schur", "foot_newton"}) {
    const auto problem = MakeCase(GetParam());
    const std::string why = WhyUnsupported(*problem, solver);
    if (GetParam().projected && std::string(solver) == "foot_newton") {
      EXPECT_THAT(why, ::testing::HasSubstr("projected"));
      continue;
    }
    SCOPED_TRACE(solver);
    ASSERT_EQ(why, "");
    SolverTrial trial(*problem, solver, {5000});
    // Gauss and Newton's steps are linear: E may be told by rounding alone before |g| is as small
    // as is asked for.
    const bool is_at_rounding =
        std::string(solver) == "lm_schur" && trial.outcome.reason == StopReason::kLineSearchEnded;
    ASSERT_TRUE(IsSuccess(trial.outcome.reason) || is_at_rounding)
        << ToString(trial.outcome.reason) << ": " << trial.outcome.message;
    // Its end, moved by up to 1e-3: the same basin, looked for from the functors alone.
    Objective objective(problem.get(), nullptr);
    Eigen::VectorXd x = trial.x;
    std::mt19937 random(20240919);
    for (double& coordinate : x) coordinate += RandomBetween(-1e-3, 1e-3, &random);
    problem->SetStart(objective.Expand(x));
    SolverTrial lbfgs(*problem, "lbfgs", {20000});
    const double energy = lbfgs.context.Energy(lbfgs.x);
    // E is flat at a minimum: of a gradient small by 1e-10 the square counts.
    EXPECT_NEAR(trial.context.Energy(trial.x), energy, 1e-9 * energy);
  }
}

/// Of methods that step by a model for given feet and then search these.
TEST_P(FreeFairing, LeadsMethodsWithFeetDownToNearAMinimum) {
  for (const char* solver : {"pdm", "tdm", "sdm", "gi", "anderson:pdm"}) {
    SCOPED_TRACE(solver);
    const auto problem = MakeCase(GetParam());
    ASSERT_EQ(WhyUnsupported(*problem, solver), "");
    SolverTrial trial(*problem, solver, {1000, 1e-6});
    EXPECT_NE(trial.outcome.reason, StopReason::kNumericalFailure) << trial.outcome.message;
    Objective objective(problem.get(), nullptr);
    double before = std::numeric_limits<double>::infinity();
    for (const Eigen::VectorXd& x : trial.context.iterates()) {
      const double energy = trial.context.Energy(x);
      ASSERT_LE(energy, before + Objective::EnergyRoundingFloor(energy, objective.ResidualSize(x)));
      before = energy;
    }
    // The minimum behind its end, by derivatives from the functors alone; the others crawl.
    problem->SetStart(trial.all);
    SolverTrial lbfgs(*problem, "lbfgs", {20000});
    const bool is_fast = std::string(solver) == "tdm" || std::string(solver) == "sdm";
    EXPECT_NEAR(before, lbfgs.context.Energy(lbfgs.x), (is_fast ? 1e-3 : 0.2) * before);
  }
}

TEST_P(FreeFairing, OfNewtonEndsQuadratically) {
  const auto problem = MakeCase(GetParam());
  SolverTrial trial(*problem, "newton", {200, -1.0, true});
  EXPECT_TRUE(IsSuccess(trial.outcome.reason))
      << ToString(trial.outcome.reason) << ": " << trial.outcome.message;
  const double floor = Objective(problem.get(), nullptr).GradientRoundingFloor(trial.x);
  std::vector<double> above;
  for (const double norm : trial.context.gradient_norms()) {
    if (norm > 10.0 * floor) above.push_back(norm);
  }
  ASSERT_GE(above.size(), 2U);
  // Damping falls to a third at most per step, and bounds the last ratio: without second
  // derivatives of the fairing the rate stays what it was, far above.
  EXPECT_LT(above.back(), 0.02 * above[above.size() - 2]);
}

TEST(FreeFairing, CountsItsProducts) {
  const auto problem = MakeCase(kFairCases[0]);
  const SolverTrial newton(*problem, "newton", {3});
  // 12 control points of a closed cubic: one run, 12 colours of two coordinates for each sum.
  EXPECT_EQ(newton.context.count(Evaluation::kProduct) % 24, 0);
  EXPECT_GE(newton.context.count(Evaluation::kProduct), 4 * 24);
  const SolverTrial lm(*problem, "lm_schur", {3});
  EXPECT_EQ(lm.context.count(Evaluation::kProduct), 0);
}

TEST(FreeFairing, HoldsLinearConstraints) {
  const auto problem = MakeCase(kFairCases[2]);
  LinearConstraint held = HoldCurve(*problem, 0.4, 0, 0.0);
  const auto place = [&held](const Eigen::VectorXd& all) {
    double sum = 0.0;
    for (const auto& [index, factor] : held.coefficients) sum += factor * all[index];
    return sum;
  };
  // A little off where the curve would run without it.
  const SolverTrial without(*problem, "newton", {500});
  held.value = place(without.all) + 0.01;
  SetConstraints({held}, problem.get());
  problem->SetStart(
      problem->elimination().Expand(problem->elimination().FreeVariables(without.all)));
  SolverTrial newton(*problem, "newton", {500});
  SolverTrial lm(*problem, "lm_schur", {5000});
  for (const SolverTrial* trial : {&newton, &lm}) {
    EXPECT_TRUE(IsSuccess(trial->outcome.reason)) << ToString(trial->outcome.reason);
    EXPECT_NEAR(place(trial->all), held.value, 1e-12);
  }
  const double energy = newton.context.Energy(newton.x);
  EXPECT_NEAR(lm.context.Energy(lm.x), energy, 1e-9 * energy);
}

TEST(FreeFairing, IsRefusedByVarproWhichSolvesForTheControlPoints) {
  const std::string why = WhyUnsupported(*MakeCase(kFairCases[0]), "varpro");
  ExpectOneSentenceWithAWayOut(why, "varpro");
  EXPECT_THAT(why, ::testing::HasSubstr("must be affine"));
}

}  // namespace
}  // namespace batten
