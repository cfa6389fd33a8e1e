#include "cost_functions/foot_feet.h"

#include <limits>

#include "splines/closest_point.h"

namespace batten {

void FindFeet(const BsplineBasis& basis, int dimension, int control_point_offset,
              const Points& points, Eigen::VectorXd* all) {
  const Points control_points = Eigen::Map<const Points>(all->data() + control_point_offset,
                                                         basis.num_control_points(), dimension);
  const BsplineCurve curve(basis, control_points);
  // Never from the last feet: of two as near as each other the same is found each time.
  Eigen::VectorXd feet = Eigen::VectorXd::Constant(points.rows(), basis.domain_begin());
  if (control_points.allFinite()) ClosestPoint(curve).FindAll(points, 1, &feet, nullptr);
  for (double& t : feet) t = PastTheEnd(basis, t);
  all->tail(feet.size()) = feet;
}

bool FootFollows(const BsplineBasis& basis, const CurvePlace& place, double squared_speed,
                 double curvature, double largest) {
  if (!place.moves) return false;
  // Where control points differ by rounding alone there is no direction, and all of it is a foot.
  constexpr double kRoundings = 16.0 * std::numeric_limits<double>::epsilon();
  const double length = basis.knots()[place.span + 1] - basis.knots()[place.span];
  const double noise = kRoundings * basis.degree() * largest / length;
  if (!(squared_speed > noise * noise)) return false;
  // At a corner, a knot where the curve is only continuous, a foot mostly stays.
  if (basis.knots()[place.span] == place.t) {
    int multiplicity = 1;
    while (place.span - multiplicity >= 0 && basis.knots()[place.span - multiplicity] == place.t) {
      ++multiplicity;
    }
    if (multiplicity >= basis.degree()) return false;
  }
  // Nearer to a centre of curvature (1 there is none, 0 it is there) a foot moves so fast that its
  // derivative says nothing beyond the next rounding.
  constexpr double kLeastCurvature = 1e-8;
  return curvature > kLeastCurvature * squared_speed;
}

}  // namespace batten
