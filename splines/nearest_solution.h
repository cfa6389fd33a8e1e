#ifndef BATTEN_SPLINES_NEAREST_SOLUTION_H_
#define BATTEN_SPLINES_NEAREST_SOLUTION_H_

#include <string>

#include "splines/row_block.h"

namespace batten {

/// The minimiser of ||A P - Q|| that is nearest to `start` (n x d) in the Euclidean norm of control
/// points, for any rank, in time proportional to n. `method` says what was done:
/// - "banded QR": A has full rank. Of graded rows (row_block.h), whose weights say nothing of the
///   rank, where the rows scaled to norm 1 have full rank.
/// - "minimum norm, front by front": it has not. Stretches of columns are eliminated with column
///   exchanges, then what separates them; pivots up to BandedQr::kRankTolerance times the largest
///   diagonal entry of the band's R count as zero. Taken too where R has no small diagonal entry,
///   but a solve with it shows a singular value that small.
/// - "none, ...": rows or start are not finite; the start is returned.
/// @warning Pivots are no singular values: where these fall gradually to the tolerance and below,
/// A may lose a few more ranks than the pivots say, and control points then lie very far off.
struct NearestSolution {
  Points control_points;
  bool found = false;   // false with method "none, ...": the control points are the start
  int rank = -1;        // by pivots as above, which may be a few above that by singular values
  bool unique = false;  // rank == n
  double diagonal_ratio = 0.0;
  std::string method;
};
NearestSolution SolveNearest(const RowSource& rows, const Points& start);

}  // namespace batten

#endif  // BATTEN_SPLINES_NEAREST_SOLUTION_H_
