// curve_fairing from starts that have a cusp, or nearly so, where its integrand has no bound.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/solvers/contract_cases.h"

namespace batten {
namespace {

// Of three points a span the second is its middle.
constexpr const char* kMeasures[] = {"bending/weight=1e-3", "bending/weight=1e-3/points=3",
                                     "variation/weight=1e-6", "variation/weight=1e-6/points=3"};

/// One cubic piece in Bezier form: with `off` = 0 it has a cusp in the middle of its domain
/// (C' = 0), with more of it a tight bend; the data lie on a parabola.
std::unique_ptr<Problem> FromACusp(double off, const std::string& fairing, bool is_free) {
  DataSet data;
  data.points.resize(20, 2);
  for (int i = 0; i < 20; ++i) {
    const double x = i / 19.0;
    data.points.row(i) << x, 2.0 * x * (1.0 - x);
  }
  const std::string terms =
      (is_free ? "free_parameter,curve_fairing/measure=" : "interpolation,curve_fairing/measure=") +
      fairing;
  FitSpec spec = is_free ? MakeFreeSpec(3, false, 4, "data", terms) : MakeSpec(3, false, 4, terms);
  spec.start_points.resize(4, 2);
  spec.start_points << 0.0, 0.0, 1.0 - off, 1.0, off, 1.0, 1.0, 0.0;
  return MakeFit(data, spec);
}

bool IsFreeOnly(const std::string& solver) { return solver == "lm_schur"; }

TEST(NearCusps, OfStartsLeadToAFiniteEndThatIsNoWorse) {
  for (const char* solver : {"lbfgs", "newton", "lm_schur", "ceres_lm"}) {
    for (const char* measure : kMeasures) {
      for (const double off : {1e-3, 1e-6, 1e-9, 1e-12}) {
        SCOPED_TRACE(std::string(solver) + " " + measure + " " + std::to_string(off));
        const auto problem = FromACusp(off, measure, IsFreeOnly(solver));
        SolverTrial trial(*problem, solver, {2000, 1e-10});
        ASSERT_TRUE(trial.x.allFinite());
        for (const Eigen::VectorXd& x : trial.context.iterates()) ASSERT_TRUE(x.allFinite());
        const double start = trial.context.Energy(StartOf(*problem));
        const double end = trial.context.Energy(trial.x);
        ASSERT_TRUE(std::isfinite(start));
        ASSERT_TRUE(std::isfinite(end));
        EXPECT_LE(end, start);
        RecordProperty(std::string(solver) + " " + measure + " " + std::to_string(off),
                       std::string(ToString(trial.outcome.reason)) + " " + NumberText(start) + " " +
                           NumberText(end));
        EXPECT_TRUE(IsSuccess(trial.outcome.reason) || !trial.outcome.message.empty() ||
                    trial.outcome.reason == StopReason::kIterationLimit)
            << ToString(trial.outcome.reason);
      }
    }
  }
}

TEST(NearCusps, AtAPointOfTheRuleEndInOneSentence) {
  for (const char* solver : {"lbfgs", "newton", "lm_schur", "ceres_lm"}) {
    for (const char* measure : {"bending/points=3", "variation/points=3"}) {
      SCOPED_TRACE(std::string(solver) + " " + measure);
      const auto problem = FromACusp(0.0, measure, IsFreeOnly(solver));
      SolverTrial trial(*problem, solver, {100});
      EXPECT_EQ(trial.outcome.reason, StopReason::kNumericalFailure)
          << ToString(trial.outcome.reason);
      EXPECT_TRUE(SameBits(trial.x, StartOf(*problem)));
      EXPECT_LE(trial.context.evaluations().size(), 10U);
    }
  }
}

}  // namespace
}  // namespace batten
