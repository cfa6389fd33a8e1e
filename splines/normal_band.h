#ifndef BATTEN_SPLINES_NORMAL_BAND_H_
#define BATTEN_SPLINES_NORMAL_BAND_H_

#include <vector>

#include "splines/large_array.h"
#include "splines/row_block.h"

namespace batten {

/// N = A'A in its band and B = A'Q, summed up in one pass over the rows. E = ||A P - Q||^2 has
/// gradient 2 (N P - B) and Hessian 2 N, for each coordinate alike.
///
/// Entry band[j * width + k], k = 0..width-1, stands for N(j, j + k) and N(j + k, j), column
/// indices modulo n where cyclic. With n < 2 width - 1 several entries fall on one place of N:
/// they add (k > 0 with j + k = j modulo n counts twice on the diagonal).
class NormalBand : public RowConsumer {
 public:
  explicit NormalBand(const RowShape& shape);  ///< All zero.
  void Consume(const RowBlock& block) override { Consume(block, &scratch_); }
  /// One pass over `source`, which `threads` >= 1 share if it has parts: the bits do not depend on
  /// their number.
  void AddRows(const RowSource& source, int threads);
  /// Zero, then AddRows().
  static NormalBand FromRows(const RowSource& source, int threads = 1);

  int size() const { return shape_.num_columns; }  // n
  int width() const { return shape_.width; }
  int dimension() const { return shape_.dimension; }
  bool cyclic() const { return shape_.cyclic; }
  const LargeArray& band() const { return band_; }
  LargeArray& band() { return band_; }
  Eigen::Map<const Points> right_hand_side() const {  // B, n x d
    return {right_hand_side_.data(), size(), dimension()};
  }
  double squared_norm_of_data() const { return scratch_.squared_norm_of_data; }  // ||Q||^2

  /// product = N V, n x d row-major each; must not overlap.
  void Multiply(const double* v, double* product) const;
  /// residual = B - N P: half the negative gradient.
  void NormalResidual(const double* control_points, double* residual) const;
  std::vector<double> Diagonal() const;
  /// Row sums of |N|: by Gershgorin and for a diagonal step rule.
  std::vector<double> AbsoluteRowSums() const;
  /// The largest of them: ||N|| in the norms of rows and of columns.
  double LargestRowSum() const;
  Eigen::MatrixXd ToDense() const;

 private:
  class Part;
  /// What a thread needs of its own.
  struct Scratch {
    explicit Scratch(const RowShape& shape)
        : gram(static_cast<std::size_t>(shape.width) * (shape.width + shape.dimension)) {}
    std::vector<double> gram;  // width x (width + dimension) of the block being consumed
    double squared_norm_of_data = 0.0;
  };
  void Consume(const RowBlock& block, Scratch* scratch);
  void Add(const RowBlock& block, Scratch* scratch);
  /// Consume() for a block of one pack with kRows rows, row by row into the band: sums over packs
  /// that are half empty cost more than the rows.
  template <int kWidth, int kDimension, int kRows>
  void AddFew(const RowBlock& block, Scratch* scratch);
  /// Several entries of the band stand on one place of N.
  bool Overlaps() const;
  int WrappedColumn(int column) const {
    return column < shape_.num_columns ? column : column % shape_.num_columns;
  }
  /// visit(column, entry) for what stands in row j of N, any j.
  template <typename Visitor>
  void VisitRow(int j, const Visitor& visit) const;
  /// Of row j, any j, unless the band overlaps.
  double AbsoluteRowSum(int j) const;
  /// visit(row, sum) for each row, unless the band overlaps.
  template <typename Visitor>
  void VisitAbsoluteRowSums(const Visitor& visit) const;
  /// product = N V, or `right` - N V unless that is null; of row j, any j; of all rows.
  void MultiplyRow(int j, const double* v, const double* right, double* product) const;
  void MultiplyAll(const double* v, const double* right, double* product) const;
  /// Rows whose entries do not leave 0..n-1.
  template <int kWidth, int kDimension>
  void MultiplyInside(int begin, int end, const double* v, const double* right,
                      double* product) const;
  /// visit(row, k, column, entry) for every entry of the band that stands for one of N.
  template <typename Visitor>
  void VisitUpperEntries(const Visitor& visit) const;

  RowShape shape_;
  LargeArray band_;
  LargeArray right_hand_side_;
  Scratch scratch_;
};

}  // namespace batten

#endif  // BATTEN_SPLINES_NORMAL_BAND_H_
