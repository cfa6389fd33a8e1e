#ifndef BATTEN_EXPERIMENTS_MAX_DISTANCE_GROWTH_H_
#define BATTEN_EXPERIMENTS_MAX_DISTANCE_GROWTH_H_

#include <functional>
#include <optional>

#include "experiments/tracked_curve.h"

namespace batten {

/// A first curve within `bound` of all points, by inserting knots: least squares at the given
/// parameters, then every span in which a point is too far gets a knot between its points, as long
/// as the conditions of Schoenberg and Whitney hold; where they would not, the interpolating
/// spline. Parameters do not decrease, on [0, 1]; points that follow one another differ. Nothing if
/// the interpolating spline misses the bound too, or `stop` says so.
std::optional<TrackedCurve> GrowCurve(int degree, bool closed, const Points& points,
                                      const Eigen::VectorXd& parameters, double bound,
                                      const std::function<bool(int num_control_points)>& stop);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_MAX_DISTANCE_GROWTH_H_
