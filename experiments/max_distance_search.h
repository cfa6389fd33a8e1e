#ifndef BATTEN_EXPERIMENTS_MAX_DISTANCE_SEARCH_H_
#define BATTEN_EXPERIMENTS_MAX_DISTANCE_SEARCH_H_

#include <optional>

#include "experiments/knot_removal.h"

namespace batten {

/// A curve with few control points, no data point farther from it than `bound`: knots are inserted
/// until it is so (GrowCurve) and then taken out again, one by one and in batches, while control
/// points, knots and feet move so that the rest stays within the bound (CurveWindow). Few, not
/// provably fewest: the search ends where no knot that it tries can go. What it keeps besides: the
/// conditions of Schoenberg and Whitney, and the curve near the chords of its data points.
///
/// `points`: m x d, d >= 2, neighbours differ, in a box of size about 1; `parameters` from 0 to 1,
/// not decreasing (closed: below 1). The same numbers give the same curve; a power of two does not
/// matter. Nothing if GrowCurve finds none or `watch` ends it.
std::optional<TrackedCurve> SearchFewControlPoints(int degree, bool closed, const Points& points,
                                                   const Eigen::VectorXd& parameters, double bound,
                                                   const SearchWatch& watch);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_MAX_DISTANCE_SEARCH_H_
