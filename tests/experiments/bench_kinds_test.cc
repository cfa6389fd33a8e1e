#include "experiments/bench_kinds.h"

#include <gmock/gmock.h>

#include <cmath>

namespace batten {
namespace {

using ::testing::ElementsAre;

// Two instances, fixed and free, and three solvers: `direct` applies to the first alone, `foot` to
// the second alone, `descent` to both. On the second `descent` ends in a worse minimum.
class BenchKinds : public ::testing::Test {
 protected:
  BenchKinds() {
    results_.solvers = {"direct", "foot", "descent"};
    results_.targets = {{"gap 0.1", 0.1}};
    for (const char* kind : {"fixed", "free"}) {
      BenchInstance instance;
      instance.kind = kind;
      instance.has_basins = instance.kind == "free";
      instance.start_energy = 100.0;
      instance.minimum_energy = 1.0;
      results_.instances.push_back(instance);
    }
    Add(0, 0, &ran_, 1.0, 1.0);
    Add(0, 1, &skipped_, HUGE_VAL, HUGE_VAL);
    Add(0, 2, &ran_, 8.0, 8.0);
    Add(1, 0, &skipped_, HUGE_VAL, HUGE_VAL);
    Add(1, 1, &ran_, 5.0, 5.0);
    Add(1, 2, &ran_, HUGE_VAL, 3.0);
  }
  void Add(std::size_t instance, std::size_t solver, const nlohmann::json* row, double best,
           double own) {
    BenchRun run;
    run.instance = instance;
    run.solver = solver;
    run.first = row;
    run.to_target = {{best, best, best}};
    run.to_own_target = {{own, own, own}};
    results_.runs.push_back(run);
  }

  const nlohmann::json ran_ = {{"stop", "gradient_small"}};
  const nlohmann::json skipped_ = {{"stop", "skipped"}};
  BenchResults results_;
};

TEST_F(BenchKinds, HaveTheSolversThatApplyToThemAlone) {
  EXPECT_THAT(ParameterKinds(results_), ElementsAre("fixed", "free"));
  const BenchResults fixed = OfKind(results_, "fixed"), free = OfKind(results_, "free");
  EXPECT_THAT(fixed.solvers, ElementsAre("direct", "descent"));
  EXPECT_THAT(free.solvers, ElementsAre("foot", "descent"));
  EXPECT_FALSE(HasBasins(fixed));
  EXPECT_TRUE(HasBasins(free));
  EXPECT_TRUE(OfKind(results_, "projected").instances.empty());
  EXPECT_THAT(CostsOf(fixed, 0, BenchCost::kEvaluations, nullptr),
              ElementsAre(ElementsAre(1.0, 8.0)));
}

TEST_F(BenchKinds, AFastWayToAWorseMinimumCountsForTheOwnBasinAlone) {
  const BenchResults free = OfKind(results_, "free");
  EXPECT_THAT(CostsOf(free, 0, BenchCost::kEvaluations, nullptr),
              ElementsAre(ElementsAre(5.0, HUGE_VAL)));
  EXPECT_THAT(CostsOf(free, 0, BenchCost::kEvaluations, nullptr, BenchGoal::kOwnBasin),
              ElementsAre(ElementsAre(5.0, 3.0)));
}

}  // namespace
}  // namespace batten
