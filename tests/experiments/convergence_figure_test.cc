// The figure of a comparison on one problem.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "experiments/figures.h"
#include "tests/experiments/figure_files.h"
#include "tests/not_a_number.h"

namespace batten {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

FigureResult DrawConvergence(const std::vector<const ComparisonRow*>& rows,
                             const std::string& stem) {
  return Committed([&](FileBatch* batch) { return ConvergenceFigure(rows, stem, batch); });
}

ComparisonRow TracedRow(const std::string& solver, int iterations) {
  ComparisonRow row;
  row.problem = "wave";
  row.solver = solver;
  row.run.outcome.reason = StopReason::kGradientSmall;
  row.run.iterations = iterations;
  for (int k = 0; k <= iterations; ++k) {
    TraceRow at;
    at.iteration = k;
    at.energy = 1.0 + std::exp(-k);
    at.gradient_norm = std::exp(-0.5 * k);
    row.run.trace.push_back(at);
    row.excess_energies.push_back(std::exp(-k));
  }
  return row;
}

TEST(ConvergenceFigure, HoldsOneBlockPerSolverThatRan) {
  ComparisonRow fast = TracedRow("lbfgs/memory=10", 12);
  fast.excess_energies.back() = 0.0;  // reached: nothing to show on a log scale
  const ComparisonRow slow = TracedRow("it's_slow", 700);
  ComparisonRow skipped;
  skipped.problem = "wave";
  skipped.solver = "gim";
  skipped.run.skipped = "gim needs more";
  const std::string stem = Folder("convergence") / "wave";
  ExpectDrawn(DrawConvergence({&fast, &skipped, &slow}, stem), stem);
  const auto blocks = Blocks(stem + ".dat");
  ASSERT_EQ(blocks.size(), 2u);
  EXPECT_EQ(blocks[0].size(), 13u);
  EXPECT_EQ(blocks[1].size(), 701u);
  EXPECT_EQ(blocks[0][0], "0 2 1 1 0");
  EXPECT_THAT(blocks[0][12], HasSubstr(" ? "));
  const std::string script = Contents(stem + ".gp");
  EXPECT_THAT(script, HasSubstr("title 'it''s_slow'"));
  EXPECT_THAT(script, HasSubstr("'wave: E - E*'"));
  EXPECT_THAT(script, HasSubstr("title 'lbfgs/memory=10 (E = E* at 12)'"));
}

TEST(ConvergenceFigure, CountsIterationsInWholeNumbers) {
  const ComparisonRow row = TracedRow("banded_qr", 1);
  const std::string stem = Folder("ticks") / "wave";
  ExpectDrawn(DrawConvergence({&row}, stem), stem);
  EXPECT_THAT(Contents(stem + ".gp"), HasSubstr("set xtics 1\n"));
}

TEST(ConvergenceFigure, ShowsTheEnergyWhereNoMinimumIsKnown) {
  ComparisonRow row = TracedRow("ceres_lm", 5);
  row.excess_energies.assign(row.excess_energies.size(), kNan);
  const std::string stem = Folder("energy") / "wave";
  ExpectDrawn(DrawConvergence({&row}, stem), stem);
  EXPECT_THAT(Contents(stem + ".gp"), HasSubstr("'wave: E'"));
  EXPECT_THAT(Contents(stem + ".dat"), Not(HasSubstr("nan")));
}

TEST(ConvergenceFigure, DrawsManySolvers) {
  std::vector<ComparisonRow> rows;
  for (int k = 0; k < 20; ++k) rows.push_back(TracedRow("solver" + std::to_string(k), 1 + 40 * k));
  std::vector<const ComparisonRow*> pointers;
  for (const ComparisonRow& row : rows) pointers.push_back(&row);
  const std::string stem = Folder("many") / "wave";
  ExpectDrawn(DrawConvergence(pointers, stem), stem);
}

TEST(ConvergenceFigure, DrawsARunThatBeganAtTheMinimum) {
  ComparisonRow row = TracedRow("banded_qr", 1);
  row.excess_energies.assign(2, 0.0);
  for (TraceRow& at : row.run.trace) at.energy = at.gradient_norm = 0.0;
  const std::string stem = Folder("zero") / "wave";
  ExpectDrawn(DrawConvergence({&row}, stem), stem);
  EXPECT_THAT(Contents(stem + ".gp"), HasSubstr("'0 at every iteration'"));
}

TEST(ConvergenceFigure, SaysThatThereIsNothingToDraw) {
  ComparisonRow row = TracedRow("lbfgs", 3);
  row.run.trace.clear();
  const FigureResult result = DrawConvergence({&row}, Folder("nothing") / "wave");
  EXPECT_FALSE(result.written);
  EXPECT_EQ(result.message, "there is no trace to draw");
  const fs::path folder = Folder("no more");
  for (const char* ending : {".svg", ".gp", ".dat"})
    std::ofstream(folder / (std::string("wave") + ending)) << "old";
  DrawConvergence({&row}, folder / "wave");
  EXPECT_TRUE(fs::is_empty(folder)) << "an older figure would show another run";
}

}  // namespace
}  // namespace batten
