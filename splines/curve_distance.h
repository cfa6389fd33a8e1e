#ifndef BATTEN_SPLINES_CURVE_DISTANCE_H_
#define BATTEN_SPLINES_CURVE_DISTANCE_H_

#include "splines/points.h"

namespace batten {

/// A stretch [low, high] of one span by its p + 1 Bezier points, d coordinates each.
struct BezierStretch {
  int degree = 0;
  int dimension = 0;
  const double* points = nullptr;
  double low = 0.0;
  double high = 0.0;
};

/// f = |C - Q|^2 at t, slope = f' / 2, curvature = f'' / 2.
struct CurveDistance {
  double t = 0.0;
  double squared_distance = 0.0;
  double slope = 0.0;
  double curvature = 0.0;
  double rounding = 0.0;  ///< Differences of squared_distance below this mean nothing.
  bool is_foot = false;   ///< FindFoot ended here between low and high: f' is zero, to rounding.
};

/// Also at the stretch's end, where the next one may leave at an angle.
CurveDistance MeasureDistance(const BezierStretch& stretch, const double* point, double t);

/// By the second-order step of Hu & Wallner (2005), safeguarded: the lowest point of [low, high], a
/// part of the stretch on which f has one minimum, from `start`
/// in it. On other parts some minimum, no higher than at `start`, to rounding.
CurveDistance FindFoot(const BezierStretch& stretch, const double* point, double low, double start,
                       double high);

}  // namespace batten

#endif  // BATTEN_SPLINES_CURVE_DISTANCE_H_
