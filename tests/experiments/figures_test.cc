#include "experiments/figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "experiments/figure_panels.h"
#include "problems/fit_problem.h"

namespace batten {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// An empty folder of its own.
fs::path Folder(const std::string& name) {
  const fs::path folder = fs::path(testing::TempDir()) / ("batten figures " + name);
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

std::string Contents(const fs::path& path) {
  std::ifstream stream(path);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// The lines of a data file that are not comments, block by block.
std::vector<std::vector<std::string>> Blocks(const fs::path& path) {
  std::vector<std::vector<std::string>> blocks(1);
  std::istringstream stream(Contents(path));
  std::string line;
  while (std::getline(stream, line)) {
    if (line.empty() && !blocks.back().empty()) blocks.emplace_back();
    if (!line.empty() && line[0] != '#') blocks.back().push_back(line);
  }
  return blocks;
}

struct Fit {
  std::unique_ptr<Problem> problem;
  RunResult run;
};

/// A wave in `dimension` coordinates, fitted.
Fit MakeFit(int dimension, bool closed, const std::string& name = "wave") {
  DataSet data;
  data.name = name;
  data.points.resize(30, dimension);
  for (int i = 0; i < 30; ++i) {
    for (int c = 0; c < dimension; ++c) data.points(i, c) = std::cos(0.2 * i + c) + 10 * c;
  }
  FitSpec spec;
  spec.closed = closed;
  spec.control_points = 9;
  std::string error;
  Fit fit;
  fit.problem = MakeFitProblem(data, spec, &error);
  EXPECT_NE(fit.problem, nullptr) << error;
  NameSpec solver;
  solver.name = "banded_qr";
  EXPECT_TRUE(Run(*fit.problem, solver, {}, &fit.run, &error)) << error;
  return fit;
}

/// Without gnuplot there is no picture to look at: the tests below then look at what is left.
bool HasGnuplot() { return std::system("gnuplot --version > /dev/null 2>&1") == 0; }

void ExpectDrawn(const FigureResult& result, const std::string& stem) {
  EXPECT_TRUE(result.written) << result.message;
  EXPECT_TRUE(fs::exists(stem + ".dat"));
  EXPECT_TRUE(fs::exists(stem + ".gp"));
  if (!HasGnuplot()) GTEST_SKIP() << "no gnuplot";
  EXPECT_TRUE(result.drawn) << result.message;
  EXPECT_EQ(result.message, "");
  EXPECT_THAT(Contents(stem + ".svg"), StartsWith("<?xml"));
  EXPECT_THAT(Contents(stem + ".svg"), HasSubstr("</svg>"));
}

TEST(FitFigure, HoldsDataControlPolygonAndCurve) {
  const Fit fit = MakeFit(2, true);
  const std::string stem = Folder("blocks") / "wave";
  ExpectDrawn(FitFigure(*fit.problem, fit.run, stem), stem);
  const auto blocks = Blocks(stem + ".dat");
  ASSERT_EQ(blocks.size(), 3u);
  EXPECT_EQ(blocks[0].size(), 30u);
  EXPECT_EQ(blocks[1].size(), 9u + 1u);  // closed
  EXPECT_EQ(blocks[1].front(), blocks[1].back());
  EXPECT_EQ(blocks[2].front(), blocks[2].back());
  EXPECT_THAT(Contents(stem + ".dat"), StartsWith("# data\n# x y\n"));
  EXPECT_THAT(Contents(stem + ".gp"), HasSubstr("wave: 30 points, 9 control points, banded_qr"));
}

TEST(FitFigure, DrawsEveryDimension) {
  for (int dimension = 1; dimension <= 4; ++dimension) {
    for (const bool closed : {false, true}) {
      const Fit fit = MakeFit(dimension, closed);
      const std::string stem = Folder("dimensions") / "wave";
      ExpectDrawn(FitFigure(*fit.problem, fit.run, stem), stem);
    }
  }
}

TEST(FitFigure, ScriptDrawsTheSamePictureAgain) {
  if (!HasGnuplot()) GTEST_SKIP() << "no gnuplot";
  const Fit fit = MakeFit(3, false);
  const fs::path folder = Folder("again");
  FitFigure(*fit.problem, fit.run, folder / "wave");
  const std::string before = Contents(folder / "wave.svg");
  const fs::path moved = Folder("again, moved");
  fs::copy(folder / "wave.dat", moved / "wave.dat");
  fs::copy(folder / "wave.gp", moved / "wave.gp");
  ASSERT_EQ(std::system(("cd '" + moved.string() + "' && gnuplot wave.gp").c_str()), 0);
  EXPECT_EQ(Contents(moved / "wave.svg"), before);
}

TEST(FitFigure, TakesAnyFileName) {
  const Fit fit = MakeFit(2, false, "it's `a` \"name\" @x $y {z}");
  const fs::path folder = Folder("na'mes \"and\" $(more)");
  for (const char* name :
       {"a b", "it's", "\"quoted\"", "`touch x`", "< ls", "| ls", "-e x", "$HOME", "a\\b", "a;b"}) {
    const std::string stem = folder / name;
    ExpectDrawn(FitFigure(*fit.problem, fit.run, stem), stem);
  }
  EXPECT_FALSE(fs::exists(folder / "x"));
}

TEST(FitFigure, KeepsDataAndScriptWithoutGnuplot) {
  const Fit fit = MakeFit(2, false);
  const std::string stem = Folder("missing") / "wave";
  const std::string path = std::getenv("PATH");
  setenv("PATH", "/nowhere", 1);
  const FigureResult result = FitFigure(*fit.problem, fit.run, stem);
  setenv("PATH", path.c_str(), 1);
  EXPECT_TRUE(result.written);
  EXPECT_FALSE(result.drawn);
  EXPECT_EQ(result.message, "gnuplot is not on PATH (Debian: gnuplot-nox); " + stem +
                                ".gp and its data are there to draw " + stem + ".svg with");
  EXPECT_TRUE(fs::exists(stem + ".dat"));
  EXPECT_TRUE(fs::exists(stem + ".gp"));
  EXPECT_FALSE(fs::exists(stem + ".svg"));
}

TEST(FitFigure, SaysWhereItCannotWrite) {
  const Fit fit = MakeFit(2, false);
  const FigureResult result =
      FitFigure(*fit.problem, fit.run, Folder("none") / "no folder" / "wave");
  EXPECT_FALSE(result.written);
  EXPECT_THAT(result.message, HasSubstr("cannot write"));
}

TEST(FitFigure, RefusesACurveThatIsNone) {
  Fit fit = MakeFit(2, false);
  fit.run.x[0] = kNan;
  const std::string stem = Folder("nan") / "wave";
  const FigureResult result = FitFigure(*fit.problem, fit.run, stem);
  EXPECT_FALSE(result.written);
  EXPECT_EQ(result.message, "wave: there is no curve to draw");
}

TEST(LayOutPanels, GivesEveryUnitTheSameLength) {
  FigurePanel wide;
  wide.horizontal = {"x", 1, -2.0, 18.0};
  wide.vertical = {"y", 2, 0.0, 3.0};
  FigurePanel tall;
  tall.horizontal = {"y", 2, 0.0, 3.0};
  tall.vertical = {"z", 3, 100.0, 110.0};
  for (const std::vector<FigurePanel>& panels :
       {std::vector<FigurePanel>{wide}, {tall}, {wide, tall, wide}}) {
    const FigureCanvas canvas = LayOutPanels(panels, true);
    const double scale = canvas.panels[0].width / canvas.panels[0].horizontal.length();
    for (const FigurePanel& panel : canvas.panels) {
      // Sides are rounded to pixels.
      EXPECT_NEAR(panel.width, scale * panel.horizontal.length(), 4.0);
      EXPECT_NEAR(panel.height, scale * panel.vertical.length(), 4.0);
      EXPECT_LT(panel.left + panel.width, canvas.width);
      EXPECT_LT(panel.bottom + panel.height, canvas.height);
    }
  }
}

TEST(TickStep, IsRoundAndWideEnough) {
  EXPECT_DOUBLE_EQ(TickStep(10.0, 100, 10), 1.0);
  EXPECT_DOUBLE_EQ(TickStep(10.1, 100, 10), 2.0);
  EXPECT_DOUBLE_EQ(TickStep(0.03, 100, 10), 0.005);
  EXPECT_DOUBLE_EQ(TickStep(7e5, 100, 10), 1e5);
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
  ExpectDrawn(ConvergenceFigure({&fast, &skipped, &slow}, stem), stem);
  const auto blocks = Blocks(stem + ".dat");
  ASSERT_EQ(blocks.size(), 2u);
  EXPECT_EQ(blocks[0].size(), 13u);
  EXPECT_EQ(blocks[1].size(), 701u);
  EXPECT_EQ(blocks[0][0], "0 2 1 1 0");
  EXPECT_THAT(blocks[0][12], HasSubstr(" ? "));
  const std::string script = Contents(stem + ".gp");
  EXPECT_THAT(script, HasSubstr("title 'it''s_slow'"));
  EXPECT_THAT(script, HasSubstr("'wave: E - E*'"));
}

TEST(ConvergenceFigure, ShowsTheEnergyWhereNoMinimumIsKnown) {
  ComparisonRow row = TracedRow("ceres_lm", 5);
  row.excess_energies.assign(row.excess_energies.size(), kNan);
  const std::string stem = Folder("energy") / "wave";
  ExpectDrawn(ConvergenceFigure({&row}, stem), stem);
  EXPECT_THAT(Contents(stem + ".gp"), HasSubstr("'wave: E'"));
  EXPECT_THAT(Contents(stem + ".dat"), Not(HasSubstr("nan")));
}

TEST(ConvergenceFigure, DrawsManySolvers) {
  std::vector<ComparisonRow> rows;
  for (int k = 0; k < 20; ++k) rows.push_back(TracedRow("solver" + std::to_string(k), 1 + 40 * k));
  std::vector<const ComparisonRow*> pointers;
  for (const ComparisonRow& row : rows) pointers.push_back(&row);
  const std::string stem = Folder("many") / "wave";
  ExpectDrawn(ConvergenceFigure(pointers, stem), stem);
}

TEST(ConvergenceFigure, DrawsARunThatBeganAtTheMinimum) {
  ComparisonRow row = TracedRow("banded_qr", 1);
  row.excess_energies.assign(2, 0.0);
  for (TraceRow& at : row.run.trace) at.energy = at.gradient_norm = 0.0;
  const std::string stem = Folder("zero") / "wave";
  ExpectDrawn(ConvergenceFigure({&row}, stem), stem);
}

TEST(ConvergenceFigure, SaysThatThereIsNothingToDraw) {
  ComparisonRow row = TracedRow("lbfgs", 3);
  row.run.trace.clear();
  const FigureResult result = ConvergenceFigure({&row}, Folder("nothing") / "wave");
  EXPECT_FALSE(result.written);
  EXPECT_EQ(result.message, "there is no trace to draw");
}

TEST(GnuplotString, QuotesWhatEndsAString) {
  EXPECT_EQ(GnuplotString("it's \"x\" `y`"), "'it''s \"x\" `y`'");
  EXPECT_EQ(GnuplotString("a\nb"), "'a b'");
}

}  // namespace
}  // namespace batten
