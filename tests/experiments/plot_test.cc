#include <gmock/gmock.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "experiments/plot_file.h"
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

TEST(DrawPlotForReport, WritesThePanelsWithAllTheirDigitsAndTakesThemAway) {
  const ScratchFolder folder;
  PlotPanel panel;
  panel.title = "T";
  panel.log_y = true;
  panel.x_names = {"rhino"};
  panel.series.push_back({"cg", {1.0, 2.0}, {1.0 / 3.0, std::nan("")}});
  panel.series.back().style = PlotSeries::Style::kCircles;
  panel.series.back().color = 9;
  const std::string stem = folder.path() / "a", file = stem + ".plot.json";
  const auto draw = [&](const std::vector<PlotPanel>& panels) {
    FileBatch batch;
    std::string error;
    DrawPlotForReport(stem, panels, 2, &batch);
    EXPECT_TRUE(batch.Commit(&error)) << error;
  };
  draw({panel});
  const nlohmann::json json = nlohmann::json::parse(std::ifstream(file));
  EXPECT_EQ(json["format"], "batten.plot/1");
  EXPECT_EQ(json["columns"], 2);
  const nlohmann::json shown = json["panels"][0], series = shown["series"][0];
  EXPECT_EQ(shown["log_y"], true);
  EXPECT_EQ(shown["x_names"][0], "rhino");
  EXPECT_EQ(series["style"], "circles");
  EXPECT_EQ(series["color"], 9);
  EXPECT_EQ(series["y"][0].get<double>(), 1.0 / 3.0);
  EXPECT_TRUE(series["y"][1].is_null());
  EXPECT_TRUE(std::filesystem::exists(stem + ".dat"));
  draw({});
  EXPECT_FALSE(std::filesystem::exists(file));
  EXPECT_FALSE(std::filesystem::exists(stem + ".dat"));
}

TEST(PlotSeriesStyle, HasAWordThatReadsBack) {
  std::set<std::string> words;
  for (int k = 0; k <= static_cast<int>(PlotSeries::Style::kOneOfMany); ++k) {
    const auto style = static_cast<PlotSeries::Style>(k);
    PlotSeries::Style read{};
    EXPECT_TRUE(FromString(ToString(style), &read));
    EXPECT_EQ(read, style);
    words.insert(ToString(style));
  }
  EXPECT_EQ(words.size(), 6u);
  PlotSeries::Style unused{};
  EXPECT_FALSE(FromString("dots", &unused));
}

}  // namespace
}  // namespace batten
