#include "solvers/ceres_lbfgs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "problems/test_functions.h"
#include "solvers/banded_qr.h"
#include "tests/roundoff.h"
#include "tests/solvers/contract_cases.h"
#include "tests/solvers/test_fits.h"
#include "tests/solvers/trial.h"

namespace batten {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

using LbfgsTrial = Trial<CeresLbfgsSolver>;

const char* const kForms[] = {"objective", "problem", "spans"};

std::string WithForm(const std::string& form) { return "ceres_lbfgs/form=" + form; }

bool SamePoints(const TestContext& a, const TestContext& b) {
  const auto same = [](const TestContext::Evaluated& first, const TestContext::Evaluated& second) {
    return first.kind == second.kind && SameBits(first.x, second.x);
  };
  return std::equal(a.evaluations().begin(), a.evaluations().end(), b.evaluations().begin(),
                    b.evaluations().end(), same);
}

struct FormsCase {
  std::string name;
  std::unique_ptr<Problem> (*make)();
};

const FormsCase kFormsCases[] = {
    {"ClosedOutline", [] { return Rhino(); }},
    {"ClosedOutlineOfManyPoints",
     [] { return MakeFileFit("animals/cat_2000.csv", MakeSpec(3, true, 100)); }},
    {"OpenAirfoil",
     [] { return MakeFileFit("airfoils/naca2412_open.csv", MakeSpec(3, false, 30)); }},
    {"OpenProteinInSpace",
     [] { return MakeFileFit("curves3d/protein_3aid_a_ca_open.csv", MakeSpec(3, false, 50)); }},
    {"OpenHikeInSpace",
     [] { return MakeFileFit("curves3d/gps_hike_xyz_open.csv", MakeSpec(3, false, 100)); }},
    {"ClosedLoopInSpaceWithDataWeights",
     [] { return MakeFit(MakeNoisyLoop(120, 3, 1), MakeSpec(3, true, 17)); }},
    {"ClosedLoopInFourDimensions",
     [] { return MakeFit(MakeNoisyLoop(120, 4, 2), MakeSpec(3, true, 17)); }},
    {"OpenLineOfNumbers", [] { return MakeFit(MakeNoisyLoop(120, 1, 3), MakeSpec(3, false, 21)); }},
    {"ParabolasWithCompiledSizes",
     [] { return MakeFit(MakeNoisyLoop(90, 2, 4), MakeSpec(2, true, 25)); }},
    {"QuinticsWithCompiledSizes",
     [] { return MakeFit(MakeNoisyLoop(90, 2, 5), MakeSpec(5, false, 25)); }},
    {"QuarticsWithRunTimeSizes",
     [] { return MakeFit(MakeNoisyLoop(90, 3, 6), MakeSpec(4, true, 25)); }},
    {"WeightedTerm",
     [] {
       return MakeFit(MakeNoisyLoop(90, 2, 7), MakeSpec(3, true, 25, "interpolation/weight=0.3"));
     }},
    {"RobustTerm",
     [] {
       return MakeFit(MakeNoisyLoop(90, 3, 8),
                      MakeSpec(3, false, 20, "interpolation/loss=cauchy/loss_scale=0.01"));
     }},
    {"TwoTermsOneOfThemCutOff",
     [] {
       return MakeFit(MakeNoisyLoop(90, 2, 9),
                      MakeSpec(3, true, 20,
                               "interpolation/weight=0.1,"
                               "interpolation/weight=3/loss=tukey/loss_scale=0.02"));
     }},
};

class CeresLbfgsForms : public ::testing::TestWithParam<FormsCase> {};

TEST_P(CeresLbfgsForms, ObjectiveAndCeresProblemVisitTheSamePointsBitForBit) {
  const auto problem = GetParam().make();
  Objective::Options uncompiled;
  uncompiled.compile = false;
  const LbfgsTrial objective(*problem, WithForm("objective"), {}, uncompiled);
  const LbfgsTrial native(*problem, WithForm("problem"), {}, uncompiled);
  ASSERT_GT(objective.context.iterates().size(), 10U);
  EXPECT_TRUE(SamePoints(objective.context, native.context));
  EXPECT_EQ(objective.context.iterates().size(), native.context.iterates().size());
  EXPECT_TRUE(SameBits(objective.x, native.x));
  EXPECT_EQ(objective.outcome.reason, native.outcome.reason);
  EXPECT_EQ(objective.outcome.message, native.outcome.message);
}

TEST(CeresLbfgs, BothFormsVisitTheSamePointsOfEveryTestFunction) {
  for (const TestFunction& function : TestFunctions()) {
    const auto problem = MakeTestProblem(function.name);
    const LbfgsTrial objective(*problem, WithForm("objective"));
    const LbfgsTrial native(*problem, WithForm("problem"));
    EXPECT_TRUE(SamePoints(objective.context, native.context)) << function.name;
    EXPECT_TRUE(SameBits(objective.x, native.x)) << function.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Problems, CeresLbfgsForms, ::testing::ValuesIn(kFormsCases),
                         [](const auto& row) { return row.param.name; });

TEST(CeresLbfgs, EveryFormComesAsNearToTheDirectAnswerAsItsLineSearchCanSee) {
  // A line search stops where it cannot tell two values of E apart, hence at a gap of some
  // roundings of E; the sums over 100 points and the spread of curvatures take up the rest.
  const double kRoundings = 1e3;
  const auto problem = Rhino();
  const Trial<BandedQrSolver> direct(*problem, "banded_qr");
  Objective objective(problem.get(), nullptr);
  for (const char* form : kForms) {
    LbfgsTrial trial(*problem, WithForm(form));
    const Eigen::VectorXd error = trial.x - direct.x;
    const double gap = objective.curve_view()->rows().SquaredNormOfProduct(error.data());
    EXPECT_LE(gap, kRoundings * kEpsilon * trial.context.Energy(direct.x)) << form;
  }
}

TEST(CeresLbfgs, BooksTheStartOnceAndEveryIterateAfterIt) {
  const auto problem = Rhino();
  TestContextOptions options;
  options.max_iterations = 5;
  for (const char* form : kForms) {
    LbfgsTrial trial(*problem, WithForm(form), options);
    EXPECT_EQ(trial.outcome.reason, StopReason::kIterationLimit) << form;
    const auto& iterates = trial.context.iterates();
    ASSERT_EQ(iterates.size(), 6U) << form;
    EXPECT_EQ(iterates[0], problem->start()) << form;
    EXPECT_EQ(iterates[5], trial.x) << form;
    for (int i = 1; i <= 5; ++i) {
      EXPECT_LT(trial.context.Energy(iterates[i]), trial.context.Energy(iterates[i - 1])) << form;
    }
  }
}

TEST(CeresLbfgs, BooksThePointThatCeresHidesWhenItsLineSearchEnds) {
  const auto problem = Rhino();
  TestContextOptions never;
  never.gradient_tolerance = -1.0;
  never.stop_at_rounding_floor = false;
  for (const char* form : kForms) {
    ::testing::internal::CaptureStderr();
    LbfgsTrial trial(*problem, WithForm(form), never);
    EXPECT_THAT(::testing::internal::GetCapturedStderr(), IsEmpty()) << form;
    EXPECT_EQ(trial.outcome.reason, StopReason::kLineSearchEnded) << form;
    EXPECT_THAT(trial.outcome.message, StartsWith("Ceres: ")) << form;
    EXPECT_EQ(trial.context.iterates().back(), trial.x) << form;
    const double best = trial.context.Energy(trial.x);
    for (const auto& evaluated : trial.context.evaluations()) {
      EXPECT_LE(best, trial.context.Energy(evaluated.x) * (1.0 + 10.0 * kEpsilon)) << form;
    }
  }
}

TEST(CeresLbfgs, StopsWhenTheMonitorSaysNoAndAsksItNoMore) {
  const auto problem = Rhino();
  for (const int max_energies : {0, 1, 7}) {
    TestContextOptions options;
    options.max_energies = max_energies;
    for (const char* form : kForms) {
      LbfgsTrial trial(*problem, WithForm(form), options);
      EXPECT_EQ(trial.outcome.reason, StopReason::kTimeLimit) << form << max_energies;
      EXPECT_EQ(trial.context.count(Evaluation::kEnergy), max_energies) << form;
      EXPECT_EQ(trial.context.refused(), 1) << form << max_energies;
      EXPECT_EQ(trial.context.iterates().back(), trial.x) << form << max_energies;
      EXPECT_EQ(trial.context.iterates().front(), problem->start()) << form << max_energies;
    }
  }
}

TEST(CeresLbfgs, BooksAStartWithoutGradientOnce) {
  // All points are one, and the start is that point.
  DataSet points = MakeNoisyLoop(30, 2, 10);
  points.points.rowwise() = Eigen::RowVector2d(0.25, -3.0);
  FitSpec spec = MakeSpec(3, true, 8);
  spec.parameters = Parameterization::kUniform;
  const auto problem = MakeFit(points, spec);
  for (const char* form : kForms) {
    LbfgsTrial trial(*problem, WithForm(form));
    EXPECT_EQ(trial.outcome.reason, StopReason::kGradientSmall) << form;
    EXPECT_EQ(trial.context.iterates().size(), 1U) << form;
    EXPECT_EQ(trial.x, problem->start()) << form;
  }
}

TEST(CeresLbfgs, MinimisesRosenbrockFromBothForms) {
  const auto problem = MakeTestProblem("rosenbrock");
  for (const char* form : {"objective", "problem"}) {
    LbfgsTrial trial(*problem, WithForm(form));
    EXPECT_EQ(trial.outcome.reason, StopReason::kGradientSmall) << form;
    // E = 100 (x1 - x0^2)^2 + (1 - x0)^2 has curvature 0.4 along its valley: an error e there is
    // worth a gradient of 0.4 e.
    const double tolerance = 1e-10 * trial.context.gradient_norms().front() / 0.4;
    EXPECT_LE((trial.x - Eigen::Vector2d(1.0, 1.0)).norm(), tolerance) << form;
  }
}

TEST(CeresLbfgs, MeetsLinearConstraintsInEveryForm) {
  auto problem = Rhino();
  SetConstraints({HoldCurve(*problem, 0.3, 0, 0.25), HoldCurve(*problem, 0.3, 1, -0.125)},
                 problem.get());
  const Trial<BandedQrSolver> direct(*problem, "banded_qr");
  Objective objective(problem.get(), nullptr);
  const double kRoundings = 1e3;
  for (const char* form : kForms) {
    LbfgsTrial trial(*problem, WithForm(form));
    EXPECT_EQ(trial.x.size(), problem->num_variables() - 2) << form;
    const Eigen::VectorXd error = trial.x - direct.x;
    const double gap = objective.curve_view()->rows().SquaredNormOfProduct(error.data());
    EXPECT_LE(gap, kRoundings * kEpsilon * trial.context.Energy(direct.x)) << form;
  }
}

TEST(CeresLbfgs, EveryOptionChangesTheRunAndStillArrives) {
  const auto problem = MakeTestProblem("rosenbrock");
  const LbfgsTrial plain(*problem, "ceres_lbfgs");
  for (const char* option : {"memory=2", "scaling=on", "interpolation=quadratic",
                             "interpolation=bisection", "curvature=0.1"}) {
    LbfgsTrial trial(*problem, std::string("ceres_lbfgs/") + option);
    EXPECT_FALSE(SamePoints(trial.context, plain.context)) << option;
    EXPECT_EQ(trial.outcome.reason, StopReason::kGradientSmall) << option;
  }
}

TEST(CeresLbfgs, SaysWhyNot) {
  auto robust = MakeFit(MakeNoisyLoop(30, 2, 11), MakeSpec(3, true, 8, "interpolation/loss=huber"));
  EXPECT_THAT(WhyUnsupported<CeresLbfgsSolver>(*robust, "ceres_lbfgs"), IsEmpty());
  EXPECT_THAT(WhyUnsupported<CeresLbfgsSolver>(*robust, WithForm("spans")),
              HasSubstr("ceres_lbfgs/form=spans needs terms that are affine"));
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(robust->num_variables());
  robust->SetBounds(-one, one);
  EXPECT_THAT(WhyUnsupported<CeresLbfgsSolver>(*robust, "ceres_lbfgs"),
              HasSubstr("ceres_lbfgs ignores bounds; use ceres_lm"));
}

}  // namespace
}  // namespace batten
