#include "experiments/identity_card.h"

#include <gtest/gtest.h>

#include <algorithm>

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

}  // namespace
}  // namespace batten
