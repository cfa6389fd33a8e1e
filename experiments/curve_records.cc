#include "experiments/curve_records.h"

#include <nlohmann/json.hpp>

namespace batten {
namespace {

using Json = nlohmann::ordered_json;

/// Every `step`-th row.
Json Rows(const Points& points, Eigen::Index step) {
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < points.rows(); i += step) {
    rows.push_back(std::vector<double>(points.data() + i * points.cols(),
                                       points.data() + (i + 1) * points.cols()));
  }
  return rows;
}

}  // namespace

std::string CurveJson(const CurveFit& fit) {
  constexpr Eigen::Index kMostPoints = 1000;
  const Points& data = fit.data().points;
  const Eigen::Index step = (data.rows() + kMostPoints - 1) / kMostPoints;
  const Json json = {{"format", "batten.curve/1"},         {"degree", fit.basis().degree()},
                     {"periodic", fit.basis().periodic()}, {"knots", fit.basis().knots()},
                     {"num_points", data.rows()},          {"points", Rows(data, step)}};
  return json.dump() + "\n";
}

std::string ControlPointsJsonLine(const CurveFit& fit, const Iterate& iterate) {
  const Json json = {{"iteration", iterate.iteration},
                     {"control_points", Rows(fit.ControlPoints(iterate.x), 1)}};
  return json.dump() + "\n";
}

}  // namespace batten
