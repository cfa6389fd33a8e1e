#include "experiments/identity_card.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "experiments/bench_matrix.h"
#include "solvers/options_note.h"
#include "solvers/solver_registry.h"
#include "tests/solvers/test_fits.h"

namespace batten {
namespace {

RunResult Noted(const std::string& asked, const std::string& ran) {
  RunResult run;
  std::string error;
  EXPECT_TRUE(ParseNameSpec(asked, &run.solver, &error)) << error;
  run.notes = {{"another note", "lbfgs/memory=999"}, {kOptionsThatRan, ran}};
  return run;
}

TEST(OptionsThatDiffer, AreNoneWhereTheLibraryAnswersWhatWasAsked) {
  EXPECT_EQ(OptionsThatDiffer(Noted("lbfgs/memory=7", "lbfgs/memory=7")), "");
  // Also of a default, and of one that is not mentioned.
  EXPECT_EQ(OptionsThatDiffer(Noted("ceres_lbfgs/curvature=0.5", "ceres_lbfgs/memory=20")), "");
  EXPECT_EQ(OptionsThatDiffer(Noted("best_of/starts=3:lbfgs/memory=7", "lbfgs/memory=7")), "");
}

TEST(OptionsThatDiffer, AreSaidWithBothValues) {
  EXPECT_EQ(OptionsThatDiffer(Noted("lbfgs/memory=7", "lbfgs/memory=8")),
            "asked memory=7, ran memory=8");
  EXPECT_EQ(OptionsThatDiffer(Noted("best_of/starts=3:lbfgs/memory=7", "lbfgs/memory=8")),
            "asked memory=7, ran memory=8");
  EXPECT_EQ(OptionsThatDiffer(Noted("lbfgs", "lbfgs/depth=8")), "asked no depth, ran depth=8");
  EXPECT_EQ(OptionsThatDiffer(Noted("lbfgs", "cg/memory=8")), "ran cg/memory=8");
}

TEST(EffectiveIdentity, HasWhatRanAndDefaultsBesideIt) {
  const std::string asked = SolverIdentity(Noted("lbfgs/memory=7", "").solver);
  EXPECT_EQ(asked.find("lbfgs/"), 0u);
  EXPECT_NE(asked.find("/memory=7"), std::string::npos);
  EXPECT_EQ(EffectiveIdentity(Noted("lbfgs/memory=7", "lbfgs/memory=7")), asked);
  // Asked for differently, run alike.
  EXPECT_EQ(EffectiveIdentity(Noted("lbfgs/memory=8", "lbfgs/memory=7")), asked);
  EXPECT_NE(EffectiveIdentity(Noted("lbfgs/memory=7", "lbfgs/memory=8")), asked);
  // Of a wrapped one, and nothing of the one around it.
  const std::string both =
      EffectiveIdentity(Noted("best_of/starts=3:lbfgs/memory=8", "lbfgs/memory=7"));
  EXPECT_EQ(both.find("best_of/"), 0u);
  EXPECT_EQ(both.substr(both.find(':') + 1), asked);
}

TEST(EffectiveIdentity, HasWhatNobodyAskedFor) {
  const std::string asked = SolverIdentity(Noted("cg", "").solver);
  EXPECT_EQ(EffectiveIdentity(Noted("cg", "lbfgs/memory=8")), asked + " ran lbfgs/memory=8");
  EXPECT_NE(EffectiveIdentity(Noted("cg", "cg/depth=8")).find("/depth=8"), std::string::npos);
}

/// With each word of its options, Ceres says after the solve that it ran with it.
TEST(OptionsThatDiffer, AreNoneOfCeres) {
  const auto problem = MakeFit(MakeNoisyLoop(60, 2, 1), MakeSpec(3, true, 9));
  for (const char* solver :
       {"ceres_lbfgs/memory=3", "ceres_lbfgs/interpolation=quadratic",
        "ceres_lbfgs/interpolation=bisection/form=problem", "ceres_lm/strategy=dogleg",
        "ceres_lm/linear_solver=dense_qr", "ceres_lm/linear_solver=cgnr",
        "ceres_lm/linear_solver=dense_normal_cholesky",
        "ceres_lm/linear_solver=sparse_normal_cholesky"}) {
    NameSpec spec;
    RunResult run;
    std::string error;
    ASSERT_TRUE(ParseNameSpec(solver, &spec, &error)) << error;
    ASSERT_TRUE(batten::Run(*problem, spec, RunSpec(), &run, &error)) << error;
    EXPECT_EQ(OptionsThatDiffer(run), "") << solver;
    const bool is_noted = std::any_of(run.notes.begin(), run.notes.end(), [](const auto& note) {
      return note.first == kOptionsThatRan;
    });
    EXPECT_TRUE(is_noted) << solver;
  }
}

/// A wrapping solver hides that its base was run many times, not what the library said.
TEST(OptionsThatRan, AreNotedOnceOfWrappedSolvers) {
  const auto problem = MakeFit(MakeNoisyLoop(60, 2, 1), MakeFreeSpec(3, true, 9));
  NameSpec spec;
  RunSpec cut;
  cut.max_iterations = 1;  // the end of the first start: nothing is run from the best
  std::string error;
  ASSERT_TRUE(ParseNameSpec("best_of/starts=3:ceres_lbfgs/memory=7", &spec, &error)) << error;
  for (const RunSpec& run_spec : {RunSpec(), cut}) {
    RunResult run;
    ASSERT_TRUE(batten::Run(*problem, spec, run_spec, &run, &error)) << error;
    ASSERT_EQ(run.skipped, "");
    const auto is_noted = [](const auto& note) { return note.first == kOptionsThatRan; };
    EXPECT_EQ(std::count_if(run.notes.begin(), run.notes.end(), is_noted), 1);
    EXPECT_NE(EffectiveIdentity(run).find("ceres_lbfgs/"), std::string::npos);
  }
}

}  // namespace
}  // namespace batten
