#include "experiments/end_notes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/experiments/outlines.h"
#include "tests/solvers/test_fits.h"

namespace batten {
namespace {

std::vector<std::string> NamesOfNotes(const RunResult& result) {
  std::vector<std::string> names;
  for (const auto& [name, text] : result.notes) names.push_back(name);
  return names;
}

/// Distance of run->x from the direct answer, over the data's size, and whether a note tells it.
double NotedDistance(const Problem& problem, const std::string& solver, bool* noted) {
  RunResult run = RunSolver(problem, solver);
  EXPECT_TRUE(IsSuccess(run.outcome.reason)) << solver;
  NoteDistanceFromMinimum(problem, &run);
  const std::vector<std::string> names = NamesOfNotes(run);
  *noted = std::count(names.begin(), names.end(), "far from the minimum") > 0;
  const RunResult direct = RunSolver(problem, "banded_qr");
  const CurveFit& fit = *problem.curve_fit();
  const Points off = fit.ControlPoints(run.x) - fit.ControlPoints(direct.x);
  return off.rowwise().norm().maxCoeff() / fit.size();
}

TEST(EndNotes, SaysHowFarFromTheMinimumAHeavyTermLetsItEnd) {
  for (const auto& [weight, is_heavy] : {std::pair("1e-3", false), {"1e8", true}}) {
    const auto problem =
        MakeFit(MakeNoisyLoop(40, 2, 11),
                MakeSpec(3, false, 20, std::string("interpolation,fairing/weight=") + weight));
    for (const char* solver : {"newton", "cg", "ceres_lm", "banded_cholesky"}) {
      bool noted = false;
      const double distance = NotedDistance(*problem, solver, &noted);
      EXPECT_EQ(distance > 1e-6, is_heavy) << solver << " " << weight << " " << distance;
      EXPECT_EQ(noted, is_heavy) << solver << " " << weight;
    }
  }
}

TEST(EndNotes, SaysWhereTheRuleOfCurveFairingMissesBends) {
  for (const auto& [points, is_missed] : {std::pair("1", true), {"32", false}}) {
    const auto problem =
        MakeFit(MakeNoisyLoop(40, 2, 11),
                MakeSpec(3, true, 9,
                         std::string("interpolation,curve_fairing/weight=1e-3/points=") + points));
    RunResult run = RunSolver(*problem, "lbfgs");
    NoteErrorsOfRules(*problem, MeasureFairness(problem->curve_fit()->Curve(run.x)), &run);
    const std::vector<std::string> names = NamesOfNotes(run);
    EXPECT_EQ(std::count(names.begin(), names.end(), "curve_fairing"), is_missed ? 1 : 0) << points;
  }
}

TEST(EndNotes, SaysThatSmallStepsMayLeadToALimitOfTheirOwn) {
  const auto rhino = LoadCatalogueProblem("rhino");
  RunSpec spec;
  spec.mode = Mode::kNative;
  RunResult run = RunSolver(*rhino, "extended_pia", spec);
  EXPECT_EQ(run.outcome.reason, StopReason::kStepSmall);
  NoteDistanceFromMinimum(*rhino, &run);
  ASSERT_FALSE(run.notes.empty());
  EXPECT_EQ(run.notes.back().first, "far from the minimum");
  EXPECT_THAT(run.notes.back().second, ::testing::HasSubstr("hardly move"));
}

}  // namespace
}  // namespace batten
