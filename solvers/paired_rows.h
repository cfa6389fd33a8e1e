#ifndef BATTEN_SOLVERS_PAIRED_ROWS_H_
#define BATTEN_SOLVERS_PAIRED_ROWS_H_

#include <Eigen/SparseCore>
#include <vector>

#include "splines/banded_rows.h"

namespace batten {

/// The square collocation matrix with row j that of the data point paired with control point j, row
/// by row: where blocks have one or two rows each, these stream faster than the blocks do.
class PairedRows {
 public:
  PairedRows() = default;
  /// As many rows as columns; control_point_of_row[row] = j, each j once.
  PairedRows(const BandedRows& rows, const std::vector<int>& control_point_of_row);

  int size() const { return static_cast<int>(first_columns_.size()); }  // n
  /// residuals = Q - A P, n x d, P n x d row-major.
  void Residuals(const double* control_points, Points* residuals) const;
  /// Entries of one place (a basis that wraps onto itself) added.
  Eigen::SparseMatrix<double, Eigen::RowMajor> ToSparse() const;

 private:
  template <int kWidth, int kDimension>
  void ResidualsFixed(const double* control_points, double* residuals) const;

  int width_ = 0;
  std::vector<int> first_columns_;    // entries are in width_ columns from here on, modulo n
  std::vector<double> coefficients_;  // n x width
  Points data_;                       // Q, n x d
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_PAIRED_ROWS_H_
