// The conformance suite must pass what is known to be good: all that is built in. What it must find
// is tried on plugins with one fault each (tests/tools/check_command_test.cc).
#include "experiments/conformance.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "cost_functions/term.h"
#include "solvers/solver_registry.h"

namespace batten {
namespace {

void ExpectAllPass(const std::string& name, const std::vector<ConformanceCheck>& checks) {
  for (const ConformanceCheck& check : checks) {
    SCOPED_TRACE(check.name);
    EXPECT_FALSE(check.what.empty());
    if (check.name == "memory") {
      // In a process of its own: it changes how memory is handed out.
      EXPECT_EXIT(std::_Exit(check.run().passed ? 0 : 1), ::testing::ExitedWithCode(0), "");
      continue;
    }
    // Ceres' own threads sum in no fixed order (docs/design.md).
    if (check.name == "threads" && name == "ceres_lm") continue;
    const CheckVerdict verdict = check.run();
    EXPECT_TRUE(verdict.passed) << verdict.detail;
    EXPECT_FALSE(verdict.detail.empty());
  }
}

class BuiltInSolver : public ::testing::TestWithParam<std::string> {};
// With each word of their options it would take minutes.
TEST_P(BuiltInSolver, PassesEveryCheck) {
  ExpectAllPass(GetParam(), SolverChecks(GetParam(), SolverVariants::kUsual));
}
INSTANTIATE_TEST_SUITE_P(Registry, BuiltInSolver,
                         ::testing::ValuesIn(SolverRegistry::Global().Names()),
                         [](const auto& solver) { return solver.param; });

class BuiltInTerm : public ::testing::TestWithParam<std::string> {};
TEST_P(BuiltInTerm, PassesEveryCheck) { ExpectAllPass(GetParam(), TermChecks(GetParam())); }
INSTANTIATE_TEST_SUITE_P(Registry, BuiltInTerm, ::testing::ValuesIn(TermRegistry::Global().Names()),
                         [](const auto& term) { return term.param; });

}  // namespace
}  // namespace batten
