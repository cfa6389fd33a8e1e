#include "experiments/published_curves.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "experiments/experiment_runs.h"

namespace batten {
namespace {

Points Sampled(int number) {
  const int m = number == 0 ? 15001 : 10001;
  Points points(m, number == 0 ? 2 : 3);
  for (int i = 0; i < m; ++i) {
    const double a = 2.0 * M_PI * i / (m - 1);
    if (number == 0) {
      const double rho = 2.0 + 4.0 * std::cos(2.0 * a + M_PI / 4) + std::cos(3.0 * a + M_PI / 4);
      points.row(i) << rho * std::cos(a), rho * std::sin(a);
    } else {
      const double b = a * M_PI / 3.0;
      points.row(i) << 10.0 * std::cos(b), 10.0 * std::sin(b), b;
    }
  }
  return points;
}

}  // namespace

PublishedCurve MakePublishedCurve(int number) {
  DataSet data;
  data.name = "published_curve_" + std::to_string(number + 1);
  data.points = Sampled(number);
  const int n = number == 0 ? 3001 : 2001;
  const auto m = static_cast<int>(data.points.rows());
  Points first(n, data.points.cols());
  for (int i = 0; i < n; ++i) {
    // Wide enough for m i.
    const auto chosen = static_cast<int>(static_cast<std::int64_t>(m) * i / (n - 1));
    first.row(i) = data.points.row(i == n - 1 ? m - 1 : std::min(chosen, m - 1));
  }
  FitSpec spec;
  spec.name = data.name;
  spec.control_points = n;
  spec.parameters = Parameterization::kChordLength;
  spec.knots = KnotRule::kAveraged;
  PublishedCurve curve;
  curve.problem = CheckedFit(std::move(data), spec);
  curve.start = curve.problem->curve_fit()->Variables(first);
  return curve;
}

}  // namespace batten
