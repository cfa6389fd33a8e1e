#ifndef BATTEN_SPLINES_BANDED_ROWS_H_
#define BATTEN_SPLINES_BANDED_ROWS_H_

#include <Eigen/SparseCore>
#include <vector>

#include "splines/large_array.h"
#include "splines/row_block.h"

namespace batten {

/// Row blocks kept in memory: the compiled form of linear terms. One pass over them is one
/// evaluation; (width + dimension) * 8 bytes move per row.
class BandedRows : public RowSource {
 public:
  /// Copies the rows of all sources (same num_columns, dimension and cyclic; widths may differ,
  /// narrower rows are padded), ordered by first_column, equal ones in the order of the sources.
  explicit BandedRows(const std::vector<const RowSource*>& sources);
  // Rows of a large fit fill hundreds of megabytes: they are moved, never copied by accident.
  BandedRows(BandedRows&&) = default;
  BandedRows& operator=(BandedRows&&) = default;
  BandedRows(const BandedRows&) = delete;
  BandedRows& operator=(const BandedRows&) = delete;

  RowShape shape() const override { return shape_; }
  void Stream(RowConsumer* consumer) const override;
  std::size_t num_blocks() const { return blocks_.size(); }
  /// Row numbers: order of Stream.
  RowBlock block(std::size_t index) const;
  /// As block(); starts to load the one after it. For passes over all rows: a block's columns are
  /// too short for the processor to see that they will be read on.
  RowBlock BlockAndPrefetch(std::size_t index) const;

  /// All vectors below: control points n x d and gradients n x d row-major, residuals in row order.
  /// ||A P - Q||^2; if `gradient` is not null, adds 2 A'(A P - Q) to it.
  double Evaluate(const double* control_points, double* gradient) const;
  /// ||A V||^2 without the right-hand sides: the exact gap of a quadratic when V = P - P*.
  double SquaredNormOfProduct(const double* v) const;
  /// residuals = Q - A P (the sign of the geometric iteration papers), num_rows x d.
  void Residuals(const double* control_points, double* residuals) const;
  /// product += A'R, R num_rows x d.
  void AddTransposedProduct(const double* r, double* product) const;
  /// sum_i |A_ij| (sum_k |A_ik||P_k| + |Q_i|) per entry of P, n x d: what one rounding of each
  /// product is worth in the gradient.
  void AddRoundingBound(const double* control_points, double* bound) const;

  /// The rows in other unknowns: P = offset + Z Y, Z n x n' sparse (a constraint's elimination).
  /// Rows stay blocks of contiguous columns (modulo n' if cyclic): the width is that of the longest
  /// among the blocks' shortest arcs of columns, and the order is that of the arcs' first columns.
  BandedRows Substitute(const Eigen::SparseMatrix<double, Eigen::RowMajor>& z,
                        const Points& offset) const;

 private:
  friend class BandedRowsBuilder;
  BandedRows() = default;
  struct Entry {
    int first_column;
    int num_rows;
    int stride;
    std::size_t begin;  // of the block's coefficients in data_
    int first_row;
  };
  RowShape shape_;
  std::vector<Entry> blocks_;
  LargeArray data_;
};

}  // namespace batten

#endif  // BATTEN_SPLINES_BANDED_ROWS_H_
