#ifndef BATTEN_EXPERIMENTS_FIGURE_PANELS_H_
#define BATTEN_EXPERIMENTS_FIGURE_PANELS_H_

#include <string>
#include <vector>

namespace batten {

/// One axis of a panel: a column of the data file and the range of it that is shown.
struct FigureAxis {
  std::string name;
  int column = 1;
  double low = 0.0;
  double high = 1.0;
  double length() const { return high - low; }
  /// Subtracted from what is shown, and written in the axis' name: a round number near the data
  /// where their own numbers would be too long for ticks; else 0.
  double offset() const;
  /// The column, less the offset, in gnuplot's words.
  std::string Column() const;
};

struct FigurePanel {
  FigureAxis horizontal;
  FigureAxis vertical;
  int left = 0;  // where it stands on the canvas, in pixels from the lower left corner
  int bottom = 0;
  int width = 0;
  int height = 0;
};

struct FigureCanvas {
  int width = 0;
  int height = 0;
  std::vector<FigurePanel> panels;
};

/// Panels side by side, with room for a title above and a legend below. Equal scale: one unit is as
/// many pixels on every axis of every panel.
FigureCanvas LayOutPanels(std::vector<FigurePanel> panels, bool equal_scale);

/// gnuplot's commands that make `panel` the next plot: its place, ranges, ticks and names.
std::string PanelCommands(const FigureCanvas& canvas, const FigurePanel& panel);

/// 1, 2 or 5 times a power of ten: the smallest step of ticks `spacing` pixels apart or more, where
/// `length` is `pixels` long.
double TickStep(double length, int pixels, int spacing);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_FIGURE_PANELS_H_
