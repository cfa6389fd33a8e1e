// Guards against loops, and projected fits, through every solver that takes them.
#include <gtest/gtest.h>

#include "experiments/fit_report.h"
#include "experiments/run.h"
#include "tests/experiments/outlines.h"
#include "tests/solvers/test_fits.h"

namespace batten {
namespace {

FitReport Report(const Problem& problem, const std::string& solver, int iterations = 3000) {
  RunSpec spec;
  spec.max_iterations = iterations;
  return MeasureFit(problem, RunSolver(problem, solver, spec), spec);
}

constexpr const char* kSolvers[] = {"lbfgs",    "ceres_lbfgs", "ceres_lm", "newton", "foot_newton",
                                    "lm_schur", "varpro",      "pdm",      "tdm",    "sdm"};

struct Outline {
  const char* file;
  bool closed;
  double length;  // of the polygon through the data
};
constexpr Outline kRhino = {"animals/rhino_100.csv", true, 495.0};
constexpr Outline kDolphin = {"animals/dolphin_80.csv", true, 1773.0};
constexpr Outline kRiver = {"coasts/river_marne_open.csv", false, 363'610.0};

FitSpec OutlineSpec(const Outline& outline) {
  return MakeFreeSpec(3, outline.closed, 20, outline.closed ? "circle" : "data");
}

TEST(Guards, AreNeededOnTheseOutlines) {
  for (const Outline& outline : {kRhino, kDolphin, kRiver}) {
    const auto problem = MakeFileFit(outline.file, OutlineSpec(outline));
    const FitReport loose = Report(*problem, "foot_newton");
    ASSERT_TRUE(loose.shape.has_value());
    EXPECT_GT(loose.shape->num_free_loops, 0) << outline.file;
    EXPECT_GT(loose.shape->length, 1.3 * outline.length) << outline.file;
  }
}

/// Loops and length of what `solver` makes of the outline with a guard.
CurveShape GuardedShape(const Outline& outline, const char* guard, const char* solver) {
  FitSpec spec = OutlineSpec(outline);
  spec.guard = NameSpec{guard, {}, nullptr};
  const FitReport report = Report(*MakeFileFit(outline.file, spec), solver, 1000);
  EXPECT_TRUE(report.shape.has_value());
  return report.shape.value_or(CurveShape());
}

void ExpectNoLoops(const Outline& outline) {
  for (const char* guard : {"length", "bending"}) {
    for (const char* solver : kSolvers) {
      const CurveShape shape = GuardedShape(outline, guard, solver);
      EXPECT_EQ(shape.num_free_loops, 0) << guard << " " << solver;
      EXPECT_LT(shape.length, 1.12 * outline.length) << guard << " " << solver;
    }
  }
}

TEST(Guards, LeaveNoLoopWhateverTheSolver) { ExpectNoLoops(kRhino); }

TEST(Guards, LeaveNoLoopOfAnOpenCurveEither) { ExpectNoLoops(kRiver); }

TEST(Guards, AreLightSoThatABadMinimumMayKeepASmallLoop) {
  // As docs/constraints.md says: the dolphin's fins lead some methods to minima with folds.
  for (const char* solver : kSolvers) {
    const CurveShape shortened = GuardedShape(kDolphin, "length", solver);
    EXPECT_LE(shortened.num_free_loops, std::string(solver) == "varpro" ? 2 : 0) << solver;
    EXPECT_LT(shortened.length, 1.5 * kDolphin.length) << solver;
    const CurveShape bent = GuardedShape(kDolphin, "bending", solver);
    EXPECT_LE(bent.num_free_loops, 2) << solver;
    EXPECT_LT(bent.longest_free_arc, 0.25 * kDolphin.length) << solver;
    EXPECT_LT(bent.length, 1.5 * kDolphin.length) << solver;
  }
  EXPECT_EQ(GuardedShape(kDolphin, "bending", "foot_newton").num_free_loops, 0);
}

TEST(Guards, AreNoPartOfTheEnergyAtFootPoints) {
  FitSpec spec = MakeFreeSpec(3, true, 12, "circle", "free_parameter/weight=4");
  spec.guard = NameSpec{"length", {}, nullptr};
  const auto problem = MakeFileFit("animals/rhino_100.csv", spec);
  const RunResult run = RunSolver(*problem, "newton");
  const FitReport report = MeasureFit(*problem, run, {});
  // The root mean square knows no weights: of 100 points that weigh 4 each.
  const double expected = 4.0 * 100.0 * report.rms_orthogonal * report.rms_orthogonal;
  EXPECT_NEAR(report.energy_at_foot_points, expected, 1e-12 * expected);
}

TEST(FreeFits, OfOpenCurvesClaimNoMinimumPastTheirEnds) {
  // Points that go on past where the curve from a circle ends.
  for (const int n : {5, 6, 7, 9}) {
    DataSet data = MakeNoisyBean(40, 2, 660);
    data.weights.reset();
    for (const char* start : {"data", "circle"}) {
      const auto problem = MakeFit(data, MakeFreeSpec(3, false, n, start));
      const FitReport report = Report(*problem, "lbfgs", 2000);
      EXPECT_TRUE(report.verdict.holds) << n << start << report.verdict.failure;
    }
  }
}

TEST(ProjectedFits, AreAuditedAtTheirFeet) {
  const auto problem = MakeFileFit("animals/rhino_100.csv", MakeProjectedSpec(3, true, 12));
  for (const char* solver : {"lbfgs", "newton", "lm_schur", "pdm"}) {
    const FitReport report = Report(*problem, solver, 50);
    EXPECT_TRUE(report.audited && report.verdict.holds) << solver << report.verdict.failure;
    EXPECT_NEAR(report.rms, report.rms_orthogonal, 1e-12 * report.rms);
  }
}

TEST(ProjectedFits, FailTheAuditAwayFromTheirFeet) {
  // A square as a curve of degree 1, one point beside the middle of its lower side.
  AuditedFit fit;
  fit.degree = 1;
  fit.periodic = true;
  fit.dimension = 2;
  fit.knots = {-1, 0, 1, 2, 3, 4, 5};
  fit.control_points = {1, 0, 1, 1, 0, 1, 0, 0};
  fit.points = {0.5, -0.25};
  fit.at_foot_points = true;
  Claim claim;
  claim.energy = 0.0625;
  fit.parameters = {0.5};
  for (const double t : {0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5}) {
    fit.parameters = {t};
    const AuditReport report = Audit(fit);
    const bool is_foot = report.foot_excess <= report.foot_allowed;
    EXPECT_EQ(is_foot, std::abs(report.energy - 0.0625) < 1e-12) << t << " " << report.energy;
    claim.energy = report.energy;
    claim.gradient_norm = report.gradient_norm;
    EXPECT_EQ(Verify(claim, report).holds, is_foot);
  }
}

}  // namespace
}  // namespace batten
