#include "tools/fitted_points.h"

#include <nlohmann/json.hpp>

#include "problems/strict_json.h"

namespace batten {

namespace {

/// Control points of another kind of curve would be read as one that nobody fitted.
bool IsOfKind(const nlohmann::json& spline, int degree, bool closed) {
  return (!spline.contains("degree") || spline["degree"] == degree) &&
         (!spline.contains("periodic") || spline["periodic"] == closed);
}

}  // namespace

bool ReadFittedControlPoints(const std::string& path, int degree, bool closed, Points* points,
                             std::string* error) {
  nlohmann::json json;
  if (!ReadJsonFile(path, &json, error)) return false;
  const auto refuse = [&] {
    *error = path +
             ": /spline/control_points: found no list of points of one dimension; allowed: "
             "a file that batten fit --out has written";
    return false;
  };
  const nlohmann::json::json_pointer place("/spline/control_points");
  if (!json.is_object() || !json.contains(place) || !json.at(place).is_array()) return refuse();
  if (!IsOfKind(json.at("spline"), degree, closed)) {
    *error = path + ": /spline: found another kind of curve; allowed: " +
             (closed ? "a closed" : "an open") + " one of degree " + std::to_string(degree) +
             ", as is to be fitted";
    return false;
  }
  const nlohmann::json& rows = json.at(place);
  if (rows.empty() || !rows[0].is_array() || rows[0].empty() || rows[0].size() > kMaxDimension) {
    return refuse();
  }
  points->resize(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(rows[0].size()));
  for (Eigen::Index j = 0; j < points->rows(); ++j) {
    const nlohmann::json& row = rows[static_cast<std::size_t>(j)];
    if (!row.is_array() || static_cast<Eigen::Index>(row.size()) != points->cols()) return refuse();
    for (Eigen::Index c = 0; c < points->cols(); ++c) {
      const nlohmann::json& number = row[static_cast<std::size_t>(c)];
      if (!number.is_number()) return refuse();
      (*points)(j, c) = number.get<double>();
    }
  }
  return true;
}

}  // namespace batten
