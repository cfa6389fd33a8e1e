// What the methods of joint descent count, every pass over the data that sums their model, and how
// many steps they take.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "solvers/solver_registry.h"
#include "tests/solvers/contract_cases.h"

namespace batten {
namespace {

std::unique_ptr<Problem> Bean() {
  return MakeFit(MakeNoisyBean(30, 2, 711), MakeFreeSpec(3, true, 8, "ellipse"));
}

/// A curve that starts in one point, far from good steps.
std::unique_ptr<Problem> FreeRhino() {
  return MakeFileFit("animals/rhino_100.csv", MakeFreeSpec(3, true, 8));
}

/// The evaluations of a run, told apart by its energies: a point that lowers E is gone to, after
/// one that does not the sums are made anew where the run stands, as where the model has no step.
struct Told {
  int accepted = 0;
  int rejected = 0;
  int without_step = 0;
};
Told Tell(SolverTrial* trial) {
  const auto& evaluations = trial->context.evaluations();
  Told told;
  Eigen::VectorXd here = evaluations.front().x;
  for (std::size_t k = 1; k < evaluations.size(); ++k) {
    EXPECT_EQ(evaluations[k].kind, Evaluation::kJacobian);
    if (evaluations[k].x == here) {
      ++told.without_step;
      continue;
    }
    if (trial->context.Energy(evaluations[k].x) < trial->context.Energy(here)) {
      here = evaluations[k].x;
      ++told.accepted;
      continue;
    }
    ++told.rejected;
    if (++k == evaluations.size()) {
      ADD_FAILURE() << "no new sums after a step that was not taken";
      break;
    }
    EXPECT_EQ(evaluations[k].x, here);
  }
  return told;
}

TEST(JointDescent, CountsThePassAfterAStepThatIsNotTaken) {
  int rejected = 0;
  for (const char* solver : {"lm_schur", "newton"}) {
    for (const auto& problem : {Bean(), FreeRhino()}) {
      constexpr int kIterations = 8;  // early: differences of E are no rounding
      SolverTrial trial(*problem, solver, {kIterations});
      const Told told = Tell(&trial);
      EXPECT_EQ(told.accepted, kIterations) << solver;
      EXPECT_EQ(trial.context.count(Evaluation::kJacobian),
                1 + told.accepted + 2 * told.rejected + told.without_step);
      // Gauss and Newton's Hessian is positive definite.
      if (std::string(solver) == "lm_schur") {
        EXPECT_EQ(told.without_step, 0);
      }
      rejected += told.rejected;
    }
  }
  EXPECT_GT(rejected, 0);
}

// Beside a saddle, Gauss and Newton's steps alone took 170 and 157 iterations here.
TEST(JointDescent, DoesNotCrawlAwayFromASaddle) {
  // SplitMix64 (Steele, Lea and Flood, OOPSLA 2014), on [-1, 1).
  const auto noise = [](std::uint64_t place) {
    std::uint64_t z = (place + 1) * 0x9E3779B97F4A7C15ULL;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    z ^= z >> 31;
    return static_cast<double>(z >> 11) * std::exp2(-52.0) - 1.0;
  };
  struct Case {
    int points;
    std::uint64_t first;
  };
  for (const Case& from : {Case{10'000, 3'000'000}, Case{20'000, 1'000'000}}) {
    DataSet data;
    data.points.resize(from.points, 2);
    for (int i = 0; i < from.points; ++i) {
      const double a = 2.0 * M_PI * i / from.points;
      const double r = 1.0 + 0.25 * std::cos(3.0 * a) + 0.1 * std::sin(7.0 * a);
      const std::uint64_t place = from.first + 2 * static_cast<std::uint64_t>(i);
      data.points.row(i) << r * std::cos(a) + 0.06 * noise(place),
          r * std::sin(a) + 0.06 * noise(place + 1);
    }
    FitSpec spec = MakeFreeSpec(3, true, 100, "circle");
    spec.guard = NameSpec{"bending", {}, nullptr};
    const auto problem = MakeFit(data, spec);
    constexpr int kEnough = 40;
    const SolverTrial trial(*problem, "foot_newton", {kEnough});
    const std::vector<double>& norms = trial.context.gradient_norms();
    EXPECT_LT(norms.back(), 1e-9 * norms.front()) << from.points;
  }
}

// By hand: at the start the pass that solves for P and the one there; in each of three steps the
// pass that solves for P at the new t, and the one at what comes of it.
TEST(Varpro, CountsThePassThatSolvesForTheControlPoints) {
  const SolverTrial trial(*Bean(), "varpro", {3});
  EXPECT_EQ(trial.iterations(), 3);
  EXPECT_EQ(trial.context.count(Evaluation::kJacobian), 2 + 3 * 2);
  EXPECT_EQ(trial.context.evaluations().size(), 8U);
}

TEST(Varpro, StopsWhereThePassIsRefused) {
  class Refuses final : public EvaluationMonitor {
   public:
    bool Allow(Evaluation /*kind*/, const Eigen::VectorXd* /*x*/) override { return false; }
  };
  const auto problem = Bean();
  TestContext context(*problem);
  Refuses monitor;
  Objective objective(problem.get(), &monitor);
  Eigen::VectorXd x = objective.start();
  std::string error;
  OptionValues options;
  const auto solver = SolverRegistry::Global().Make({"varpro", {}, nullptr}, &options, &error);
  ASSERT_NE(solver, nullptr) << error;
  solver->Minimize(&objective, &context, &x);
  EXPECT_EQ(x, objective.start());
  EXPECT_TRUE(context.iterates().empty());
}

}  // namespace
}  // namespace batten
