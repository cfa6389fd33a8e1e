#include "experiments/comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <thread>

#include "experiments/comparison_tables.h"
#include "solvers/solver_registry.h"
#include "tests/roundoff.h"

namespace batten {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

std::vector<NameSpec> Solvers(const std::string& list) {
  std::vector<NameSpec> solvers;
  std::string error;
  EXPECT_TRUE(ParseNameSpecList(list, &solvers, &error)) << error;
  return solvers;
}

ComparisonSpec Spec(const std::string& problem, const std::string& solvers, int repetitions = 1) {
  ComparisonSpec spec;
  spec.problems = {problem};
  spec.solvers = Solvers(solvers);
  spec.repetitions = repetitions;
  return spec;
}

ComparisonResult Compared(const ComparisonSpec& spec) {
  ComparisonResult result;
  std::string error;
  EXPECT_TRUE(Compare(spec, &result, &error)) << error;
  return result;
}

/// A problem file with its data beside it.
std::string ProblemFile(const std::string& name, int num_points, int control_points,
                        const std::string& term = "interpolation") {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "batten_compare";
  std::filesystem::create_directories(folder);
  std::ofstream data(folder / (name + ".csv"));
  data << "x,y\n";
  for (int i = 0; i < num_points; ++i)
    data << std::cos(0.9 * i) << ',' << std::sin(1.7 * i) << '\n';
  std::ofstream(folder / (name + ".json"))
      << "{\"name\": \"" << name << "\", \"data\": \"" << name << ".csv\", \"spline\": "
      << "{\"degree\": 3, \"closed\": true, \"control_points\": " << control_points
      << ", \"knots\": \"uniform\"}, \"parameters\": \"uniform\", \"terms\": [\"" << term << "\"], "
      << "\"start\": \"data\"}";
  return folder / (name + ".json");
}

/// Says that it has solved the problem; takes 40, 1, 10, 40, ... ms for that.
class SleepingSolver : public Solver {
 public:
  static SolverInfo ClassInfo() {
    SolverInfo info;
    info.name = "sleeping";
    info.native_rule = NativeRule::kDirect;
    return info;
  }
  explicit SleepingSolver(const OptionValues& /*options*/) {}
  SolverInfo Info() const override { return ClassInfo(); }
  std::string WhyUnsupported(const Objective& /*objective*/) const override { return ""; }
  static int num_runs;

 private:
  Outcome DoMinimize(Objective* /*objective*/, RunContext* context, Eigen::VectorXd* x) override {
    const int milliseconds[] = {40, 1, 10};
    context->Iterate(*x);
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds[num_runs++ % 3]));
    return {StopReason::kSolved, ""};
  }
};
int SleepingSolver::num_runs = 0;

/// Registered while it lives: other tests run over all registered solvers.
struct WithSleepingSolver {
  WithSleepingSolver() { SolverRegistry::Global().Register(MakeSolverEntry<SleepingSolver>()); }
  ~WithSleepingSolver() { SolverRegistry::Global().Remove("sleeping"); }
};

TEST(Compare, SaysWhatIsWrongBeforeAnythingRuns) {
  const WithSleepingSolver registered;
  SleepingSolver::num_runs = 0;
  ComparisonResult result;
  std::string error;
  EXPECT_FALSE(Compare(Spec("rhino", "sleeping,lbgfs"), &result, &error));
  EXPECT_THAT(error, HasSubstr("unknown solver \"lbgfs\"; did you mean lbfgs"));
  EXPECT_FALSE(Compare(Spec("rhino", "sleeping,lbfgs/memory=-1"), &result, &error));
  EXPECT_THAT(error, HasSubstr("memory"));
  ComparisonSpec spec = Spec("rhino", "sleeping");
  spec.problems.push_back("rhinozeros");
  EXPECT_FALSE(Compare(spec, &result, &error));
  EXPECT_THAT(error, HasSubstr("rhinozeros"));
  EXPECT_FALSE(Compare(Spec("rhino", "sleeping", 0), &result, &error));
  EXPECT_EQ(error, "repetitions is 0; allowed: 1 or more");
  EXPECT_EQ(SleepingSolver::num_runs, 0);
}

TEST(Compare, FindsAllSolversAtTheDirectAnswer) {
  const ComparisonResult result =
      Compared(Spec("rhino", "banded_qr,banded_cholesky,cg,lbfgs/memory=10,lspia", 2));
  ASSERT_EQ(result.rows.size(), 5u);
  EXPECT_THAT(result.disagreements, IsEmpty());
  for (const ComparisonRow& row : result.rows) {
    EXPECT_EQ(row.problem, "rhino");
    EXPECT_EQ(row.repetitions, 2);
    EXPECT_TRUE(row.unique_minimum);
    EXPECT_LT(row.distance_to_direct, 1e-8) << row.solver;  // what solvers must agree to
    EXPECT_LE(row.distance_to_direct, row.allowed_distance) << row.solver;
    // |g| fell by 1e10; the condition is below 100, so the energy's gap fell by nearly 1e20.
    EXPECT_LT(row.gap, 1e-17) << row.solver;
    EXPECT_TRUE(row.report.verdict.holds) << row.report.verdict.failure;
    EXPECT_GT(row.times_cholesky, 0.0);
    EXPECT_EQ(row.run.trace.size(), row.excess_energies.size());
    EXPECT_THAT(row.run.iterates, IsEmpty());
  }
  EXPECT_EQ(result.rows[1].solver, "banded_cholesky");
  EXPECT_EQ(result.rows[1].times_cholesky, 1.0);
  EXPECT_EQ(result.rows[3].solver, "lbfgs/memory=10");
  // The catalogue's reference, by SciPy.
  EXPECT_NEAR(result.minimum_energies[0], 4.486845758379909, 1e-12);
}

TEST(Compare, KeepsTheReasonOfASkippedRow) {
  const ComparisonResult result = Compared(Spec("rhino", "gim,cg", 3));
  ASSERT_EQ(result.rows.size(), 2u);
  EXPECT_EQ(result.rows[0].run.skipped, "gim needs 100 control points for 100 points");
  EXPECT_TRUE(std::isnan(result.rows[0].gap));
  EXPECT_TRUE(std::isnan(result.rows[0].seconds));
  EXPECT_FALSE(result.rows[0].report.audited);
  EXPECT_GT(result.rows[1].times_cholesky, 0.0);  // run as a reference
}

TEST(Compare, TakesMediansOfInterleavedRepetitions) {
  const WithSleepingSolver registered;
  SleepingSolver::num_runs = 0;
  ComparisonSpec spec = Spec("rhino", "sleeping,banded_cholesky", 3);
  std::vector<std::string> running;
  spec.progress = [&running](int done, int total, const std::string& text) {
    running.push_back(std::to_string(done + 1) + " of " + std::to_string(total) + " " + text);
  };
  const ComparisonResult result = Compared(spec);
  EXPECT_THAT(running, ElementsAre("1 of 6 rhino: sleeping", "2 of 6 rhino: banded_cholesky",
                                   "3 of 6 rhino: sleeping", "4 of 6 rhino: banded_cholesky",
                                   "5 of 6 rhino: sleeping", "6 of 6 rhino: banded_cholesky"));
  EXPECT_EQ(SleepingSolver::num_runs, 3);
  const ComparisonRow& row = result.rows[0];
  EXPECT_GE(row.seconds, 0.010);  // of 40, 1 and 10 ms; a sleep can only be longer
  EXPECT_LT(row.seconds, 0.040);
  EXPECT_LT(row.setup_seconds, row.solve_seconds);
  EXPECT_NEAR(row.times_cholesky, row.seconds / result.rows[1].seconds, 1e-9 * row.times_cholesky);
}

/// The third cell of the table's row of a solver: whether its claim is verified.
std::string VerifiedCell(const std::string& fields, const std::string& solver) {
  const std::filesystem::path file =
      std::filesystem::path(testing::TempDir()) / "batten_compare_audit.json";
  std::ofstream(file) << R"({"name": "audited", "data": "animals/rhino_100.csv", "spline":
      {"degree": 3, "closed": false, "control_points": 20, "knots": "uniform"},
      "parameters": "chord_length", )"
                      << fields << "}";
  const std::string text = ComparisonMarkdown(Compared(Spec(file, solver)));
  const std::string head = "| audited | " + solver + " | ";
  const std::size_t status = text.find(head);
  if (status == std::string::npos) return text;
  const std::size_t cell = text.find("| ", status + head.size()) + 2;
  return text.substr(cell, text.find(" |", cell) - cell);
}

TEST(Compare, VerifiesLossesAndConstraints) {
  for (const char* loss : {"huber", "cauchy", "tukey", "soft_l1"}) {
    const std::string terms = std::string(R"("terms": ["interpolation/loss=)") + loss;
    EXPECT_EQ(VerifiedCell(terms + R"(/loss_scale=mad"])", "irls:banded_qr"), "yes") << loss;
    EXPECT_EQ(VerifiedCell(terms + R"(/loss_scale=0.01"])", "lbfgs"), "yes") << loss;
  }
  EXPECT_EQ(VerifiedCell(R"("constraints": ["ends", "natural"])", "banded_qr"), "yes");
  EXPECT_EQ(VerifiedCell(R"("constraints": ["clamped", "point/t=0.5/x=3"])", "lbfgs"), "yes");
  EXPECT_EQ(
      VerifiedCell(R"("constraints": ["curvature/t=0.5/kappa=0.1"])", "augmented_lagrangian:lbfgs"),
      "in part");
  EXPECT_EQ(VerifiedCell(R"("terms": ["interpolation", "curve_fairing/weight=1e-6"])", "lbfgs"),
            "yes");
  EXPECT_EQ(
      VerifiedCell(R"("terms": ["interpolation", "fairing/weight=1e-6/loss=huber"])", "lbfgs"),
      "-");
}

TEST(Compare, MarksAClaimThatFailsItsAudit) {
  const WithSleepingSolver registered;
  const ComparisonResult result = Compared(Spec("rhino", "sleeping"));
  EXPECT_TRUE(result.rows[0].report.audited);
  EXPECT_FALSE(result.rows[0].report.verdict.holds);
  EXPECT_THAT(result.rows[0].report.verdict.failure, HasSubstr("claims a minimum"));
  EXPECT_EQ(result.rows[0].gap, 1.0);
}

TEST(Compare, MeasuresTheExcessAlongTheTrace) {
  const ComparisonResult result = Compared(Spec("rhino", "lbfgs"));
  const ComparisonRow& row = result.rows[0];
  const double minimum = result.minimum_energies[0];
  for (std::size_t k = 0; k < row.run.trace.size(); ++k) {
    // E itself is known to some roundings of its size only.
    EXPECT_NEAR(row.excess_energies[k], row.run.trace[k].energy - minimum,
                1000 * kEpsilon * row.run.trace[k].energy);
  }
  EXPECT_GT(row.excess_energies.back(), 0.0);
  EXPECT_LT(row.excess_energies.back(), 1e-15);  // far below what a subtraction could show
}

TEST(Compare, MeasuresTheExcessBySubtractionWhereIteratesTakeTooMuchMemory) {
  ComparisonSpec spec = Spec("rhino", "lbfgs");
  spec.run.max_iterations = 1000000;  // 160 variables: 1.28 GB
  const ComparisonRow row = Compared(spec).rows[0];
  EXPECT_GT(row.excess_energies.front(), 0.0);
  EXPECT_TRUE(std::isnan(row.excess_energies.back()));
}

TEST(Compare, ComparesCurvesWhereTheMinimumIsNotUnique) {
  const std::string file = ProblemFile("few_points", 6, 10);
  const ComparisonResult result = Compared(Spec(file, "banded_qr,cg,lbfgs,ceres_lm"));
  EXPECT_THAT(result.disagreements, IsEmpty());
  for (const ComparisonRow& row : result.rows) {
    EXPECT_EQ(row.problem, "few_points");
    EXPECT_FALSE(row.unique_minimum);
    EXPECT_LT(row.distance_to_direct, 1e-8) << row.solver;
  }
}

TEST(Compare, MeasuresAgainstCholeskyAlsoWithoutCompilation) {
  ComparisonSpec spec = Spec("rhino", "banded_cholesky,ceres_lbfgs");
  spec.run.compile = false;
  const ComparisonResult result = Compared(spec);
  EXPECT_THAT(result.rows[0].run.skipped, HasSubstr("compil"));
  EXPECT_GT(result.rows[1].times_cholesky, 0.0);
  EXPECT_LT(result.rows[1].distance_to_direct, 1e-6);
}

// Curves that are one have one energy at their foot points; here those of different minima differ
// by more than 1e-4 of it.
TEST(Compare, TellsWhichMinimumARunLeadsTo) {
  const ComparisonResult result = Compared(Spec("rhino_free", "newton,lm_schur,pdm,gim"));
  ASSERT_EQ(result.rows.size(), 4u);
  for (int k = 0; k < 3; ++k) ASSERT_TRUE(result.rows[k].basin.has_value()) << k;
  EXPECT_FALSE(result.rows[3].basin.has_value());  // skipped
  double least = std::numeric_limits<double>::infinity();
  for (int a = 0; a < 3; ++a) {
    const ComparisonRow& row = result.rows[a];
    least = std::min(least, row.report.energy_at_foot_points);
    for (int b = 0; b < 3; ++b) {
      const ComparisonRow& other = result.rows[b];
      const double larger =
          std::max(row.report.energy_at_foot_points, other.report.energy_at_foot_points);
      const double apart =
          std::abs(row.report.energy_at_foot_points - other.report.energy_at_foot_points);
      EXPECT_EQ(row.basin == other.basin, apart < 1e-4 * larger) << row.solver << other.solver;
    }
  }
  for (int a = 0; a < 3; ++a) {
    const bool is_best = result.rows[a].report.energy_at_foot_points < (1.0 + 1e-4) * least;
    EXPECT_EQ(result.rows[a].basin == 1, is_best) << result.rows[a].solver;
  }
  EXPECT_THAT(ComparisonText(result), HasSubstr("minima; times compare within one basin only"));
}

TEST(Compare, TellsTheMinimumOfALossThatIsNotConvex) {
  const std::string tukey = ProblemFile("tukey", 60, 9, "interpolation/loss=tukey/loss_scale=0.3");
  const ComparisonResult robust = Compared(Spec(tukey, "lbfgs,newton"));
  for (const ComparisonRow& row : robust.rows) EXPECT_TRUE(row.basin.has_value()) << row.solver;
  const std::string huber = ProblemFile("huber", 60, 9, "interpolation/loss=huber/loss_scale=0.3");
  const ComparisonResult convex = Compared(Spec(huber, "lbfgs,newton"));
  for (const ComparisonRow& row : convex.rows) EXPECT_FALSE(row.basin.has_value()) << row.solver;
}

TEST(Compare, ShowsNoColumnInWhichNoRowHasANumber) {
  const std::string fixed = ComparisonText(Compared(Spec("rhino", "cg")));
  EXPECT_THAT(fixed, HasSubstr("to direct"));
  EXPECT_THAT(fixed, Not(HasSubstr("basin")));
  const std::string free = ComparisonText(Compared(Spec("rhino_free", "newton")));
  EXPECT_THAT(free, Not(HasSubstr("to direct")));
  EXPECT_THAT(free, HasSubstr("  basin  length"));
}

TEST(Compare, StopsWhenInterrupted) {
  // In a process of its own: an interrupt is never taken back.
  const auto compare = [] {
    RequestInterrupt();
    ComparisonResult result;
    std::string error;
    const bool ok = Compare(Spec("rhino", "cg"), &result, &error);
    std::_Exit(ok && result.interrupted && result.rows.empty() ? 0 : 1);
  };
  EXPECT_EXIT(compare(), testing::ExitedWithCode(0), "");
}

TEST(Median, IsTheMiddleOne) {
  EXPECT_EQ(Median({3.0}), 3.0);
  EXPECT_EQ(Median({9.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(Median({9.0, 1.0, 2.0, 4.0}), 3.0);
  EXPECT_TRUE(std::isnan(Median({})));
}

}  // namespace
}  // namespace batten
