#ifndef BATTEN_EXPERIMENTS_CURVE_SHAPE_H_
#define BATTEN_EXPERIMENTS_CURVE_SHAPE_H_

#include "splines/bspline_curve.h"

namespace batten {

/// What a fitted curve is like, whatever its energy: the lower energy is often the worse curve,
/// since a loop that no data point is nearest to costs nothing.
struct CurveShape {
  double length = 0.0;
  /// By how much the tangent turns all along the curve, to and fro added up, in radians: corners
  /// and the seam of closed curves count by their angle, cusps by pi. A circle has 2 pi.
  double turning = 0.0;
  /// In the plane: the same with its sign, over 2 pi. A whole number for closed curves; at cusps
  /// the sign is arbitrary. NaN in other dimensions.
  double rotation = 0.0;
  /// The largest distance of a point of the curve from the data point nearest to it: found to 0.1 %
  /// or 1e-5 of the curve's length, never too large.
  double max_distance_to_data = 0.0;
  /// Free arcs that are loops. A free arc is a longest stretch of the curve that no data point has
  /// its foot on: between neighbouring feet, or from an end of an open curve to the nearest of
  /// them. It counts as a loop if it is longer than 4 times what is usual (the median of the
  /// lengths between neighbouring feet) and than 3 times the straight way between its ends. So the
  /// way across a gap in the data is none, and neither are the bends of a curve between its data. A
  /// loop of length l on a stretch that would else have length h is counted from l > 2 h on. Where
  /// all arcs run away none is unusual: any that is longer than 4 diagonals of the data's box
  /// counts.
  int num_free_loops = 0;
  double longest_free_arc = 0.0;
};

/// `feet` are the parameters of the points of the curve closest to the `data`, one for each row, at
/// least one. The dimension is 2 or more. What overflows is not finite.
CurveShape MeasureShape(const BsplineCurve& curve, const Points& data, const Eigen::VectorXd& feet);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_CURVE_SHAPE_H_
