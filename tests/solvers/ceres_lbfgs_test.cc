#include "solvers/ceres_lbfgs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "solvers/banded_qr.h"
#include "tests/solvers/test_context.h"
#include "tests/solvers/test_fits.h"

namespace batten {
namespace {

using ::testing::HasSubstr;

CeresLbfgsSolver MakeSolver(const std::string& name_and_options) {
  NameSpec spec;
  OptionValues options;
  std::string error;
  CHECK(ParseNameSpec(name_and_options, &spec, &error)) << error;
  CHECK(ResolveOptions(CeresLbfgsSolver::ClassInfo().options, spec, &options, &error)) << error;
  return CeresLbfgsSolver(options);
}

/// One run from the problem's start.
struct Run {
  Run(const Problem& problem, const std::string& name_and_options, TestContextOptions options = {},
      bool compile = true)
      : context(problem, options) {
    Objective::Options objective_options;
    objective_options.compile = compile;
    Objective objective(&problem, &context, objective_options);
    x = objective.start();
    outcome = MakeSolver(name_and_options).Minimize(&objective, &context, &x);
  }
  TestContext context;
  Eigen::VectorXd x;
  Outcome outcome;
};

bool SameBits(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return a.size() == b.size() &&
         std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<std::size_t>(a.size())) == 0;
}

/// Evaluation by evaluation: equal kinds at equal points, and the same end.
void ExpectSameRun(const Run& a, const Run& b) {
  ASSERT_EQ(a.context.evaluations().size(), b.context.evaluations().size());
  for (std::size_t i = 0; i < a.context.evaluations().size(); ++i) {
    ASSERT_EQ(a.context.evaluations()[i].kind, b.context.evaluations()[i].kind) << i;
    ASSERT_TRUE(SameBits(a.context.evaluations()[i].x, b.context.evaluations()[i].x)) << i;
  }
  EXPECT_EQ(a.context.iterates().size(), b.context.iterates().size());
  EXPECT_TRUE(SameBits(a.x, b.x));
  EXPECT_EQ(a.outcome.reason, b.outcome.reason);
  EXPECT_EQ(a.outcome.message, b.outcome.message);
}

struct FormsCase {
  std::string name;
  std::unique_ptr<Problem> (*make)();
};

std::ostream& operator<<(std::ostream& stream, const FormsCase& forms) {
  return stream << forms.name;
}

const FormsCase kFormsCases[] = {
    {"ClosedOutline",
     [] { return MakeFileFit("animals/rhino_100.csv", MakeSpec(3, true, 40)); }},
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
    {"OpenLineOfNumbers",
     [] { return MakeFit(MakeNoisyLoop(120, 1, 3), MakeSpec(3, false, 21)); }},
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
  const Run objective(*problem, "ceres_lbfgs/form=objective", {}, false);
  const Run native(*problem, "ceres_lbfgs/form=problem", {}, false);
  ASSERT_GT(objective.context.iterates().size(), 10U);
  ExpectSameRun(objective, native);
}

INSTANTIATE_TEST_SUITE_P(Problems, CeresLbfgsForms, ::testing::ValuesIn(kFormsCases),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace batten
