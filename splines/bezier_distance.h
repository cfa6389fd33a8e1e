#ifndef BATTEN_SPLINES_BEZIER_DISTANCE_H_
#define BATTEN_SPLINES_BEZIER_DISTANCE_H_

#include "splines/bezier.h"

namespace batten {

/// What a number lies between, and where on the curve the lower bound was met.
struct DistanceBounds {
  double lower = 0.0;
  double upper = 0.0;
  double t = 0.0;
};

/// The largest distance of a curve's points from the segment [a, b], in the units of the points.
/// Distance from a convex set is a convex function, so that no point of the curve is farther than
/// the farthest control point: parts are halved until upper <= (1 + accuracy) lower, or until all
/// that may still be farther than `ignored` is settled (0: nothing is ignored), or 40 times.
/// Without rounding; a coordinate is off by BezierRounding() at most. `accuracy` > 0.
DistanceBounds BoundSegmentDistance(int degree, int dimension, const double* points,
                                    const double* a, const double* b, double accuracy,
                                    double ignored);

/// The Hausdorff distance of a curve from the polyline of `vertices` (k x d), the curve's points at
/// the increasing `parameters` (k, from 0 to 1), certified: upper >= it, to rounding included.
///
/// Upper: each part's largest distance from its own segment. It bounds the other direction too: the
/// part's projection onto the line of its segment begins and ends in the segment's ends, so that
/// every point of the segment is the foot of some point of the part. Lower: the distance of the
/// point that is farthest from its own segment from the whole polyline; that may be much less where
/// the polyline passes it elsewhere. std::logic_error for other sizes or parameters.
DistanceBounds BoundHausdorffDistance(const BezierCurve& curve, const Eigen::VectorXd& parameters,
                                      const Points& vertices);

/// Bound of the rounding in a coordinate of any point that some cuts of `points` lead to: a small
/// multiple of (n + 1) eps max |P|.
double BezierRounding(int degree, int dimension, const double* points);

}  // namespace batten

#endif  // BATTEN_SPLINES_BEZIER_DISTANCE_H_
