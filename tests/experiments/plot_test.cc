#include "experiments/plot.h"

#include <gmock/gmock.h>

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

}  // namespace
}  // namespace batten
