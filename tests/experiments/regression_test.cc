// What `regress` makes of results written down by hand.
#include "experiments/regression.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/experiments/hand_made_bench.h"

namespace batten {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr int kInstances = 12;  // the least p is 2^-12; six tests are made together

std::string Name(int k) { return std::string("p") + static_cast<char>('a' + k); }

/// On each instance one run of `solver` from E = 100: E = 1.05 after `evaluations[k]`, which is
/// nearer to the minimum 1 than a tenth of the way, then the end.
struct Made {
  std::vector<int> evaluations = std::vector<int>(kInstances, 50);
  std::vector<double> end_energies = std::vector<double>(kInstances, 1.04);
  double seconds = 0.3;
  double reference_seconds = 2e-4;
  std::string stop = "time_limit";

  BenchResults Results(HandMadeBench* bench) const {
    for (int k = 0; k < kInstances; ++k) {
      const auto i = static_cast<std::size_t>(k);
      bench->AddInstance(Name(k), 1.0)["reference_seconds"] = reference_seconds;
      bench->AddRun(Name(k), "lbfgs",
                    {{1, 0.01, 100.0},
                     {evaluations[i], 0.5 * seconds, 1.05},
                     {100, seconds, end_energies[i]}})["stop"] = stop;
    }
    return bench->Results();
  }
};

RegressionReport Compared(const Made& before, const Made& now, const RegressionRule& rule = {}) {
  HandMadeBench old_bench({0.1}), new_bench({0.1});
  BenchData none;
  return FindRegressions(none, before.Results(&old_bench), none, now.Results(&new_bench), rule);
}

TEST(FindRegressions, TakesNoEndAtATimeLimitForWorseByItself) {
  Made now;
  // Half of them end a little higher, half a little lower.
  for (std::size_t k = 0; k < kInstances; ++k) now.end_energies[k] += k % 2 == 0 ? 1e-3 : -1e-3;
  EXPECT_THAT(Compared(Made(), now).regressions, IsEmpty());
  EXPECT_THAT(Compared(now, Made()).regressions, IsEmpty());
}

TEST(FindRegressions, TakesEndsAtATimeLimitForWorseWhereAllAreHigher) {
  Made now;
  for (double& energy : now.end_energies) energy *= 1.001;
  const auto report = Compared(Made(), now);
  EXPECT_THAT(report.regressions,
              ElementsAre(HasSubstr("all solvers end at 1.001000 times the E at the time limit"),
                          HasSubstr("lbfgs end at 1.001000 times the E at the time limit")));
  EXPECT_THAT(Compared(now, Made()).regressions, IsEmpty());
}

TEST(FindRegressions, StillTakesOtherEndsThatAreHigherForWorse) {
  Made before, now;
  before.stop = now.stop = "iteration_limit";
  now.end_energies[3] *= 1.001;
  EXPECT_THAT(Compared(before, now).regressions,
              ElementsAre(HasSubstr("pd | own: lbfgs: ends at E = ")));
}

TEST(FindRegressions, ComparesCostsToTargetsWhereRunsEndWithoutSuccess) {
  Made before, now;
  before.stop = now.stop = "line_search_ended";
  EXPECT_THAT(Compared(before, now).regressions, IsEmpty());
  for (int& evaluations : now.evaluations) evaluations = 90;
  const auto report = Compared(before, now);
  EXPECT_THAT(report.regressions,
              ElementsAre(HasSubstr("all solvers need 1.80 times the evaluations"),
                          HasSubstr("lbfgs need 1.80 times the evaluations")));
}

TEST(FindRegressions, TakesTheSpeedOfTheMachineOutOfSeconds) {
  Made before, now;
  before.stop = now.stop = "gradient_small";
  now.seconds = 1.3 * before.seconds;
  const std::string slower = "all solvers need 1.30 times the seconds";
  EXPECT_THAT(Compared(before, now).regressions, Contains(HasSubstr(slower)));

  now.reference_seconds = 1.3 * before.reference_seconds;
  const auto drifted = Compared(before, now);
  EXPECT_THAT(drifted.regressions, IsEmpty());
  EXPECT_THAT(drifted.differences, Contains(HasSubstr("takes 1.30 times the seconds now")));

  // A faster machine does not hide a slower program, for runs that end at a target either.
  now.seconds = before.seconds;
  now.reference_seconds = before.reference_seconds / 1.3;
  EXPECT_THAT(Compared(before, now).regressions, Contains(HasSubstr(slower)));
  before.stop = now.stop = "line_search_ended";
  EXPECT_THAT(Compared(before, now).regressions, Contains(HasSubstr(slower)));

  now.reference_seconds = std::nan("");
  const auto unknown = Compared(before, now);
  EXPECT_THAT(unknown.regressions, IsEmpty());
  EXPECT_THAT(unknown.differences, Contains(HasSubstr("speed is not known")));
}

TEST(FindRegressions, NamesASolverWhoseCostsItCannotCompare) {
  Made far;
  far.stop = "line_search_ended";
  // Every row is above the target, E = 1 + 0.1 (100 - 1).
  HandMadeBench old_bench({0.1}), new_bench({0.1});
  for (HandMadeBench* bench : {&old_bench, &new_bench}) {
    bench->AddInstance("p", 1.0);
    bench->AddRun("p", "cg", {{1, 0.01, 100.0}, {9, 0.1, 50.0}})["stop"] = "line_search_ended";
  }
  BenchData none;
  const auto report =
      FindRegressions(none, old_bench.Results(), none, new_bench.Results(), RegressionRule());
  EXPECT_THAT(report.differences, Contains(HasSubstr("cg: no run reaches what is asked")));
}

TEST(FindRegressions, LetsARunThatWasCloseToTheTimeLimitReachIt) {
  RegressionRule rule;
  rule.slowdown = 9.0;  // costs are another matter
  Made before, now;
  before.stop = "gradient_small";
  before.seconds = 0.2;
  EXPECT_THAT(Compared(before, now, rule).regressions, IsEmpty());  // 0.3 s now
  before.seconds = 0.1;
  EXPECT_EQ(Compared(before, now, rule).regressions.size(), std::size_t{kInstances});
}

}  // namespace
}  // namespace batten
