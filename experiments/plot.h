#ifndef BATTEN_EXPERIMENTS_PLOT_H_
#define BATTEN_EXPERIMENTS_PLOT_H_

#include <string>
#include <vector>

#include "experiments/gnuplot.h"

namespace batten {

struct PlotSeries {
  std::string label;  ///< Empty: not in the legend.
  std::vector<double> x;
  std::vector<double> y;
  enum class Style {
    kLine,
    kPoints,
    kLinePoints,
    kDashed,
    kCircles,
    kOneOfMany  ///< A line with a dash of its own for each eight colours, and marks beyond eight.
  } style = Style::kLinePoints;
  /// One of a fixed list of colours that are told apart without seeing red and green alike.
  int color = 0;
  /// Of kOneOfMany: places of its marks, on the line.
  std::vector<double> mark_x = {};
  std::vector<double> mark_y = {};
};

struct PlotPanel {
  std::string title;
  std::string x_label;
  std::string y_label;
  bool log_x = false;
  bool log_y = false;
  bool equal_scale = false;
  bool is_share = false;  ///< y from 0 to 1, whatever the data.
  bool legend = true;
  /// Names for x = 1, 2, ...; empty: numbers.
  std::vector<std::string> x_names;
  std::vector<PlotSeries> series;
};

/// Lines of kOneOfMany that are told apart.
inline constexpr int kMostOfMany = 48;

/// Panels in rows of `columns`, as high and wide as the longest legend needs, STEM.svg with script
/// and data beside it as DrawFigure() has it. Points that a logarithmic axis cannot show are left
/// out.
FigureResult DrawPlot(const std::string& stem, const std::vector<PlotPanel>& panels, int columns,
                      FileBatch* batch);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_PLOT_H_
