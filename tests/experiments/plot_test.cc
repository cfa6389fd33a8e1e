#include "experiments/plot.h"

#include <gmock/gmock.h>

#include <cstdio>
#include <fstream>
#include <set>

#include "tests/problems/scratch_folder.h"

namespace batten {
namespace {

// What stands before the title of each line's entry in the legend: its dash, mark and colour.
TEST(DrawPlot, GivesEachOfManyLinesALookOfItsOwn) {
  const ScratchFolder folder;
  PlotPanel panel;
  for (int k = 0; k < kMostOfMany; ++k) {
    PlotSeries series;
    series.label = "line_" + std::to_string(k) + "_";
    series.style = PlotSeries::Style::kOneOfMany;
    series.color = k;
    series.x = {0.0, 1.0};
    series.y = {0.0, 1.0 * k};
    series.mark_x = {0.5};
    series.mark_y = {0.5 * k};
    panel.series.push_back(series);
  }
  FileBatch batch;
  DrawPlot(folder.path() / "many", {panel}, 1, &batch);
  std::string error;
  ASSERT_TRUE(batch.Commit(&error)) << error;
  std::ifstream script(folder.path() / "many.gp");
  std::set<std::string> looks;
  int num_titles = 0;
  for (std::string line; std::getline(script, line);) {
    const std::size_t title = line.find(" title 'line_");
    if (title == std::string::npos) continue;
    ++num_titles;
    const std::size_t width = line.find("linewidth");
    looks.insert(line.substr(width, title - width));
  }
  EXPECT_EQ(num_titles, kMostOfMany);
  EXPECT_EQ(static_cast<int>(looks.size()), kMostOfMany);
}

// In gnuplot's svg a character of a margin has 9.8 pixels at 14 points.
TEST(DrawPlot, LeavesRoomForTheGraphBesideLongNames) {
  constexpr double kCharacter = 9.8;
  const ScratchFolder folder;
  for (const std::size_t length : {10, 30, 60, 90}) {
    PlotPanel panel;
    PlotSeries series;
    series.label = std::string(length, 'n');
    series.x = series.y = {1.0, 2.0};
    panel.series = {series};
    FileBatch batch;
    DrawPlot(folder.path() / "long", {panel, panel}, 2, &batch);
    std::string error;
    ASSERT_TRUE(batch.Commit(&error)) << error;
    std::ifstream script(folder.path() / "long.gp");
    double width = 0.0, left = 0.0, right = 0.0;
    for (std::string line; std::getline(script, line);) {
      sscanf(line.c_str(), "set terminal svg size %lf", &width);
      sscanf(line.c_str(), "set margins %lf, %lf", &left, &right);
    }
    EXPECT_GE(width / 2 - kCharacter * (left + right), 300.0) << length;
    // The legend's letters have 9 / 14 of the font's size, of its height 0.6 on average.
    EXPECT_GE(kCharacter * right, 9 * 0.6 * static_cast<double>(length)) << length;
  }
}

}  // namespace
}  // namespace batten
