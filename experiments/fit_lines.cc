#include "experiments/fit_lines.h"

#include <algorithm>

namespace batten {
namespace {

FitLine PlacesOn(const BsplineCurve& curve, const std::string& name, std::vector<double> t) {
  FitLine line = {name, std::move(t), {}};
  line.points.resize(static_cast<Eigen::Index>(line.t.size()), curve.dimension());
  for (std::size_t k = 0; k < line.t.size(); ++k) {
    curve.Evaluate(line.t[k], 0, line.points.row(static_cast<Eigen::Index>(k)).data());
  }
  return line;
}

}  // namespace

FitLine DataLine(const CurveFit& fit, const Eigen::VectorXd& x, int step) {
  const Eigen::VectorXd t = fit.Parameters(x);
  const Points& points = fit.data().points;
  const Eigen::Index count = (points.rows() + step - 1) / step;
  FitLine line = {step == 1 ? "data" : "data (1 in " + std::to_string(step) + ")", {}, {}};
  line.points.resize(count, fit.dimension());
  for (Eigen::Index k = 0; k < count; ++k) {
    line.t.push_back(t[k * step]);
    line.points.row(k) = points.row(k * step);
  }
  return line;
}

FitLine PolygonLine(const CurveFit& fit, const Eigen::VectorXd& x) {
  const BsplineBasis& basis = fit.basis();
  const Points points = fit.ControlPoints(x);
  std::vector<std::pair<double, int>> order;
  for (int j = 0; j < basis.num_control_points(); ++j) order.emplace_back(basis.Greville(j), j);
  // On closed curves some abscissae come from the turn before.
  if (fit.dimension() == 1) std::sort(order.begin(), order.end());
  if (fit.dimension() > 1 && basis.periodic()) order.push_back(order.front());
  FitLine line = {"control polygon", {}, {}};
  line.points.resize(static_cast<Eigen::Index>(order.size()), fit.dimension());
  for (std::size_t k = 0; k < order.size(); ++k) {
    line.t.push_back(order[k].first);
    line.points.row(static_cast<Eigen::Index>(k)) = points.row(order[k].second);
  }
  return line;
}

FitLine CurveLine(const BsplineCurve& curve, int most) {
  const BsplineBasis& basis = curve.basis();
  constexpr int kSamplesPerSpan = 24;
  const int per_span =
      basis.degree() == 1 ? 1 : std::clamp(most / basis.num_domain_spans(), 2, kSamplesPerSpan);
  std::vector<double> t;
  for (int k = basis.first_span(); k <= basis.last_span(); ++k) {
    const double begin = basis.knots()[static_cast<std::size_t>(k)];
    const double length = basis.knots()[static_cast<std::size_t>(k) + 1] - begin;
    for (int s = 0; s < per_span && length > 0.0; ++s) t.push_back(begin + length * s / per_span);
  }
  // A closed curve ends where it began.
  t.push_back(basis.domain_end());
  return PlacesOn(curve, "curve", std::move(t));
}

FitLine KnotLine(const BsplineCurve& curve) {
  const BsplineBasis& basis = curve.basis();
  const auto first = basis.knots().begin() + basis.first_span();
  return PlacesOn(curve, "knots", {first, basis.knots().begin() + basis.last_span() + 2});
}

std::vector<std::pair<int, int>> AxisPairs(int dimension) {
  switch (dimension) {
    case 1:
      return {{-1, 0}};
    case 2:
      return {{0, 1}};
    case 3:
      return {{0, 1}, {0, 2}, {1, 2}};
    default:
      return {{0, 1}, {2, 3}};
  }
}

}  // namespace batten
