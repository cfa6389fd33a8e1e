#ifndef BATTEN_SPLINES_BEZIER_MEASURES_H_
#define BATTEN_SPLINES_BEZIER_MEASURES_H_

#include "splines/bezier.h"

namespace batten {

// Measures of a control polygon of n + 1 points, d coordinates each; none allocates. The chord runs
// from the first point to the last. Where it has length zero (a closed curve) the distance from it
// is the distance from that point. Overflow is the caller's care: squares of the squares of
// coordinates are taken.

/// A nonnegative quotient that is compared without being divided.
struct Quotient {
  double numerator = 0.0;
  double denominator = 1.0;
};

/// Squared distance of the inner control point that is farthest from the chord's line.
Quotient SquaredChordDistance(int degree, int dimension, const double* points);
/// The same compared with a squared limit: it ends at the first control point that is farther.
bool IsNearChord(int degree, int dimension, const double* points, double squared_limit);
/// The largest squared distance of a control point from the chord's segment: no point of the curve
/// is farther.
Quotient SquaredPolygonDistance(int degree, int dimension, const double* points);
/// The same compared with a squared limit, as IsNearChord().
bool IsNearSegment(int degree, int dimension, const double* points, double squared_limit);
/// Flatness: the sum of the squared distances of the inner control points from the chord's line.
Quotient Flatness(int degree, int dimension, const double* points);

/// The largest squared tangent of the angle between a leg of the control polygon and the chord: no
/// tangent of the curve turns further from it. Infinity from a right angle on, or where the chord
/// is zero and a leg is not. Legs no longer than `rounding` have no direction and are left out;
/// those that lead no farther than that from the chord's direction are taken as straight.
double SquaredLegSlope(int degree, int dimension, const double* points, double rounding);

/// Squared distance of a point from the segment [a, b].
double SquaredSegmentDistance(int dimension, const double* point, const double* a, const double* b);

/// The larger side of the control points' box.
double BoxSide(int degree, int dimension, const double* points);

/// The power of two that brings the largest coordinate to [1, 2), divided by which points lose no
/// bit, and their squares' squares neither overflow nor vanish; 1 for points that are all zero.
double UnitOf(const Points& points);

}  // namespace batten

#endif  // BATTEN_SPLINES_BEZIER_MEASURES_H_
