#ifndef BATTEN_SPLINES_BEZIER_HULL_H_
#define BATTEN_SPLINES_BEZIER_HULL_H_

namespace batten {

// Of the n + 1 control points of a planar curve (d = 2); in space a hull has a volume and no area
// of this kind. Neither function allocates.

/// The corners of the convex hull of planar points (d = 2), counter-clockwise from the one of least
/// x, by Andrew's chains: indices[0..result - 1], with room for n + 2. No corner but one of
/// repeated points; none inside an edge. Fewer than 3 where the points lie on a line.
int ConvexHull(int degree, const double* points, int* indices);
/// Area of the convex hull of planar points, in squared units.
double HullArea(int degree, const double* points);

}  // namespace batten

#endif  // BATTEN_SPLINES_BEZIER_HULL_H_
