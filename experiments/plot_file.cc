#include "experiments/plot_file.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace batten {
namespace {

using Json = nlohmann::ordered_json;  // writes NaN and infinity as null

struct StyleWord {
  PlotSeries::Style style;
  const char* word;
};
constexpr StyleWord kStyleWords[] = {{PlotSeries::Style::kLine, "line"},
                                     {PlotSeries::Style::kPoints, "points"},
                                     {PlotSeries::Style::kLinePoints, "line_points"},
                                     {PlotSeries::Style::kDashed, "dashed"},
                                     {PlotSeries::Style::kCircles, "circles"},
                                     {PlotSeries::Style::kOneOfMany, "one_of_many"}};

Json SeriesJson(const PlotSeries& series) {
  // Edited tables can leave one side shorter.
  const std::size_t count = std::min(series.x.size(), series.y.size());
  const auto first = [count](const std::vector<double>& numbers) {
    return Json(
        std::vector<double>(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(count)));
  };
  Json json = {{"label", series.label},
               {"style", ToString(series.style)},
               {"color", series.color},
               {"x", first(series.x)},
               {"y", first(series.y)}};
  if (!series.mark_x.empty()) {
    json["mark_x"] = series.mark_x;
    json["mark_y"] = series.mark_y;
  }
  return json;
}

}  // namespace

const char* ToString(PlotSeries::Style style) {
  const auto* const found = std::find_if(std::begin(kStyleWords), std::end(kStyleWords),
                                         [style](const StyleWord& w) { return w.style == style; });
  return found->word;
}

bool FromString(const std::string& text, PlotSeries::Style* style) {
  const auto* const found = std::find_if(std::begin(kStyleWords), std::end(kStyleWords),
                                         [&text](const StyleWord& w) { return text == w.word; });
  if (found == std::end(kStyleWords)) return false;
  *style = found->style;
  return true;
}

std::string PlotJson(const std::vector<PlotPanel>& panels, int columns) {
  Json json = {{"format", "batten.plot/1"}, {"columns", columns}, {"panels", Json::array()}};
  for (const PlotPanel& panel : panels) {
    Json shown = {{"title", panel.title},       {"x_label", panel.x_label},
                  {"y_label", panel.y_label},   {"log_x", panel.log_x},
                  {"log_y", panel.log_y},       {"equal_scale", panel.equal_scale},
                  {"is_share", panel.is_share}, {"legend", panel.legend},
                  {"x_names", panel.x_names},   {"series", Json::array()}};
    for (const PlotSeries& series : panel.series) shown["series"].push_back(SeriesJson(series));
    json["panels"].push_back(std::move(shown));
  }
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

FigureResult DrawPlotForReport(const std::string& stem, const std::vector<PlotPanel>& panels,
                               int columns, FileBatch* batch) {
  const std::string path = stem + ".plot.json";
  FigureResult figure =
      panels.empty() ? NoFigure(stem, "", batch) : DrawPlot(stem, panels, columns, batch);
  if (!figure.written) {
    batch->Remove(path);
    return figure;
  }
  std::string error;
  if (batch->Write(path, PlotJson(panels, columns), &error) == nullptr) {
    figure.drawn = false;
    figure.message = error;
  }
  return figure;
}

}  // namespace batten
