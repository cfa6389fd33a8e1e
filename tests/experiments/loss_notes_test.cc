#include "experiments/loss_notes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/experiments/outlines.h"
#include "tests/solvers/test_fits.h"
#include "tests/solvers/thrown_points.h"

namespace batten {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;

using Notes = std::vector<std::pair<std::string, std::string>>;

Notes NotesOn(const Problem& problem, const std::string& solver, const RunSpec& spec = {}) {
  RunResult run = RunSolver(problem, solver, spec);
  run.notes.clear();
  NoteLosses(problem, &run);
  return run.notes;
}

TEST(LossNotes, SayNothingOfATenthOfOutliers) {
  const ThrownPoints thrown(21, true);
  for (const char* loss : {"huber", "tukey", "cauchy"}) {
    const auto problem = thrown.Fit("interpolation/loss=" + std::string(loss) + "/loss_scale=mad");
    for (const char* solver : {"irls:banded_qr", "lbfgs", "newton"}) {
      EXPECT_THAT(NotesOn(*problem, solver), IsEmpty()) << solver << " " << loss;
    }
  }
  EXPECT_THAT(NotesOn(*thrown.Fit("interpolation"), "lbfgs"), IsEmpty());
}

TEST(LossNotes, TellOfACurveThatLeavesItsData) {
  // Few points off the fit make a small scale, beside which the fairing term is heavy.
  FitSpec spec =
      MakeSpec(3, false, 40, "interpolation/loss=tukey/loss_scale=mad,fairing/weight=1e-8");
  spec.parameters = Parameterization::kChordLength;
  const auto problem = MakeFileFit("airfoils/naca2412_open.csv", spec);
  EXPECT_THAT(
      NotesOn(*problem, "irls:banded_qr"),
      Contains(Pair("rejected points", AllOf(HasSubstr(" of 160 residuals"), HasSubstr("tukey")))));
}

TEST(LossNotes, TellOfControlPointsThatNothingHolds) {
  // A stretch of points that are thrown away: the control points there have no others.
  const DataSet clean = ThrownPoints(22, false).data;
  FitSpec spec = MakeSpec(3, true, 20, "interpolation/loss=tukey/loss_scale=0.02");
  spec.parameters = Parameterization::kUniform;
  const auto plain = MakeFit(clean, spec);
  spec.start_points = plain->curve_fit()->ControlPoints(RunSolver(*plain, "irls:banded_qr").x);
  DataSet data = clean;
  for (int i = 50; i < 90; ++i) data.points.row(i) << 4.0, 0.01 * i;
  EXPECT_THAT(NotesOn(*MakeFit(data, spec), "lbfgs"),
              Contains(Pair("rejected points", HasSubstr("less than a thousandth"))));
}

TEST(LossNotes, TellHowFarAHeavyTermLetsARunEndFromTheMinimum) {
  const auto fit = [](const std::string& weight) {
    const ThrownPoints thrown(23, true);
    return thrown.Fit("interpolation/loss=huber/loss_scale=0.01,fairing/weight=" + weight);
  };
  EXPECT_THAT(NotesOn(*fit("1e-4"), "irls:banded_qr"), IsEmpty());
  EXPECT_THAT(NotesOn(*fit("1e6"), "newton"),
              Contains(Pair("far from the minimum", HasSubstr("a step of irls:banded_qr"))));
}

}  // namespace
}  // namespace batten
