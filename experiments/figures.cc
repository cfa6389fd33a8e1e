#include "experiments/figures.h"

#include <algorithm>
#include <cmath>

#include "experiments/figure_panels.h"
#include "experiments/fit_lines.h"
#include "experiments/short_number.h"
#include "problems/fit_problem.h"

namespace batten {
namespace {

constexpr int kMostPoints = 4000;  // drawn; more are no more to be seen on some 700 x 600 pixels
constexpr int kMostSamples = 40000;

/// Columns (t, coordinates) in dimension 1, coordinates otherwise.
std::string Line(double t, const double* coordinates, int dimension) {
  std::vector<double> values(coordinates, coordinates + dimension);
  if (dimension == 1) values.insert(values.begin(), t);
  return GnuplotNumbers(values);
}

std::string ColumnNames(int dimension) {
  const std::string all = "x y z w";
  return dimension == 1 ? "# t x\n" : "# " + all.substr(0, 2 * dimension - 1) + "\n";
}

std::string Block(const FitLine& line) {
  const int d = static_cast<int>(line.points.cols());
  std::string text = "# " + line.name + "\n" + ColumnNames(d);
  for (std::size_t k = 0; k < line.t.size(); ++k) {
    text += Line(line.t[k], line.points.row(static_cast<Eigen::Index>(k)).data(), d);
  }
  return text;
}

/// The axes' ranges: data and control points, with a margin that is alike for all.
std::vector<FigureAxis> Axes(const CurveFit& fit, const Points& control_points) {
  constexpr double kMargin = 0.04;
  constexpr double kThinnest = 0.08;  // of the longest side
  const Points& points = fit.data().points;
  const auto low = points.colwise().minCoeff().cwiseMin(control_points.colwise().minCoeff()).eval();
  const auto high =
      points.colwise().maxCoeff().cwiseMax(control_points.colwise().maxCoeff()).eval();
  const double longest = (high - low).maxCoeff();
  const double side = longest > 0.0 ? longest : 1.0;
  std::vector<FigureAxis> axes;
  for (int c = 0; c < fit.dimension(); ++c) {
    const double thin = std::max(0.0, kThinnest * side - (high[c] - low[c])) / 2;
    const double margin = kMargin * side + thin;
    axes.push_back({kCoordinateNames[c], c + 1, low[c] - margin, high[c] + margin});
  }
  return axes;
}

std::vector<FigurePanel> Panels(const CurveFit& fit, const Points& control_points) {
  const std::vector<FigureAxis> axes = Axes(fit, control_points);
  std::vector<FigurePanel> panels;
  for (const auto& [across, up] : AxisPairs(fit.dimension())) {
    FigurePanel panel;
    panel.vertical = axes[static_cast<std::size_t>(up)];
    if (across >= 0) {
      panel.horizontal = axes[static_cast<std::size_t>(across)];
    } else {
      panel.horizontal = {"t", 1, fit.basis().domain_begin(), fit.basis().domain_end()};
      panel.vertical.column = 2;
    }
    panels.push_back(std::move(panel));
  }
  return panels;
}

/// Data so dense that they would hide polygon and curve are drawn small and light below them.
bool IsDense(int num_points) { return num_points > 400; }

std::string Styles(int num_points, int num_control_points) {
  const bool dense = IsDense(num_points);
  const double data = dense ? 0.25 : std::min(0.45, 4.0 / std::sqrt(num_points));
  const double control = std::clamp(3.0 / std::sqrt(num_control_points), 0.1, 0.35);
  return std::string("set style line 1 linecolor rgb '") + (dense ? "#7fb2ff" : "#0050d0") +
         "' pointtype 7 pointsize " + ShortNumber(data, 2) + "  # data\n" +
         "set style line 2 linecolor rgb '#000000' linewidth 0.6 pointtype 4 pointsize " +
         ShortNumber(control, 2) + "  # control polygon\n" +
         "set style line 3 linecolor rgb '#d81010' linewidth 1.6  # curve\n"
         "set style line 4 linecolor rgb '#108010' pointtype 7 pointsize " +
         ShortNumber(std::clamp(4.0 / std::sqrt(num_control_points), 0.15, 0.45), 2) +
         "  # knots\n"
         "set border 3 linewidth 0.8\n"
         "set tics nomirror out scale 0.6\n";
}

std::string PlotCommand(const FigurePanel& panel, bool dense, bool with_knots) {
  const std::string columns = panel.horizontal.Column() + ":" + panel.vertical.Column();
  const auto layer = [&columns](const std::string& index, const std::string& style) {
    return "DATA index " + index + " using " + columns + " with " + style + " notitle";
  };
  const std::string data = layer("0", "points linestyle 1");
  const std::string polygon = layer("1", "linespoints linestyle 2");
  const std::string curve = layer("2", "lines linestyle 3");
  const std::string next = ", \\\n     ";
  const std::string knots = with_knots ? next + layer("3", "points linestyle 4") : "";
  return "plot " +
         (dense ? data + next + polygon + next + curve : polygon + next + curve + next + data) +
         knots + "\n";
}

/// In the middle above the panels. A long name gives way first.
std::string TitleCommand(const std::string& name, const std::string& rest, int width) {
  constexpr int kCharacter = 8;  // pixels
  constexpr std::size_t kShortestName = 12;
  const auto most = static_cast<std::size_t>(width / kCharacter);
  const std::size_t for_name = most - std::min(most, rest.size());
  const std::string title = ShownText(name, std::max(for_name, kShortestName)) + rest;
  return "set label 1 " + GnuplotString(ShownText(title, most)) +
         " at screen 0.5, screen 1 center offset 0,-1.2 noenhanced\n";
}

/// A plot of nothing over the whole width: only there the entries stand in one line.
std::string Legend(const std::string& data_name, bool with_knots) {
  return "unset border\nunset tics\nunset xlabel\nunset ylabel\n"
         "set lmargin at screen 0\nset rmargin at screen 1\n"
         "set bmargin at screen 0\nset tmargin at screen 1\n"
         "set xrange [0:1]\nset yrange [0:1]\n"
         "set key at screen 0.5, screen 0.01 center bottom horizontal Left reverse samplen 2.5\n"
         "plot NaN with points linestyle 1 pointsize 0.45 title " +
         GnuplotString(data_name) +
         ", \\\n     NaN with linespoints linestyle 2 pointsize 0.35 title 'control polygon', \\\n"
         "     NaN with lines linestyle 3 title 'curve'" +
         (with_knots ? ", \\\n     NaN with points linestyle 4 pointsize 0.45 title 'knots'" : "") +
         "\n";
}

}  // namespace

FigureResult FitFigure(const Problem& problem, const RunResult& run, const std::string& stem,
                       FileBatch* batch) {
  const CurveFit* fit = problem.curve_fit();
  if (fit == nullptr || run.x.size() != problem.num_variables() || !run.x.allFinite()) {
    return NoFigure(stem, problem.name() + ": there is no curve to draw", batch);
  }
  const Points control_points = fit->ControlPoints(run.x);
  const int m = static_cast<int>(fit->data().points.rows());
  const int n = fit->basis().num_control_points();
  const int step = (m + kMostPoints - 1) / kMostPoints;
  const bool with_knots = !fit->spec().given_knots.empty();
  const BsplineCurve curve = fit->Curve(run.x);
  const FitLine points = DataLine(*fit, run.x, step);
  std::string data = Block(points) + "\n\n" + Block(PolygonLine(*fit, run.x)) + "\n\n" +
                     Block(CurveLine(curve, kMostSamples));
  if (with_knots) data += "\n\n" + Block(KnotLine(curve));
  const FigureCanvas canvas = LayOutPanels(Panels(*fit, control_points), fit->dimension() > 1);
  const std::string counts = ": " + std::to_string(m) + " points, " + std::to_string(n) +
                             " control points, " + run.solver.ToString();
  std::string commands =
      Styles(m, n) + TitleCommand(problem.name(), counts, canvas.width) + "set multiplot\n";
  for (const FigurePanel& panel : canvas.panels) {
    commands += PanelCommands(canvas, panel) + PlotCommand(panel, IsDense(m), with_knots) +
                "unset label 1\n";
  }
  return DrawFigure(stem, data, commands + Legend(points.name, with_knots) + "unset multiplot\n",
                    canvas.width, canvas.height, batch);
}

}  // namespace batten
