#include "experiments/fit_plot.h"

#include <algorithm>
#include <utility>

#include "problems/fit_problem.h"

namespace batten {
namespace {

using Style = PlotSeries::Style;

/// Places on the curve, or points beside it, with their parameters.
struct Polyline {
  std::string label;
  Style style;
  int color;
  std::vector<double> t;
  Points points;
};

constexpr int kMostPlaces = 2000;  // as many as the page shows of a line

Polyline DataOf(const CurveFit& fit, const Eigen::VectorXd& x) {
  const Eigen::VectorXd t = fit.Parameters(x);
  return {"data", Style::kPoints, 0, {t.begin(), t.end()}, fit.data().points};
}

/// In dimension 1 control point j stands at its Greville abscissa.
Polyline PolygonOf(const CurveFit& fit, const Eigen::VectorXd& x) {
  const BsplineBasis& basis = fit.basis();
  const Points points = fit.ControlPoints(x);
  std::vector<std::pair<double, int>> order;
  for (int j = 0; j < basis.num_control_points(); ++j) order.emplace_back(basis.Greville(j), j);
  // On closed curves some abscissae come from the turn before.
  if (fit.dimension() == 1) std::sort(order.begin(), order.end());
  if (fit.dimension() > 1 && basis.periodic()) order.push_back(order.front());
  Polyline polygon = {"control polygon", Style::kLinePoints, 2, {}, {}};
  polygon.points.resize(static_cast<Eigen::Index>(order.size()), fit.dimension());
  for (std::size_t k = 0; k < order.size(); ++k) {
    polygon.t.push_back(order[k].first);
    polygon.points.row(static_cast<Eigen::Index>(k)) = points.row(order[k].second);
  }
  return polygon;
}

Polyline PlacesOf(const BsplineCurve& curve, const std::string& label, Style style, int color,
                  const std::vector<double>& t) {
  Polyline places = {label, style, color, t, {}};
  places.points.resize(static_cast<Eigen::Index>(t.size()), curve.dimension());
  for (std::size_t k = 0; k < t.size(); ++k) {
    curve.Evaluate(t[k], 0, places.points.row(static_cast<Eigen::Index>(k)).data());
  }
  return places;
}

/// Every span alike, its ends included.
std::vector<double> Samples(const BsplineBasis& basis) {
  const int per_span = std::clamp(kMostPlaces / basis.num_domain_spans(), 1, 24);
  std::vector<double> t;
  for (int k = basis.first_span(); k <= basis.last_span(); ++k) {
    const double begin = basis.knots()[static_cast<std::size_t>(k)];
    const double length = basis.knots()[static_cast<std::size_t>(k) + 1] - begin;
    for (int s = 0; s < per_span && length > 0.0; ++s) t.push_back(begin + length * s / per_span);
  }
  t.push_back(basis.domain_end());
  return t;
}

std::vector<double> DomainKnots(const BsplineBasis& basis) {
  const auto first = basis.knots().begin() + basis.first_span();
  return {first, basis.knots().begin() + basis.last_span() + 2};
}

/// Coordinate `across` against `up`; -1: the parameter.
PlotPanel Panel(const std::vector<Polyline>& lines, int across, int up) {
  constexpr char kNames[] = "txyzw";
  PlotPanel panel;
  panel.x_label = kNames[across + 1];
  panel.y_label = kNames[up + 1];
  panel.equal_scale = across >= 0;
  for (const Polyline& line : lines) {
    PlotSeries series;
    series.label = line.label;
    series.style = line.style;
    series.color = line.color;
    series.x = line.t;
    for (Eigen::Index i = 0; i < line.points.rows(); ++i) {
      if (across >= 0) series.x[static_cast<std::size_t>(i)] = line.points(i, across);
      series.y.push_back(line.points(i, up));
    }
    panel.series.push_back(std::move(series));
  }
  return panel;
}

}  // namespace

std::vector<PlotPanel> FitPanels(const Problem& problem, const RunResult& run) {
  const CurveFit* fit = problem.curve_fit();
  if (fit == nullptr || run.x.size() != problem.num_variables() || !run.x.allFinite()) return {};
  const BsplineCurve curve = fit->Curve(run.x);
  std::vector<Polyline> lines = {
      PolygonOf(*fit, run.x),
      PlacesOf(curve, "curve", Style::kLine, 1, Samples(curve.basis())),
      DataOf(*fit, run.x),
  };
  if (!fit->spec().given_knots.empty()) {
    lines.push_back(PlacesOf(curve, "knots", Style::kCircles, 3, DomainKnots(curve.basis())));
  }
  std::vector<PlotPanel> panels;
  switch (fit->dimension()) {
    case 1:
      panels = {Panel(lines, -1, 0)};
      break;
    case 2:
      panels = {Panel(lines, 0, 1)};
      break;
    case 3:
      panels = {Panel(lines, 0, 1), Panel(lines, 0, 2), Panel(lines, 1, 2)};
      break;
    default:
      panels = {Panel(lines, 0, 1), Panel(lines, 2, 3)};
  }
  panels.front().title = problem.name() + ", " + run.solver.ToString();
  return panels;
}

}  // namespace batten
