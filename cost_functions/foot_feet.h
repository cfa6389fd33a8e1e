#ifndef BATTEN_COST_FUNCTIONS_FOOT_FEET_H_
#define BATTEN_COST_FUNCTIONS_FOOT_FEET_H_

#include "cost_functions/free_sites.h"

namespace batten {

/// Fills the tail of `all` with the foot points of `points` (scaled, m x d) on the curve whose n
/// control points stand at control_point_offset: certified ones, the same for the same control
/// points. Feet at the ends of an open curve are put a hair past them, where they are held.
void FindFeet(const BsplineBasis& basis, int dimension, int control_point_offset,
              const Points& points, Eigen::VectorXd* all);

/// Whether a foot at `place` moves as the control points do, from |dr/dt|^2 and the second
/// derivative of |r|^2 / 2 in t there. `largest`: coordinate of the span's control points in
/// absolute value.
bool FootFollows(const BsplineBasis& basis, const CurvePlace& place, double squared_speed,
                 double curvature, double largest);

}  // namespace batten

#endif  // BATTEN_COST_FUNCTIONS_FOOT_FEET_H_
