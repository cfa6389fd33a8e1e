#include "problems/bezier_file.h"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "cost_functions/options.h"
#include "problems/data_set.h"
#include "problems/strict_json.h"
#include "splines/bezier_measures.h"

namespace batten {
namespace {

using Json = nlohmann::json;

/// The key `control_points` of an object; refuses the first row that is not like the others.
bool ControlPoints(const StrictObject& object, const Json& json, Points* points) {
  const std::string key = "control_points";
  constexpr char kAllowed[] = "a list of points of 1 to 4 coordinates";
  if (!json.contains(key) || !json.at(key).is_array() || json.at(key).empty()) {
    return object.Refuse(key, kAllowed);
  }
  const Json& rows = json.at(key);
  const std::size_t d = rows[0].is_array() ? rows[0].size() : 0;
  if (d < 1 || d > kMaxDimension) return object.Refuse(key + "/0", "a point of 1 to 4 coordinates");
  points->resize(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(d));
  for (std::size_t j = 0; j < rows.size(); ++j) {
    const std::string place = key + "/" + std::to_string(j);
    if (!rows[j].is_array() || rows[j].size() != d) {
      return object.Refuse(place, "a point of " + std::to_string(d) + " coordinates, as the first");
    }
    for (std::size_t c = 0; c < d; ++c) {
      if (!rows[j][c].is_number())
        return object.Refuse(place + "/" + std::to_string(c), "a number");
      (*points)(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(c)) =
          rows[j][c].get<double>();
    }
  }
  return true;
}

bool OneCurve(const std::string& where, Points control_points, std::vector<BezierPath>* paths,
              std::string* error) {
  std::string reason;
  std::optional<BezierCurve> curve = BezierCurve::Make(std::move(control_points), &reason);
  if (!curve) {
    *error = where + reason;
    return false;
  }
  paths->push_back({{{std::move(*curve), 0.0, 1.0}}});
  return true;
}

bool FromSpline(const std::string& path, const Json& json, std::vector<BezierPath>* paths,
                std::string* error) {
  StrictObject whole(path, "", &json, error), spline;
  int degree = 0;
  bool periodic = false;
  std::vector<double> knots;
  if (!whole.Object("spline", StrictObject::Presence::kRequired, &spline) ||
      !spline.Integer("degree", StrictObject::Presence::kRequired, 1, kMaxDegree, &degree) ||
      !spline.Flag("periodic", StrictObject::Presence::kRequired, &periodic) ||
      !spline.Numbers("knots", StrictObject::Presence::kRequired, &knots)) {
    return false;
  }
  Points points;
  if (!ControlPoints(spline, json.at("spline"), &points)) return false;
  std::string reason;
  std::optional<BsplineBasis> basis = BsplineBasis::Make(degree, periodic, knots, &reason);
  if (!basis) return spline.Complain("knots", reason);
  if (basis->num_control_points() != points.rows()) {
    return spline.Refuse("control_points",
                         std::to_string(basis->num_control_points()) + " points for these knots");
  }
  if (!points.allFinite()) return spline.Refuse("control_points", "finite numbers");
  paths->push_back({BezierSpansOf(BsplineCurve(std::move(*basis), std::move(points)))});
  return true;
}

bool FromJson(const std::string& path, std::vector<BezierPath>* paths, std::string* error) {
  Json json;
  if (!ReadJsonFile(path, &json, error)) return false;
  if (!json.is_object() || !json.contains("control_points")) {
    return FromSpline(path, json, paths, error);
  }
  Points points;
  if (!ControlPoints(StrictObject(path, "", &json, error), json, &points)) return false;
  return OneCurve(path + ": /control_points: ", std::move(points), paths, error);
}

bool FromPoints(const std::string& path, std::vector<BezierPath>* paths, std::string* error) {
  std::optional<DataSet> data = ReadDataSet(path, error);
  if (!data) return false;
  if (data->parameters || data->weights) {
    *error = path + ": found the column " + (data->parameters ? "t" : "weight") +
             "; allowed: coordinates of control points alone";
    return false;
  }
  return OneCurve(path + ": ", std::move(data->points), paths, error);
}

}  // namespace

bool ReadBezierFile(const std::string& path, std::vector<BezierPath>* paths, std::string* left_out,
                    std::string* error) {
  paths->clear();
  left_out->clear();
  if (EndsWith(path, ".json")) return FromJson(path, paths, error);
  if (EndsWith(path, ".svg")) return ReadSvgPaths(path, paths, left_out, error);
  return FromPoints(path, paths, error);
}

double BoxSideOf(const std::vector<BezierPath>& paths) {
  Points extremes;  // rows: low, high
  for (const BezierPath& path : paths) {
    for (const BezierSpan& span : path.spans) {
      const Points& points = span.curve.control_points();
      if (extremes.size() == 0) extremes = points.topRows(1).replicate(2, 1);
      extremes.row(0) = extremes.row(0).cwiseMin(points.colwise().minCoeff());
      extremes.row(1) = extremes.row(1).cwiseMax(points.colwise().maxCoeff());
    }
  }
  return extremes.size() == 0 ? 0.0 : (extremes.row(1) - extremes.row(0)).maxCoeff();
}

}  // namespace batten
