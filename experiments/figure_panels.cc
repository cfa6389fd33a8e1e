#include "experiments/figure_panels.h"

#include <algorithm>
#include <cmath>

#include "cost_functions/options.h"
#include "experiments/gnuplot.h"

namespace batten {
namespace {

// Pixels around and between panels: numbers and name of the vertical axis, those of the horizontal
// one with the legend below, the title.
constexpr int kLeft = 85;
constexpr int kRight = 30;
constexpr int kBetween = 95;
constexpr int kBottom = 108;
constexpr int kTop = 50;
constexpr int kNarrowest = 640;  // title and legend must fit

std::string Fraction(int pixels, int all) { return NumberText(static_cast<double>(pixels) / all); }

/// Characters of a tick's number, written plainly.
double TickWidth(const FigureAxis& axis) {
  const double size = std::max(std::abs(axis.low), std::abs(axis.high));
  const double digits = std::max(1.0, std::floor(std::log10(size)) + 1.0);
  const double decimals = std::max(0.0, 1.0 - std::floor(std::log10(axis.length())));
  return digits + decimals + (decimals > 0.0 ? 1.0 : 0.0);
}

std::string AxisName(const FigureAxis& axis) {
  const double offset = axis.offset();
  if (offset == 0.0) return axis.name;
  return axis.name + (offset > 0.0 ? " - " : " + ") + NumberText(std::abs(offset));
}

std::string AxisCommands(const std::string& letter, const FigureAxis& axis, int pixels,
                         int spacing) {
  const double offset = axis.offset();
  // Plain numbers: data somewhat off the origin would read 2.00004e6 at every tick.
  return "set format " + letter + " '%.10g'\nset " + letter + "range [" +
         NumberText(axis.low - offset) + ":" + NumberText(axis.high - offset) + "]\n" + "set " +
         letter + "tics " + NumberText(TickStep(axis.length(), pixels, spacing)) + "\n" + "set " +
         letter + "label " + GnuplotString(AxisName(axis)) +
         (letter == "y" ? " offset 1,0\n" : "\n");
}

}  // namespace

double FigureAxis::offset() const {
  constexpr double kWidest = 8.0;
  if (!(length() > 0.0) || TickWidth(*this) <= kWidest) return 0.0;
  const double unit = std::pow(10.0, std::floor(std::log10(length())) + 1.0);
  return std::round((low + 0.5 * length()) / unit) * unit;
}

std::string FigureAxis::Column() const {
  const std::string number = std::to_string(column);
  return offset() == 0.0 ? number : "($" + number + "-(" + NumberText(offset()) + "))";
}

FigureCanvas LayOutPanels(std::vector<FigurePanel> panels, bool equal_scale) {
  const bool alone = panels.size() == 1;
  const double widest = alone ? 760.0 : 1080.0;  // pixels of all panels together
  const double highest = alone ? 620.0 : 440.0;
  constexpr double kSingleHeight = 420.0;
  double total_width = 0.0;
  double total_height = 0.0;
  for (const FigurePanel& panel : panels) {
    total_width += panel.horizontal.length();
    total_height = std::max(total_height, panel.vertical.length());
  }
  const double scale = std::min(widest / total_width, highest / total_height);
  FigureCanvas canvas;
  int left = kLeft;
  int largest_height = 0;
  for (FigurePanel& panel : panels) {
    panel.left = left;
    panel.bottom = kBottom;
    const double width = equal_scale ? scale * panel.horizontal.length() : widest / panels.size();
    const double height = equal_scale ? scale * panel.vertical.length() : kSingleHeight;
    panel.width = std::max(1, static_cast<int>(std::lround(width)));
    panel.height = std::max(1, static_cast<int>(std::lround(height)));
    left += panel.width + kBetween;
    largest_height = std::max(largest_height, panel.height);
  }
  const int needed = left - kBetween + kRight;
  canvas.width = std::max(needed, kNarrowest);
  for (FigurePanel& panel : panels) panel.left += (canvas.width - needed) / 2;
  canvas.height = kBottom + largest_height + kTop;
  canvas.panels = std::move(panels);
  return canvas;
}

std::string PanelCommands(const FigureCanvas& canvas, const FigurePanel& panel) {
  constexpr int kAcross = 80;  // pixels between ticks: a number must fit
  constexpr int kAbove = 36;
  const auto side = [](const char* name, int pixels, int all) {
    return std::string("set ") + name + "margin at screen " + Fraction(pixels, all) + "\n";
  };
  return side("l", panel.left, canvas.width) + side("r", panel.left + panel.width, canvas.width) +
         side("b", panel.bottom, canvas.height) +
         side("t", panel.bottom + panel.height, canvas.height) +
         AxisCommands("x", panel.horizontal, panel.width, kAcross) +
         AxisCommands("y", panel.vertical, panel.height, kAbove);
}

double TickStep(double length, int pixels, int spacing) {
  const double least = length * spacing / std::max(1, pixels);
  if (!(least > 0.0) || !std::isfinite(least)) return 1.0;
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= least) return factor * power;
  }
  return 10.0 * power;
}

}  // namespace batten
