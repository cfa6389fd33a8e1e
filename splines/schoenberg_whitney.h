#ifndef BATTEN_SPLINES_SCHOENBERG_WHITNEY_H_
#define BATTEN_SPLINES_SCHOENBERG_WHITNEY_H_

#include <vector>

#include "splines/bspline_basis.h"

namespace batten {

/// A run of consecutive control points with fewer distinct parameters inside the union of their
/// basis functions' supports than there are control points.
struct DataShortage {
  int first_control_point = 0;
  int num_control_points = 0;  // 0: no shortage
  int num_parameters = 0;
};

/// The conditions of Schoenberg and Whitney: the collocation matrix has full column rank exactly if
/// each control point can be given a parameter of its own at which its basis function is not zero
/// (de Boor, A Practical Guide to Splines, ch. XIII; for periodic splines this is necessary, and
/// sufficient but for special cases such as even n on uniform knots hit at their ends). By Hall's
/// theorem a run of control points without enough parameters is what is in the way; the one with
/// the largest shortage is returned, the first and shortest of equals.
/// `parameters`: in the domain, in any order; equal ones count once. Time n + m log m.
DataShortage LargestDataShortage(const BsplineBasis& basis, std::vector<double> parameters);

}  // namespace batten

#endif  // BATTEN_SPLINES_SCHOENBERG_WHITNEY_H_
