#include <algorithm>
#include <cmath>
#include <iterator>

#include "cost_functions/options.h"
#include "experiments/figure_panels.h"
#include "experiments/figures.h"

namespace batten {
namespace {

// Okabe and Ito, "Color Universal Design" (2008): told apart by all kinds of colour vision; their
// yellow, too light on white, is a grey here.
constexpr const char* kColours[] = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                    "#000000", "#E69F00", "#56B4E9", "#777777"};
constexpr int kNumColours = 8;
constexpr int kNumDashes = 5;
constexpr int kNumMarks = 7;
// Pixels.
constexpr int kLeft = 80;     // the first panel begins
constexpr int kMiddle = 465;  // and ends
constexpr int kRight = 575;   // the second begins, and ends with all panels
constexpr int kPanelsWidth = 960;
constexpr int kLegendSample = 100;
constexpr int kCharacter = 10;
constexpr int kHeight = 460;
constexpr int kLegendLine = 22;
constexpr std::size_t kMostTitle = 36;  // characters of a problem's name

bool HasTrace(const ComparisonRow& row) {
  return row.run.skipped.empty() && !row.run.trace.empty();
}

/// In the key: what reaches 0 leaves a logarithmic axis.
std::string KeyText(const ComparisonRow& row) {
  const auto& excess = row.excess_energies;
  const auto zero = std::find(excess.begin(), excess.end(), 0.0);
  if (zero == excess.end()) return row.solver;
  const auto k = static_cast<std::size_t>(zero - excess.begin());
  return row.solver + " (E = E* at " + std::to_string(row.run.trace[k].iteration) + ")";
}

bool KnowsExcess(const std::vector<const ComparisonRow*>& rows) {
  return std::any_of(rows.begin(), rows.end(), [](const ComparisonRow* row) {
    return std::any_of(row->excess_energies.begin(), row->excess_energies.end(),
                       [](double excess) { return excess > 0.0 && std::isfinite(excess); });
  });
}

/// Not positive: nothing to show on a log scale.
double OnLogScale(double value) { return value > 0.0 ? value : std::nan(""); }

std::string Block(const ComparisonRow& row) {
  std::string text = "# " + row.problem + ", " + row.solver +
                     "\n# iteration energy energy_minus_minimum gradient_norm seconds\n";
  for (std::size_t k = 0; k < row.run.trace.size(); ++k) {
    const TraceRow& at = row.run.trace[k];
    const double excess = k < row.excess_energies.size() ? row.excess_energies[k] : std::nan("");
    text += GnuplotNumbers({static_cast<double>(at.iteration), OnLogScale(at.energy),
                            OnLogScale(excess), OnLogScale(at.gradient_norm), at.seconds});
  }
  return text;
}

/// The decades of all positive values. What falls below the highest by more than double can tell
/// apart, squared, is noise.
class Decades {
 public:
  void Include(double value) {
    if (!(value > 0.0) || !std::isfinite(value)) return;
    low_ = std::min(low_, std::log10(value));
    high_ = std::max(high_, std::log10(value));
  }
  /// Where nothing is above 0, a sentence stands in the frame.
  std::string RangeCommand() const {
    if (low_ > high_) {
      return "set yrange [0.1:1]\n"
             "set label 1 '0 at every iteration' at graph 0.5, graph 0.5 center\n";
    }
    constexpr double kMost = 34.0;
    constexpr double kMargin = 0.3;
    const double low = std::max({low_ - kMargin, high_ - kMost, -300.0});
    const double high = std::min(high_ + kMargin, 300.0);
    return "set yrange [1e" + std::to_string(static_cast<int>(std::floor(low))) + ":1e" +
           std::to_string(static_cast<int>(std::ceil(high))) + "]\n";
  }

 private:
  double low_ = HUGE_VAL;
  double high_ = -HUGE_VAL;
};

std::string RangeOfExcess(const std::vector<const ComparisonRow*>& rows) {
  Decades decades;
  for (const ComparisonRow* row : rows) {
    for (const double value : row->excess_energies) decades.Include(value);
  }
  return decades.RangeCommand();
}

std::string RangeOf(const std::vector<const ComparisonRow*>& rows, double TraceRow::*value) {
  Decades decades;
  for (const ComparisonRow* row : rows) {
    for (const TraceRow& at : row->run.trace) decades.Include(at.*value);
  }
  return decades.RangeCommand();
}

std::string Style(int index, int num_iterations) {
  // About ten marks a curve; the negative interval sets them off from the line.
  constexpr int kMarks = 10;
  const int interval = std::max(1, num_iterations / kMarks);
  return "set style line " + std::to_string(index + 1) + " linecolor rgb '" +
         kColours[index % kNumColours] + "' linewidth 1.6 dashtype " +
         std::to_string(index % kNumDashes + 1) + " pointtype " +
         std::to_string(2 * (index % kNumMarks) + (index < kNumMarks ? 5 : 4)) +
         " pointsize 0.5 pointinterval " + std::to_string(interval) + "\n";
}

/// Linear, or where some solver needs many more iterations than others log(1 + k), which has a 0.
std::string IterationAxis(int most_iterations) {
  constexpr int kMostLinear = 60;
  if (most_iterations <= kMostLinear) {
    constexpr int kSpacing = 40;  // pixels
    const double step = TickStep(most_iterations, kMiddle - kLeft, kSpacing);
    return "set xlabel 'iteration'\nset xtics " + NumberText(std::max(1.0, step)) + "\n";
  }
  std::string ticks = "0, 1, 3";
  for (int tick = 10; tick <= most_iterations; tick *= 10) {
    ticks += ", " + std::to_string(tick);
    if (3 * tick <= most_iterations) ticks += ", " + std::to_string(3 * tick);
  }
  return "set xlabel 'iteration k, scaled as log(1 + k)'\n"
         "set nonlinear x via log10(1 + x) inverse 10**x - 1\nset xtics (" +
         ticks + ")\n";
}

/// Two panels, and the legend as a plot of nothing over the whole height beside them: only there
/// its entries stand in one column.
class Canvas {
 public:
  Canvas(const std::vector<const ComparisonRow*>& rows, int width) : rows_(rows), width_(width) {}

  std::string Place(int left, int right, double bottom, double top) const {
    return "set lmargin at screen " + Screen(left) + "\nset rmargin at screen " + Screen(right) +
           "\nset bmargin at screen " + NumberText(bottom) + "\nset tmargin at screen " +
           NumberText(top) + "\n";
  }
  std::string Panel(int left, int right, const std::string& quantity, const std::string& range,
                    int column) const {
    std::string text =
        Place(left, right, 0.16, 0.9) + "set title " +
        GnuplotString(ShownText(rows_.front()->problem, kMostTitle) + ": " + quantity) +
        " noenhanced\n" + range + "plot ";
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      text += (k > 0 ? ", \\\n     " : "") + ("DATA index " + std::to_string(k)) +
              " using 1:" + std::to_string(column) + " with linespoints linestyle " +
              std::to_string(k + 1);
    }
    return text + "\nunset label 1\n";
  }
  std::string Legend() const {
    std::string text = Place(0, width_, 0.0, 1.0) +
                       "unset border\nunset tics\nunset grid\nunset title\nunset xlabel\n"
                       "set key at screen " +
                       Screen(kPanelsWidth + 20) +
                       ", screen 0.9 left top vertical maxcols 1 Left reverse noenhanced\nplot ";
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      text += (k > 0 ? ", \\\n     " : "") + std::string("NaN with linespoints linestyle ") +
              std::to_string(k + 1) + " title " + GnuplotString(KeyText(*rows_[k]));
    }
    return text + "\n";
  }

 private:
  std::string Screen(int pixels) const { return NumberText(static_cast<double>(pixels) / width_); }

  const std::vector<const ComparisonRow*>& rows_;
  int width_;
};

std::string Commands(const std::vector<const ComparisonRow*>& rows, int width, int most_iterations,
                     bool excess) {
  const Canvas canvas(rows, width);
  return "set multiplot\nunset key\n"
         "set border 3 linewidth 0.8\nset tics nomirror out scale 0.6\n"
         "set grid ytics linewidth 0.5 linecolor rgb '#dddddd'\n"
         "set logscale y\nset format y '10^{%T}'\n" +
         IterationAxis(most_iterations) + "set xrange [0:" + std::to_string(most_iterations) +
         "]\n" +
         canvas.Panel(kLeft, kMiddle, excess ? "E - E*" : "E",
                      excess ? RangeOfExcess(rows) : RangeOf(rows, &TraceRow::energy),
                      excess ? 3 : 2) +
         canvas.Panel(kRight, kPanelsWidth, "|g|", RangeOf(rows, &TraceRow::gradient_norm), 4) +
         canvas.Legend() + "unset multiplot\n";
}

}  // namespace

FigureResult ConvergenceFigure(const std::vector<const ComparisonRow*>& rows,
                               const std::string& stem, FileBatch* batch) {
  std::vector<const ComparisonRow*> drawn;
  std::copy_if(rows.begin(), rows.end(), std::back_inserter(drawn),
               [](const ComparisonRow* row) { return HasTrace(*row); });
  if (drawn.empty()) return NoFigure(stem, "there is no trace to draw", batch);
  std::string data;
  std::string styles;
  int most_iterations = 1;
  std::size_t longest_name = 0;
  for (std::size_t k = 0; k < drawn.size(); ++k) {
    data += (k > 0 ? "\n\n" : "") + Block(*drawn[k]);
    styles += Style(static_cast<int>(k), drawn[k]->run.iterations);
    most_iterations = std::max(most_iterations, drawn[k]->run.iterations);
    longest_name = std::max(longest_name, KeyText(*drawn[k]).size());
  }
  const int width = kPanelsWidth + kLegendSample + kCharacter * static_cast<int>(longest_name);
  const int height = std::max(kHeight, kLegendLine * (static_cast<int>(drawn.size()) + 4));
  return DrawFigure(stem, data,
                    styles + Commands(drawn, width, most_iterations, KnowsExcess(drawn)), width,
                    height, batch);
}

std::vector<const ComparisonRow*> RowsOfProblem(const ComparisonResult& result, int problem_index) {
  std::vector<const ComparisonRow*> rows;
  for (const ComparisonRow& row : result.rows) {
    if (row.problem_index == problem_index) rows.push_back(&row);
  }
  return rows;
}

}  // namespace batten
