#include "experiments/fit_plot.h"

#include "experiments/fit_lines.h"

namespace batten {
namespace {

using Style = PlotSeries::Style;

constexpr int kMostPlaces = 2000;  // as many as the page shows of a line

/// How a line is drawn.
struct Look {
  Style style;
  int color;
};

PlotSeries SeriesOf(const FitLine& line, const Look& look, int across, int up) {
  const auto column = [&line](int coordinate) {
    if (coordinate < 0) return line.t;
    const auto numbers = line.points.col(coordinate);
    return std::vector<double>(numbers.begin(), numbers.end());
  };
  PlotSeries series;
  series.label = line.name;
  series.style = look.style;
  series.color = look.color;
  series.x = column(across);
  series.y = column(up);
  return series;
}

}  // namespace

std::vector<PlotPanel> FitPanels(const Problem& problem, const RunResult& run) {
  const CurveFit* fit = problem.curve_fit();
  if (fit == nullptr || run.x.size() != problem.num_variables() || !run.x.allFinite()) return {};
  const BsplineCurve curve = fit->Curve(run.x);
  std::vector<std::pair<FitLine, Look>> lines = {
      {PolygonLine(*fit, run.x), {Style::kLinePoints, 2}},
      {CurveLine(curve, kMostPlaces), {Style::kLine, 1}},
      {DataLine(*fit, run.x, 1), {Style::kPoints, 0}},
  };
  if (!fit->spec().given_knots.empty()) {
    lines.push_back({KnotLine(curve), {Style::kCircles, 3}});
  }
  constexpr char kNames[] = "txyzw";
  std::vector<PlotPanel> panels;
  for (const auto& [across, up] : AxisPairs(fit->dimension())) {
    PlotPanel panel;
    panel.x_label = kNames[across + 1];
    panel.y_label = kNames[up + 1];
    panel.equal_scale = across >= 0;
    for (const auto& [line, look] : lines) {
      panel.series.push_back(SeriesOf(line, look, across, up));
    }
    panels.push_back(std::move(panel));
  }
  panels.front().title = problem.name() + ", " + run.solver.ToString();
  return panels;
}

}  // namespace batten
