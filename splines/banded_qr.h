#ifndef BATTEN_SPLINES_BANDED_QR_H_
#define BATTEN_SPLINES_BANDED_QR_H_

#include <string>
#include <vector>

#include "splines/row_block.h"

namespace batten {

/// QR of the rows, block by block, inside their band: each block is folded by Householder
/// reflections into the triangle of its columns. Rows that wrap around the end of a cyclic matrix
/// are kept in a triangle of their own and folded in by Finish(): from column 0 on they are carried
/// along the band, with the last width - 1 columns as a border, until they have decayed below
/// 1e-140 times the scale, usually after a few hundred columns. Small overlapping problems (n < 2
/// width - 1) are held dense.
class BandedQr : public RowConsumer {
 public:
  explicit BandedQr(const RowShape& shape);
  void Consume(const RowBlock& block) override;
  /// Call once after the last row.
  void Finish();

  /// Smallest |R_jj| / largest |R_jj|: an upper bound on the reciprocal condition number. 1 if
  /// there are no columns, 0 if all entries are zero, not a number if one is not finite.
  double DiagonalRatio() const { return ratio_; }
  /// Largest |R_jj|, not a number if one is not finite.
  double LargestDiagonal() const { return largest_; }
  /// True if every |R_jj| is above kRankTolerance times the largest.
  bool full_rank() const { return full_rank_; }
  static constexpr double kRankTolerance = 1e-11;

  /// Only with full_rank(): the minimiser of ||A P - Q||, n x d.
  void Solve(Points* control_points) const;
  /// ||A P - Q||^2 at the minimiser; only with full_rank().
  double residual_sum_of_squares() const { return residual_; }

  /// Products with R and its inverse, in place, x n x dimension: the norms ||R x|| and ||A x|| are
  /// equal, so that R stands for A in iterations. The inverses need full_rank().
  void MultiplyTriangle(int dimension, double* x) const;
  void MultiplyTransposedTriangle(int dimension, double* x) const;
  void SolveTriangle(int dimension, double* x) const;
  void SolveTransposedTriangle(int dimension, double* x) const;
  /// The right-hand side Q is turned into, n x d: ||R P - that||^2 is ||A P - Q||^2 up to a
  /// constant.
  Points TriangleRightHandSide() const;

 private:
  class RowBuffer;
  void FoldPending();
  /// Cyclic: the rest of the work, once all rows are there.
  void FoldWrapped();
  /// Folds the upper half of the wrapped rows' triangle along the band; what is left of them in
  /// the last 2 width - 2 columns goes to `last`.
  void CarryAlong(const std::vector<double>& reordered, RowBuffer* last);
  template <int kDimension>
  void SolveTriangleFixed(double* x) const;
  double DiagonalEntry(int j) const;
  const double* RightHandSide(int j) const;
  /// visit(column, entry) for the entries of row j of R beside the diagonal; j + 1 comes last,
  /// since its unknown is the last to be solved for.
  template <typename Visitor>
  void VisitRow(int j, const Visitor& visit) const;

  RowShape shape_;
  bool overlaps_;                 // cyclic, n < 2 width - 1: one dense triangle
  int width_;                     // of the triangle
  int num_border_;                // width - 1 if cyclic without overlap
  int num_swept_;                 // rows of R in the band; the others are in dense_
  int row_size_;                  // width_ + dimension
  std::vector<double> triangle_;  // n x row_size_: (j, j), (j, j + 1), ..., right-hand sides
  std::vector<double> wrapped_;   // the same of the columns n - num_border_..n - 1, 0, 1, ...
  std::vector<double> border_;    // num_bordered_ x num_border_
  std::vector<double> dense_;     // the last rows of cyclic R: as triangle_, with full rows
  int num_bordered_ = 0;
  std::vector<double> pending_;  // rows of one window, packed
  int pending_column_ = 0;
  int num_pending_ = 0;
  double residual_ = 0.0;
  double largest_ = 0.0;
  double ratio_ = 0.0;
  bool full_rank_ = false;
};

/// The minimiser of ||A P - Q|| that is nearest to `start` (n x d) in the Euclidean norm of control
/// points, for any rank. What was done is said in the result:
/// - "banded QR": A has full rank.
/// - "complete orthogonal decomposition": it has not; singular values below about kRankTolerance
///   times the largest are taken as zero. Up to 500 columns.
/// - "CGLS, ... steps": it has not, and there are more columns; the rank is not known (-1).
/// Directions
///   whose singular value is far below 1e-5 times the largest may not have moved from the start.
/// - "none, ...": rows or start are not finite; the start is returned.
struct NearestSolution {
  Points control_points;
  int rank = -1;        // numerical rank of A with BandedQr::kRankTolerance; -1: not known
  bool unique = false;  // rank == n
  double diagonal_ratio = 0.0;
  std::string method;  // "banded QR", "complete orthogonal decomposition", ...
};
NearestSolution SolveNearest(const RowSource& rows, const Points& start);

}  // namespace batten

#endif  // BATTEN_SPLINES_BANDED_QR_H_
