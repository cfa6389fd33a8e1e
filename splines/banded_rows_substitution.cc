#include <algorithm>
#include <numeric>
#include <vector>

#include "splines/banded_rows.h"
#include "splines/row_pack.h"

namespace batten {
namespace {

using SparseRowMajor = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// Columns first, first + 1, ..., first + length - 1, modulo their number if cyclic.
struct Arc {
  int first = 0;
  int length = 0;
};

/// The shortest arc over `columns` (sorted, without repetition) of n.
Arc ShortestArc(const std::vector<int>& columns, int n, bool cyclic) {
  if (columns.empty()) return {};
  Arc arc = {columns.front(), columns.back() - columns.front() + 1};
  if (!cyclic) return arc;
  // An arc that wraps leaves out one of the gaps between neighbours.
  for (std::size_t i = 1; i < columns.size(); ++i) {
    const int length = n - (columns[i] - columns[i - 1]) + 1;
    if (length < arc.length) arc = {columns[i], length};
  }
  return arc;
}

/// Columns a narrower row was padded with, say: they must not widen the arc.
bool IsZero(const double* coefficients, int num_rows) {
  return std::all_of(coefficients, coefficients + num_rows, [](double a) { return a == 0.0; });
}

/// A BandedRows' rows in the unknowns Y of P = offset + Z Y, in the order of their new columns.
class SubstitutedRows : public RowSource {
 public:
  SubstitutedRows(const BandedRows& rows, const SparseRowMajor& z, const Points& offset);
  RowShape shape() const override { return shape_; }
  void Stream(RowConsumer* consumer) const override;

 private:
  std::vector<int> TouchedColumns(const RowBlock& block) const;
  void Substitute(const RowBlock& block, int first_column, double* coefficients,
                  double* right_hand_sides) const;

  const BandedRows& rows_;
  const SparseRowMajor& z_;
  const Points& offset_;
  RowShape shape_;
  std::vector<int> first_columns_;  // by block
  std::vector<std::size_t> order_;  // of the blocks, by first column
};

SubstitutedRows::SubstitutedRows(const BandedRows& rows, const SparseRowMajor& z,
                                 const Points& offset)
    : rows_(rows), z_(z), offset_(offset), shape_(rows.shape()) {
  shape_.num_columns = static_cast<int>(z.cols());
  shape_.width = 0;
  for (std::size_t index = 0; index < rows.num_blocks(); ++index) {
    const Arc arc =
        ShortestArc(TouchedColumns(rows.block(index)), shape_.num_columns, shape_.cyclic);
    first_columns_.push_back(arc.first);
    shape_.width = std::max(shape_.width, arc.length);
  }
  for (int& first : first_columns_) {
    if (!shape_.cyclic) first = std::min(first, shape_.num_columns - shape_.width);
  }
  order_.resize(rows.num_blocks());
  std::iota(order_.begin(), order_.end(), 0);
  std::stable_sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
    return first_columns_[a] < first_columns_[b];
  });
}

std::vector<int> SubstitutedRows::TouchedColumns(const RowBlock& block) const {
  std::vector<int> columns;
  for (int j = 0; j < rows_.shape().width; ++j) {
    if (IsZero(block.coefficients + j * block.stride, block.num_rows)) continue;
    const int old_column = (block.first_column + j) % rows_.shape().num_columns;
    for (SparseRowMajor::InnerIterator it(z_, old_column); it; ++it) {
      if (it.value() != 0.0) columns.push_back(static_cast<int>(it.col()));
    }
  }
  std::sort(columns.begin(), columns.end());
  columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
  return columns;
}

void SubstitutedRows::Substitute(const RowBlock& block, int first_column, double* coefficients,
                                 double* right_hand_sides) const {
  const int stride = block.stride;
  std::copy_n(block.right_hand_sides, shape_.dimension * stride, right_hand_sides);
  std::fill_n(coefficients, shape_.width * stride, 0.0);
  for (int j = 0; j < rows_.shape().width; ++j) {
    const double* a = block.coefficients + j * stride;
    if (IsZero(a, block.num_rows)) continue;
    const int old_column = (block.first_column + j) % rows_.shape().num_columns;
    for (int c = 0; c < shape_.dimension; ++c) {
      const double known = offset_(old_column, c);
      for (int i = 0; i < stride; ++i) right_hand_sides[c * stride + i] -= a[i] * known;
    }
    for (SparseRowMajor::InnerIterator it(z_, old_column); it; ++it) {
      if (it.value() == 0.0) continue;
      const int n = shape_.num_columns;
      const int k = (static_cast<int>(it.col()) - first_column + n) % n;
      for (int i = 0; i < stride; ++i) coefficients[k * stride + i] += a[i] * it.value();
    }
  }
}

void SubstitutedRows::Stream(RowConsumer* consumer) const {
  const int columns = shape_.width + shape_.dimension;
  RowStorage storage(static_cast<std::size_t>(columns) * kMaxRowsPerBlock);
  double* const coefficients = storage.data();
  for (const std::size_t index : order_) {
    RowBlock block = rows_.block(index);
    double* const right_hand_sides = coefficients + shape_.width * block.stride;
    Substitute(block, first_columns_[index], coefficients, right_hand_sides);
    block.first_column = first_columns_[index];
    block.coefficients = coefficients;
    block.right_hand_sides = right_hand_sides;
    consumer->Consume(block);
  }
}

}  // namespace

BandedRows BandedRows::Substitute(const SparseRowMajor& z, const Points& offset) const {
  const SubstitutedRows substituted(*this, z, offset);
  return BandedRows({&substituted});
}

}  // namespace batten
