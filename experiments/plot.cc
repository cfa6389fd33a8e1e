#include "experiments/plot.h"

#include <algorithm>
#include <cmath>

#include "cost_functions/options.h"

namespace batten {
namespace {

constexpr int kPanelWidth = 560;
constexpr int kPanelHeight = 320;
constexpr std::size_t kMostText = 90;
constexpr int kLegendLine = 17;  // pixels
constexpr int kLeftMargin = 10;  // of a graph, in characters

// Okabe & Ito, Color Universal Design, 2008, without the yellow.
constexpr const char* kColors[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                   "#56b4e9", "#e69f00", "#000000", "#888888"};

constexpr int kNumColors = static_cast<int>(std::size(kColors));
// Of each eight lines: solid, dashes, dots, dash and dot, long dashes, dash and two dots; and its
// marks as gnuplot counts them: none, disc, square, triangle, diamond, triangle on its tip.
constexpr const char* kDashes[] = {
    "1", "(10,5)", "(2.5,3.5)", "(10,4,2.5,4)", "(22,6)", "(10,4,2.5,4,2.5,4)"};
constexpr int kMarks[] = {0, 7, 5, 9, 13, 11};
static_assert(kMostOfMany == kNumColors * static_cast<int>(std::size(kDashes)));
static_assert(std::size(kDashes) == std::size(kMarks));

std::string Color(int index) {
  return std::string("'") + kColors[((index % kNumColors) + kNumColors) % kNumColors] + "'";
}

std::size_t GroupOf(const PlotSeries& series) {
  return static_cast<std::size_t>(series.color / kNumColors) % std::size(kDashes);
}

/// Behind `with lines` or `with linespoints`.
std::string LookOfMany(const PlotSeries& series) {
  const std::size_t group = GroupOf(series);
  return std::string(" linewidth 1.5 dashtype ") + kDashes[group] + " pointtype " +
         std::to_string(kMarks[group]) + " pointsize 0.7 linecolor rgb " + Color(series.color);
}

std::string StyleWords(const PlotSeries& series) {
  const std::string color = "linecolor rgb " + Color(series.color);
  switch (series.style) {
    case PlotSeries::Style::kLine:
      return "with lines linewidth 1.5 " + color;
    case PlotSeries::Style::kDashed:
      return "with lines linewidth 1.2 dashtype 2 " + color;
    case PlotSeries::Style::kOneOfMany:
      return "with lines" + LookOfMany(series);
    case PlotSeries::Style::kCircles:
      return "with points pointtype 6 pointsize 1.2 " + color;
    case PlotSeries::Style::kPoints:
      return "with points pointtype 7 pointsize 0.4 " + color;
    case PlotSeries::Style::kLinePoints:
      break;
  }
  return "with linespoints linewidth 1.5 pointtype 7 pointsize 0.4 " + color;
}

std::string Axis(const char* axis, const std::string& label, bool log) {
  const std::string name(axis);
  std::string text =
      "set " + name + "label " + GnuplotString(ShownText(label, kMostText)) + " noenhanced\n";
  if (log) text += "set logscale " + name + "\nset format " + name + " '10^{%T}'\n";
  return text;
}

std::string NamedTics(const std::vector<std::string>& names) {
  if (names.empty()) return "set xtics autofreq\nset xrange [*:*]\n";
  std::string tics;
  for (std::size_t k = 0; k < names.size(); ++k) {
    tics += (k == 0 ? "" : ", ") + GnuplotString(ShownText(names[k], kMostText)) + " " +
            std::to_string(k + 1);
  }
  return "set xtics (" + tics + ")\nset xrange [0.5:" + std::to_string(names.size()) + ".5]\n";
}

/// In characters of the plot's font: what the longest label takes in the legend's smaller one,
/// behind its line or mark.
int LegendWidth(const PlotPanel& panel) {
  std::size_t longest = 0;
  for (const PlotSeries& series : panel.series) longest = std::max(longest, series.label.size());
  constexpr double kSmaller = 0.6;
  constexpr int kMark = 6;
  const auto shown = static_cast<double>(std::min(longest, kMostText));
  return panel.legend && longest > 0 ? kMark + static_cast<int>(kSmaller * shown) : 2;
}

bool IsShown(const PlotPanel& panel, double x, double y) {
  return std::isfinite(x) && std::isfinite(y) && (!panel.log_x || x > 0.0) &&
         (!panel.log_y || y > 0.0);
}

/// What can be shown of a series, as a block of the data file.
std::string Block(const PlotPanel& panel, const std::vector<double>& x,
                  const std::vector<double>& y) {
  std::string block;
  // Edited tables can leave one side shorter.
  for (std::size_t k = 0; k < std::min(x.size(), y.size()); ++k) {
    if (IsShown(panel, x[k], y[k])) block += GnuplotNumbers({x[k], y[k]});
  }
  return block;
}

std::string Title(const PlotSeries& series) {
  if (series.label.empty()) return " notitle";
  return " title " + GnuplotString(ShownText(series.label, kMostText));
}

/// The panel's plot command; its series follow those drawn before in the data file.
std::string PanelPlot(const PlotPanel& panel, int* num_series, std::string* data) {
  std::string plot;
  const auto Add = [&](const std::string& block, const std::string& words) {
    if (!block.empty()) *data += (*num_series > 0 ? "\n\n" : "") + block;
    plot +=
        (plot.empty() ? "plot " : ", \\\n     ") +
        (block.empty() ? "NaN" : "DATA index " + std::to_string((*num_series)++) + " using 1:2") +
        " " + words;
  };
  for (const PlotSeries& series : panel.series) {
    const std::string line = Block(panel, series.x, series.y);
    if (line.empty()) continue;
    const std::string marks = Block(panel, series.mark_x, series.mark_y);
    const bool is_marked = series.style == PlotSeries::Style::kOneOfMany && GroupOf(series) > 0;
    if (!is_marked || marks.empty()) {
      Add(line, StyleWords(series) + Title(series));
      continue;
    }
    // The legend is to show line and mark together, which stand in the picture by themselves.
    Add(line, StyleWords(series) + " notitle");
    Add(marks, "with points" + LookOfMany(series) + " notitle");
    if (!series.label.empty()) Add("", "with linespoints" + LookOfMany(series) + Title(series));
  }
  return plot.empty() ? "plot NaN notitle\n" : plot + "\n";
}

/// A panel's, so that a long legend leaves room for what it explains.
int PanelWidth(const std::vector<PlotPanel>& panels) {
  constexpr int kLeastGraph = 300;
  constexpr int kCharacter = 10;  // of the plot's font, as gnuplot takes it for margins
  int legend = 0;
  for (const PlotPanel& panel : panels) legend = std::max(legend, LegendWidth(panel));
  return std::max(kPanelWidth, kLeastGraph + kCharacter * (kLeftMargin + legend));
}

/// A panel's, so that its legend is in the picture.
int PanelHeight(const std::vector<PlotPanel>& panels) {
  std::ptrdiff_t longest = 0;
  for (const PlotPanel& panel : panels) {
    const auto lines = std::count_if(panel.series.begin(), panel.series.end(),
                                     [](const PlotSeries& one) { return !one.label.empty(); });
    if (panel.legend) longest = std::max(longest, lines);
  }
  constexpr int kRest = 150;  // title, axis and room around
  return std::max(kPanelHeight, kRest + kLegendLine * static_cast<int>(longest));
}

}  // namespace

FigureResult DrawPlot(const std::string& stem, const std::vector<PlotPanel>& panels, int columns,
                      FileBatch* batch) {
  const int count = static_cast<int>(panels.size());
  const int rows = (count + columns - 1) / columns;
  const int width = PanelWidth(panels) * std::min(columns, count);
  const int height = PanelHeight(panels) * rows;
  std::string data;
  std::string commands = "set multiplot layout " + std::to_string(rows) + "," +
                         std::to_string(std::min(columns, count)) +
                         "\nset grid linewidth 0.5 linecolor rgb '#dddddd'\n";
  int num_series = 0;
  for (const PlotPanel& panel : panels) {
    commands += "unset logscale\nset format '%g'\n";
    // A picture of a curve needs no numbers; a graph needs room for its axis.
    commands += panel.equal_scale
                    ? "set size ratio -1\nunset border\nunset tics\nset xrange [*:*]\nset offsets "
                      "graph 0.05, graph 0.05, graph 0.05, graph 0.05\nset margins " +
                          std::string(panel.y_label.empty() ? "1, " : "4, ")
                    : "set size noratio\nset border 3 linewidth 0.8\nset tics nomirror out scale "
                      "0.6 font ',10'\nset offsets 0, 0, 0, 0\n" +
                          NamedTics(panel.x_names) + "set margins " + std::to_string(kLeftMargin) +
                          ", ";
    commands += std::to_string(LegendWidth(panel)) + (!panel.equal_scale      ? ", 4.5, 2.5\n"
                                                      : panel.x_label.empty() ? ", 1, 2.5\n"
                                                                              : ", 2.5, 2.5\n");
    commands += panel.is_share ? "set yrange [0:1.03]\n" : "set yrange [*:*]\n";
    commands += "set title " + GnuplotString(ShownText(panel.title, kMostText)) + " noenhanced\n" +
                Axis("x", panel.x_label, panel.log_x) + Axis("y", panel.y_label, panel.log_y);
    commands += panel.legend ? "set key at graph 1.03, graph 1 left top vertical Left reverse "
                               "noenhanced maxcols 1 samplen 3 spacing 1.1 font ',9'\n"
                             : "unset key\n";
    commands += PanelPlot(panel, &num_series, &data);
  }
  commands += "unset multiplot\n";
  if (num_series == 0) return NoFigure(stem, "there is nothing to draw", batch);
  return DrawFigure(stem, data, commands, width, height, batch);
}

}  // namespace batten
