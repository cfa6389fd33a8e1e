#ifndef BATTEN_EXPERIMENTS_KNOT_REMOVAL_H_
#define BATTEN_EXPERIMENTS_KNOT_REMOVAL_H_

#include <functional>

#include "experiments/tracked_curve.h"

namespace batten {

/// Asked now and then, with the number of control points so far and which part of the work is done
/// (0..1, a guess); false ends the work.
using SearchWatch = std::function<bool(int num_control_points, double fraction)>;

/// Least number of control points that are left.
inline int FewestControlPoints(int degree, bool closed) { return closed ? 3 : degree + 1; }

/// Each control point has a data point of its own (Schoenberg and Whitney): a curve that its data
/// do not determine may do anything between them.
bool IsDetermined(const TrackedCurve& curve);

/// Takes knots out of a curve within `bound` of its data, one by one and in batches, as long as the
/// rest can move so that it stays within: each alone, its neighbourhood moving (CurveWindow); the
/// whole curve relaxed; those that cost least in batches that are halved where they fail, the whole
/// curve moving. False if `watch` ended it.
bool RemoveKnots(double bound, const SearchWatch& watch, TrackedCurve* curve);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_KNOT_REMOVAL_H_
