#ifndef BATTEN_SPLINES_BEZIER_CONVERSION_H_
#define BATTEN_SPLINES_BEZIER_CONVERSION_H_

#include <optional>
#include <string>
#include <vector>

#include "splines/bezier.h"
#include "splines/bspline_curve.h"

namespace batten {

/// A Bezier curve that stands for the stretch [begin, end] of a longer curve.
struct BezierSpan {
  BezierCurve curve;
  double begin = 0.0;
  double end = 1.0;
};

/// The polynomial pieces of a B-spline curve, open or periodic, in order: one per span that is not
/// empty, by the blossom (Ramshaw 1987; Farin, sec. 8.6). Neighbours, and last and first where it
/// is periodic, share their end point. Convex combinations of control points, which do not
/// overflow.
std::vector<BezierSpan> BezierSpansOf(const BsplineCurve& curve);

/// The B-spline curve that runs through `spans`, each over its own interval: knots stand p-fold at
/// the joints. Lower degrees are raised to the highest, which must be 1 to kMaxDegree. Periodic:
/// the last span ends where the first begins, and a turn is as long as all intervals. Nothing, with
/// one sentence in `error` (may be null), for no spans, other degrees or dimensions, intervals that
/// do not follow each other, and ends that do not meet to rounding.
std::optional<BsplineCurve> BsplineThrough(const std::vector<BezierSpan>& spans, bool periodic,
                                           std::string* error);

}  // namespace batten

#endif  // BATTEN_SPLINES_BEZIER_CONVERSION_H_
