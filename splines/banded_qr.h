#ifndef BATTEN_SPLINES_BANDED_QR_H_
#define BATTEN_SPLINES_BANDED_QR_H_

#include <vector>

#include "splines/fold_rows.h"
#include "splines/row_block.h"

namespace batten {

/// QR of the rows, block by block, inside their band: each block is folded by Householder
/// reflections into the triangle of its columns. Rows that wrap around the end of a cyclic matrix
/// are kept in a triangle of their own and folded in by Finish(): from column 0 on they are carried
/// along the band, with the last width - 1 columns as a border, until they have decayed below
/// 1e-140 times the scale, usually after a few hundred columns. Small overlapping problems (n < 2
/// width - 1) are held dense. Rows of graded shapes are exchanged so that the heavy ones come first
/// (fold_graded_rows.h): weights from 1e-16 to 1e16 beside each other keep their digits.
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

  /// Solves with R or its transpose, in place, x n x dimension; only with full_rank().
  void SolveTriangle(int dimension, double* x) const;
  void SolveTransposedTriangle(int dimension, double* x) const;

  int width() const { return width_; }  // of the band
  /// Columns whose rows of R stand in the band: n for open matrices, n - 2 (width - 1) for cyclic
  /// ones (0 where they overlap), whose last columns, the tail, are filled.
  int num_band_columns() const { return shape_.num_columns - num_tail_columns(); }
  int num_tail_columns() const { return overlaps_ ? shape_.num_columns : 2 * num_border_; }
  /// Row j of R: `window`, width entries from column j on as far as they are in the band's columns
  /// (zeros for rows of the tail); `tail`, those in its columns; `right`, what Q is turned into:
  /// ||R P - right||^2 is ||A P - Q||^2 up to a constant.
  void CopyRow(int j, double* window, double* tail, double* right) const;

 private:
  class RowBuffer;
  void FoldPending();
  /// FoldAny, heavy rows first where they are graded.
  double Fold(int width, int dimension, PackedRows rows, double* triangle,
              std::ptrdiff_t triangle_stride) const;
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

}  // namespace batten

#endif  // BATTEN_SPLINES_BANDED_QR_H_
