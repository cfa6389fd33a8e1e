#include "solvers/stepper.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "problems/test_functions.h"
#include "tests/solvers/circulant_fit.h"
#include "tests/solvers/contract_cases.h"

namespace batten {
namespace {

/// One stepper on its own objective, stepped by hand.
class SteppedRun {
 public:
  SteppedRun(const Problem& problem, const std::string& name, const Eigen::VectorXd& x)
      : context_(problem, {1000000, -1.0, false}),
        objective_(&problem, &context_),
        solver_(MakeSolver(name)),
        x_(x) {
    EXPECT_EQ(solver_->WhyUnsupported(objective_), "");
    EXPECT_FALSE(stepper()->Start(&objective_, &context_, &x_).has_value());
  }
  /// Taken up at x, where another run with this state was left.
  SteppedRun(const Problem& problem, const std::string& name, const Eigen::VectorXd& x,
             const std::vector<double>& state)
      : SteppedRun(problem, name, x) {
    stepper()->Restore(state);
    x_ = x;
  }
  Stepper* stepper() { return dynamic_cast<Stepper*>(solver_.get()); }
  const Eigen::VectorXd& x() const { return x_; }
  /// False once the run has ended.
  bool Step() { return !stepper()->Step(&x_).has_value(); }

 private:
  TestContext context_;
  Objective objective_;
  std::unique_ptr<Solver> solver_;
  Eigen::VectorXd x_;
};

std::vector<std::string> StepperNames() {
  std::vector<std::string> names;
  for (const std::string& name : SolverRegistry::Global().Names()) {
    const std::string whole = SolverRegistry::Global().UsualName(name);
    const std::unique_ptr<Solver> solver = MakeSolver(whole);
    if (dynamic_cast<Stepper*>(solver.get()) != nullptr) names.push_back(whole);
  }
  names.emplace_back("lspia/step=cauchy");
  names.emplace_back("lspia/step=barzilai_borwein");
  names.emplace_back("anderson:pdm");
  return names;
}

/// Methods that pair points with control points end by themselves here.
std::unique_ptr<Problem> FairedInterpolation() {
  FitSpec spec = MakeSpec(3, true, 30, "interpolation,fairing/derivative=1/weight=1e-3");
  spec.knots = KnotRule::kAveraged;
  return MakeFit(WithoutWeights(MakeNoisyLoop(30, 2, 71)), spec);
}

/// The problems of these tests that a stepper takes: one at least.
std::vector<std::unique_ptr<Problem>> ProblemsFor(const std::string& name) {
  std::vector<std::unique_ptr<Problem>> problems;
  problems.push_back(MakeCirculantFit(30, 1));
  problems.push_back(InterpolationProblems()[5].make());
  problems.push_back(FairedInterpolation());
  for (const ContractProblem& row : FreeProblems()) problems.push_back(row.make());
  const auto is_unsupported = [&name](const std::unique_ptr<Problem>& problem) {
    return !WhyUnsupported(*problem, name).empty();
  };
  problems.erase(std::remove_if(problems.begin(), problems.end(), is_unsupported), problems.end());
  CHECK(!problems.empty()) << name;
  return problems;
}

std::unique_ptr<Problem> FirstProblemFor(const std::string& name) {
  std::vector<std::unique_ptr<Problem>> problems = ProblemsFor(name);
  return std::move(problems.front());
}

class EveryStepper : public ::testing::TestWithParam<std::string> {};

/// A run of `total` steps, and one that is left after `before` and taken up by another object.
void ExpectResumes(const Problem& problem, const std::string& name, int before, int total) {
  SCOPED_TRACE(problem.name() + " left after " + std::to_string(before));
  SteppedRun whole(problem, name, StartOf(problem));
  SteppedRun first(problem, name, StartOf(problem));
  for (int k = 0; k < before; ++k) {
    const bool goes_on = whole.Step();
    ASSERT_EQ(first.Step(), goes_on);
    if (!goes_on) return;
  }
  SteppedRun second(problem, name, first.x(), first.stepper()->State());
  for (int k = before; k < total; ++k) {
    const bool goes_on = whole.Step();
    ASSERT_EQ(second.Step(), goes_on);
    ASSERT_TRUE(SameBits(whole.x(), second.x())) << k;
    if (!goes_on) return;
  }
}

TEST_P(EveryStepper, GoesOnFromItsStateAsIfItHadNotBeenLeft) {
  for (const auto& problem : ProblemsFor(GetParam())) {
    for (const int before : {0, 1, 4, 17}) ExpectResumes(*problem, GetParam(), before, 40);
  }
}

TEST(Stepper, EndsAtALimitOfItsOwnAsIfItHadNotBeenLeft) {
  const auto problem = FairedInterpolation();
  for (const char* name : {"gim", "weighted_pia", "local_pia", "preconditioned_pia", "extended_pia",
                           "lspia/fairing_factor=3"}) {
    SCOPED_TRACE(name);
    SteppedRun run(*problem, name, StartOf(*problem));
    int total = 1;
    while (run.Step()) ASSERT_LT(++total, 2000);
    // Shorter moves than at the start are behind it by then.
    ASSERT_GT(total, 3);
    ExpectResumes(*problem, name, total / 2, total);
  }
}

TEST_P(EveryStepper, StepsAsInItsOwnLoop) {
  const auto problem = FirstProblemFor(GetParam());
  TestContextOptions options;
  options.max_iterations = 12;
  options.gradient_tolerance = -1.0;
  options.stop_at_rounding_floor = false;
  const SolverTrial loop(*problem, GetParam(), options);
  SteppedRun stepped(*problem, GetParam(), StartOf(*problem));
  for (const Eigen::VectorXd& x : loop.context.iterates()) {
    ASSERT_TRUE(SameBits(stepped.x(), x));
    stepped.Step();
  }
}

TEST_P(EveryStepper, RunsInLockstepWithAnyOther) {
  const auto problem = FirstProblemFor(GetParam());
  for (const std::string& other : StepperNames()) {
    SCOPED_TRACE(other);
    const auto its_problem = FirstProblemFor(other);
    SteppedRun alone(*problem, GetParam(), StartOf(*problem));
    SteppedRun one(*problem, GetParam(), StartOf(*problem));
    SteppedRun two(*its_problem, other, StartOf(*its_problem));
    for (int k = 0; k < 15; ++k) {
      const bool goes_on = alone.Step();
      ASSERT_EQ(one.Step(), goes_on);
      two.Step();
      ASSERT_TRUE(SameBits(alone.x(), one.x())) << k;
      if (!goes_on) break;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Registry, EveryStepper, ::testing::ValuesIn(StepperNames()),
                         [](const auto& stepper) {
                           std::string name = stepper.param;
                           std::replace_if(
                               name.begin(), name.end(),
                               [](char c) { return std::isalnum(c) == 0; }, '_');
                           return name;
                         });

TEST(Stepper, LbfgsGoesOnFromItsStateOnCurvedObjectives) {
  for (const char* name : {"rosenbrock", "wood", "trigonometric"}) {
    for (const int before : {0, 1, 3, 15}) {
      ExpectResumes(*MakeTestProblem(name), "lbfgs/memory=5", before, 25);
    }
  }
}

TEST(Stepper, LspiaSeesAStallAsSoonAsIfItHadNotBeenLeft) {
  // The dolphin, whose largest column makes an eigenvalue of -1.
  FitSpec spec = MakeSpec(3, true, 40);
  spec.parameters = Parameterization::kUniform;
  const auto problem = MakeFileFit("animals/dolphin_80.csv", spec);
  TestContextOptions options;
  options.max_iterations = 2000;
  const SolverTrial whole(*problem, "lspia/step=max_column", options);
  ASSERT_EQ(whole.outcome.reason, StopReason::kStalled);
  ExpectResumes(*problem, "lspia/step=max_column", whole.iterations() - 8, whole.iterations() + 30);
}

TEST(Stepper, LbfgsGoesOnFromItsStateWithoutCompilationOrWithALoss) {
  for (const int before : {1, 12, 30}) {
    const auto problem = MakeFit(MakeNoisyLoop(60, 2, 4),
                                 MakeSpec(3, true, 17, "interpolation/loss=cauchy/loss_scale=0.1"));
    ExpectResumes(*problem, "lbfgs", before, 45);
  }
}

TEST(Stepper, AMapLeavesItsArgumentAndIsTheStep) {
  for (const std::string& name : StepperNames()) {
    const std::unique_ptr<Solver> solver = MakeSolver(name);
    auto* map = dynamic_cast<FixedPoint*>(solver.get());
    if (map == nullptr) continue;
    for (const auto& problem : ProblemsFor(name)) {
      TestContext context(*problem);
      Objective objective(problem.get(), &context);
      Eigen::VectorXd x = objective.start(), image;
      ASSERT_FALSE(map->Start(&objective, &context, &x).has_value());
      const Eigen::VectorXd start = x;
      ASSERT_EQ(map->Map(x, &image), Status::kOk);
      EXPECT_TRUE(SameBits(x, start));
      ASSERT_FALSE(map->Step(&x).has_value());
      EXPECT_TRUE(SameBits(x, image)) << name;
    }
  }
}

TEST(Stepper, ARefusedStepLeavesThePointAlone) {
  const auto problem = MakeCirculantFit(30, 1);
  // Where parameters are free: contract_stop_test.cc.
  for (const std::string& name : StepperNames()) {
    TestContextOptions options;
    options.max_energies = 0;
    TestContext context(*problem, options);
    Objective objective(problem.get(), &context, {false});
    const std::unique_ptr<Solver> solver = MakeSolver(name);
    if (!solver->WhyUnsupported(objective).empty()) continue;
    Eigen::VectorXd x = problem->start();
    const auto outcome = dynamic_cast<Stepper*>(solver.get())->Start(&objective, &context, &x);
    ASSERT_TRUE(outcome.has_value());
    EXPECT_EQ(outcome->reason, StopReason::kTimeLimit);
    EXPECT_TRUE(SameBits(x, problem->start()));
  }
}

}  // namespace
}  // namespace batten
