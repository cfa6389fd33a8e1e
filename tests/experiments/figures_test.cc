#include "experiments/figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "experiments/fit_plot.h"
#include "problems/fit_problem.h"
#include "tests/experiments/figure_files.h"
#include "tests/not_a_number.h"

namespace batten {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

struct Fit {
  std::unique_ptr<Problem> problem;
  RunResult run;
};

FigureResult DrawFit(const Fit& fit, const std::string& stem) {
  return Committed([&](FileBatch* batch) { return FitFigure(*fit.problem, fit.run, stem, batch); });
}

/// A wave in `dimension` coordinates, fitted.
Fit MakeFit(int dimension, bool closed, const std::string& name = "wave", int num_points = 30) {
  DataSet data;
  data.name = name;
  data.points.resize(num_points, dimension);
  for (int i = 0; i < num_points; ++i) {
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

TEST(FitFigure, HoldsDataControlPolygonAndCurve) {
  const Fit fit = MakeFit(2, true);
  const std::string stem = Folder("blocks") / "wave";
  ExpectDrawn(DrawFit(fit, stem), stem);
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
      ExpectDrawn(DrawFit(fit, stem), stem);
    }
  }
}

TEST(FitFigure, ShowsPolygonAndCurveAboveDenseData) {
  const auto order = [](const std::string& script) {
    std::string indices;
    for (size_t at = script.find("index "); at < script.size();
         at = script.find("index ", at + 1)) {
      indices += script[at + 6];
    }
    return indices;
  };
  const std::string stem = Folder("dense") / "wave";
  DrawFit(MakeFit(2, false), stem);
  EXPECT_EQ(order(Contents(stem + ".gp")), "120") << "few points are drawn last";
  DrawFit(MakeFit(2, false, "wave", 10000), stem);
  EXPECT_EQ(order(Contents(stem + ".gp")), "012");
  EXPECT_EQ(Blocks(stem + ".dat")[0].size(), 3334u);  // every third, the first included
  EXPECT_THAT(Contents(stem + ".gp"), HasSubstr("data (1 in 3)"));
}

TEST(FitFigure, ShortensALongNameInTheTitle) {
  const std::string stem = Folder("long") / "wave";
  DrawFit(MakeFit(2, false, std::string(300, 'a') + "\xFF"), stem);
  const std::string script = Contents(stem + ".gp");
  const size_t begin = script.find("set label 1 '") + 13;
  const std::string title = script.substr(begin, script.find('\'', begin) - begin);
  EXPECT_THAT(title, StartsWith("aaaaaaaaaaaa"));
  EXPECT_THAT(title, HasSubstr("\xEF\xBF\xBD: 30 points, 9 control points, banded_qr"));
  EXPECT_LT(title.size(), 100u);
}

TEST(FitFigure, ScriptDrawsTheSamePictureAgain) {
  if (!HasGnuplot()) GTEST_SKIP() << "no gnuplot";
  const Fit fit = MakeFit(3, false);
  const fs::path folder = Folder("again");
  DrawFit(fit, folder / "wave");
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
    ExpectDrawn(DrawFit(fit, stem), stem);
  }
  EXPECT_FALSE(fs::exists(folder / "x"));
}

TEST(FitFigure, KeepsDataAndScriptWithoutGnuplot) {
  const Fit fit = MakeFit(2, false);
  const std::string stem = Folder("missing") / "wave";
  std::ofstream(stem + ".svg") << "of older data";
  const std::string path = std::getenv("PATH");
  setenv("PATH", "/nowhere", 1);
  const FigureResult result = DrawFit(fit, stem);
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
  const FigureResult result = DrawFit(fit, Folder("none") / "no folder" / "wave");
  EXPECT_FALSE(result.written);
  EXPECT_THAT(result.message, HasSubstr("cannot write"));
}

TEST(FitPanels, HoldDataControlPolygonAndCurveOfEveryPairOfAxes) {
  const std::vector<std::vector<std::string>> axes = {
      {"tx"}, {"xy"}, {"xy", "xz", "yz"}, {"xy", "zw"}};
  for (int d = 1; d <= 4; ++d) {
    for (const bool closed : {false, true}) {
      const Fit fit = MakeFit(d, closed);
      const std::vector<PlotPanel> panels = FitPanels(*fit.problem, fit.run);
      const auto& names = axes[static_cast<std::size_t>(d) - 1];
      ASSERT_EQ(panels.size(), names.size());
      for (std::size_t k = 0; k < panels.size(); ++k) {
        EXPECT_EQ(panels[k].x_label + panels[k].y_label, names[k]);
        EXPECT_EQ(panels[k].equal_scale, d > 1);
        ASSERT_EQ(panels[k].series.size(), 3u);
        EXPECT_EQ(panels[k].series[0].x.size(), closed && d > 1 ? 10u : 9u);
        EXPECT_EQ(panels[k].series[2].label, "data");
        EXPECT_EQ(panels[k].series[2].y.size(), 30u);
      }
      // The last panel's vertical axis is the last coordinate.
      const PlotPanel& last = panels.back();
      EXPECT_EQ(last.series[2].y.back(), std::cos(0.2 * 29 + d - 1) + 10 * (d - 1));
      const PlotSeries& curve = last.series[1];
      ASSERT_EQ(curve.x.size(), curve.y.size());
      const double gap = curve.y.front() - curve.y.back();
      EXPECT_EQ(std::abs(gap) < 1e-12 * 40, closed);
    }
  }
}

TEST(FitFigure, RefusesACurveThatIsNone) {
  Fit fit = MakeFit(2, false);
  fit.run.x[0] = kNan;
  const std::string stem = Folder("nan") / "wave";
  const FigureResult result = DrawFit(fit, stem);
  EXPECT_FALSE(result.written);
  EXPECT_EQ(result.message, "wave: there is no curve to draw");
  EXPECT_TRUE(FitPanels(*fit.problem, fit.run).empty());
}

}  // namespace
}  // namespace batten
