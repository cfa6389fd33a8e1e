#ifndef BATTEN_SPLINES_BANDED_QR_H_
#define BATTEN_SPLINES_BANDED_QR_H_

#include <string>
#include <vector>

#include "splines/row_block.h"

namespace batten {

/// QR of the rows, block by block, inside their band: each block is folded by Householder
/// reflections into the triangle of its columns; cyclic matrices carry width - 1 border columns
/// along, flushed to zero once they have decayed below 1e-200 times the scale (denormals would
/// cost several times as much). Small overlapping problems (n < 2 width - 1) are held dense.
class BandedQr : public RowConsumer {
 public:
  explicit BandedQr(const RowShape& shape);
  void Consume(const RowBlock& block) override;
  /// Call once after the last row.
  void Finish();

  /// Smallest |R_jj| / largest |R_jj|: an upper bound on the reciprocal condition number.
  double DiagonalRatio() const;
  /// True if every |R_jj| is above kRankTolerance times the largest.
  bool full_rank() const { return full_rank_; }
  static constexpr double kRankTolerance = 1e-11;

  /// Only with full_rank(): the minimiser of ||A P - Q||, n x d.
  void Solve(Points* control_points) const;
  /// ||A P - Q||^2 at the minimiser.
  double residual_sum_of_squares() const { return residual_; }

 private:
  RowShape shape_;
  double residual_ = 0.0;
  bool full_rank_ = false;
};

/// The minimiser of ||A P - Q|| that is nearest to `start` (n x d) in the Euclidean norm of control
/// points, for any rank. What was done is said in the result.
struct NearestSolution {
  Points control_points;
  int rank = 0;                  // numerical rank of A with BandedQr::kRankTolerance
  bool unique = false;           // rank == n
  double diagonal_ratio = 0.0;
  std::string method;            // "banded QR", "complete orthogonal decomposition", ...
};
NearestSolution SolveNearest(const RowSource& rows, const Points& start);

}  // namespace batten

#endif  // BATTEN_SPLINES_BANDED_QR_H_
