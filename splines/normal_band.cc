#include "splines/normal_band.h"

#include <algorithm>
#include <cmath>

#include "splines/row_pack.h"

namespace batten {
namespace {

/// Columns of [A | Q] whose inner products with all later columns are summed in one pass, so that
/// the sums stay in registers.
constexpr int ColumnsPerPass(int later_columns) { return later_columns > 7 ? 1 : 2; }

/// gram (row-major, kColumns x kColumns) = upper triangle of [A|Q]'[A|Q], from column kFirst on;
/// of Q'Q only the diagonal is needed but all is summed.
template <int kFirst, int kRows, int kColumns>
void AddGramRows(const RowPack* columns, int packs, double* gram) {
  constexpr int kCount = kColumns - kFirst;
  RowPack sum[kRows][kCount] = {};
  for (int i = 0; i < packs; ++i) {
    RowPack left[kRows];
    for (int r = 0; r < kRows; ++r) left[r] = columns[(kFirst + r) * packs + i];
    for (int k = 0; k < kCount; ++k) {
      const RowPack right = columns[(kFirst + k) * packs + i];
      for (int r = 0; r < kRows && r <= k; ++r) sum[r][k] += left[r] * right;
    }
  }
  for (int r = 0; r < kRows; ++r) {
    for (int k = r; k < kCount; ++k) {
      gram[(kFirst + r) * kColumns + kFirst + k] = SumOfLanes(sum[r][k]);
    }
  }
}

template <int kFirst, int kWidth, int kColumns>
void AddGramPasses(const RowPack* columns, int packs, double* gram) {
  if constexpr (kFirst < kWidth) {
    constexpr int kRows = kWidth - kFirst > 1 ? ColumnsPerPass(kColumns - kFirst) : 1;
    AddGramRows<kFirst, kRows, kColumns>(columns, packs, gram);
    AddGramPasses<kFirst + kRows, kWidth, kColumns>(columns, packs, gram);
  }
}

/// gram = the rows of [A|Q]'[A|Q] that belong to A, upper triangle; returns ||Q||^2.
template <int kWidth, int kDimension>
double BlockGram(const RowShape& shape, const RowBlock& block, double* gram) {
  const int packs = block.stride / kPackLanes;
  const RowPack* a = AsPacks(block.coefficients);
  const RowPack* q = AsPacks(block.right_hand_sides);
  // The kernel takes right-hand sides that follow the coefficients, as almost everywhere.
  if (kWidth > 0 && q == a + shape.width * packs) {
    if constexpr (kWidth > 0) AddGramPasses<0, kWidth, kWidth + kDimension>(a, packs, gram);
  } else {
    const int columns = shape.width + shape.dimension;
    for (int j = 0; j < shape.width; ++j) {
      double* row = gram + j * columns;
      for (int k = j; k < shape.width; ++k) row[k] = DotPacks(a + j * packs, a + k * packs, packs);
      for (int c = 0; c < shape.dimension; ++c) {
        row[shape.width + c] = DotPacks(a + j * packs, q + c * packs, packs);
      }
    }
  }
  return DotPacks(q, q, shape.dimension * packs);
}

}  // namespace

NormalBand::NormalBand(const RowShape& shape)
    : shape_(shape),
      band_(static_cast<std::size_t>(shape.num_columns) * shape.width, 0.0),
      right_hand_side_(Points::Zero(shape.num_columns, shape.dimension)),
      gram_(static_cast<std::size_t>(shape.width) * (shape.width + shape.dimension)) {}

template <int kWidth, int kDimension>
void NormalBand::Add(const RowBlock& block) {
  double* const gram = gram_.data();
  squared_norm_of_data_ += BlockGram<kWidth, kDimension>(shape_, block, gram);
  const int width = kWidth > 0 ? kWidth : shape_.width;
  const int d = kWidth > 0 ? kDimension : shape_.dimension;
  for (int j = 0; j < width; ++j) {
    const int column = WrappedColumn(block.first_column + j);
    const double* row = gram + j * (width + d);
    double* target = band_.data() + static_cast<std::size_t>(column) * width;
    for (int k = j; k < width; ++k) target[k - j] += row[k];
    double* right = right_hand_side_.data() + static_cast<std::size_t>(column) * d;
    for (int c = 0; c < d; ++c) right[c] += row[width + c];
  }
}

template <int kWidth, int kDimension, int kRows>
void NormalBand::AddFew(const RowBlock& block) {
  // Zeros behind each row: the band's rows are then all updated at full width.
  double row[kRows][2 * kWidth] = {};
  double data[kRows][kDimension];
  for (int i = 0; i < kRows; ++i) {
    for (int j = 0; j < kWidth; ++j) row[i][j] = block.coefficients[j * kRowPack + i];
    for (int c = 0; c < kDimension; ++c) {
      data[i][c] = block.right_hand_sides[c * kRowPack + i];
      squared_norm_of_data_ += data[i][c] * data[i][c];
    }
  }
  for (int j = 0; j < kWidth; ++j) {
    const auto column = static_cast<std::size_t>(WrappedColumn(block.first_column + j));
    double* const target = band_.data() + column * kWidth;
    for (int k = 0; k < kWidth; ++k) {
      double sum = row[0][j] * row[0][j + k];
      for (int i = 1; i < kRows; ++i) sum += row[i][j] * row[i][j + k];
      target[k] += sum;
    }
    double* const right = right_hand_side_.data() + column * kDimension;
    for (int c = 0; c < kDimension; ++c) {
      double sum = row[0][j] * data[0][c];
      for (int i = 1; i < kRows; ++i) sum += row[i][j] * data[i][c];
      right[c] += sum;
    }
  }
}

void NormalBand::Consume(const RowBlock& block) {
  WithFixedShape(shape_.width, shape_.dimension, [&](auto width, auto dimension) {
    if constexpr (width > 0) {
      if (block.num_rows == 1) return AddFew<width, dimension, 1>(block);
      if (block.num_rows == 2) return AddFew<width, dimension, 2>(block);
      if (block.num_rows == 3) return AddFew<width, dimension, 3>(block);
    }
    Add<width, dimension>(block);
  });
}

NormalBand NormalBand::FromRows(const RowSource& source) {
  NormalBand matrix(source.shape());
  source.Stream(&matrix);
  return matrix;
}

bool NormalBand::Overlaps() const {
  return shape_.cyclic && shape_.num_columns < 2 * shape_.width - 1;
}

void NormalBand::MultiplyRow(int j, const double* v, double* product) const {
  const int d = shape_.dimension;
  const int n = shape_.num_columns;
  double* target = product + static_cast<std::size_t>(j) * d;
  std::fill_n(target, d, 0.0);
  const auto add = [&](int row, int k, int column) {
    const double entry = band_[static_cast<std::size_t>(row) * shape_.width + k];
    const double* source = v + static_cast<std::size_t>(column) * d;
    for (int c = 0; c < d; ++c) target[c] += entry * source[c];
  };
  for (int k = shape_.width - 1; k > 0; --k) {
    if (j - k < 0 && !shape_.cyclic) continue;
    const int before = j >= k ? j - k : ((j - k) % n + n) % n;
    add(before, k, before);
  }
  for (int k = 0; k < shape_.width; ++k) {
    if (j + k >= n && !shape_.cyclic) break;
    add(j, k, WrappedColumn(j + k));
  }
}

template <int kWidth, int kDimension>
void NormalBand::MultiplyInside(int begin, int end, const double* v, double* product) const {
  if constexpr (kWidth < 0) {
    const int width = shape_.width;
    const int d = shape_.dimension;
    for (int j = begin; j < end; ++j) {
      const double* entry = band_.data() + static_cast<std::size_t>(j) * width;
      const double* near = v + static_cast<std::size_t>(j) * d;
      for (int c = 0; c < d; ++c) {
        double sum = 0.0;
        for (int k = width - 1; k > 0; --k) sum += entry[k - k * width] * near[c - k * d];
        for (int k = 0; k < width; ++k) sum += entry[k] * near[k * d + c];
        product[static_cast<std::size_t>(j) * d + c] = sum;
      }
    }
  } else {
    for (int j = begin; j < end; ++j) {
      const double* entry = band_.data() + static_cast<std::size_t>(j) * kWidth;
      const double* near = v + static_cast<std::size_t>(j) * kDimension;
      double sum[kDimension] = {};
      for (int k = kWidth - 1; k > 0; --k) {
        for (int c = 0; c < kDimension; ++c) {
          sum[c] += entry[k - k * kWidth] * near[c - k * kDimension];
        }
      }
      for (int k = 0; k < kWidth; ++k) {
        for (int c = 0; c < kDimension; ++c) sum[c] += entry[k] * near[k * kDimension + c];
      }
      double* const target = product + static_cast<std::size_t>(j) * kDimension;
      for (int c = 0; c < kDimension; ++c) target[c] = sum[c];
    }
  }
}

void NormalBand::Multiply(const double* v, double* product) const {
  const int n = shape_.num_columns;
  const int reach = std::max(shape_.width - 1, 0);
  const int inside_begin = std::min(reach, n);
  const int inside_end = std::max(inside_begin, n - reach);
  for (int j = 0; j < inside_begin; ++j) MultiplyRow(j, v, product);
  WithFixedShape(shape_.width, shape_.dimension, [&](auto width, auto dimension) {
    MultiplyInside<width, dimension>(inside_begin, inside_end, v, product);
  });
  for (int j = inside_end; j < n; ++j) MultiplyRow(j, v, product);
}

void NormalBand::NormalResidual(const double* control_points, double* residual) const {
  Multiply(control_points, residual);
  const double* right = right_hand_side_.data();
  for (Eigen::Index k = 0; k < right_hand_side_.size(); ++k) residual[k] = right[k] - residual[k];
}

template <typename Visitor>
void NormalBand::VisitUpperEntries(const Visitor& visit) const {
  const int n = shape_.num_columns;
  for (int j = 0; j < n; ++j) {
    for (int k = 0; k < shape_.width && (shape_.cyclic || j + k < n); ++k) {
      visit(j, k, WrappedColumn(j + k), band_[static_cast<std::size_t>(j) * shape_.width + k]);
    }
  }
}

std::vector<double> NormalBand::Diagonal() const {
  std::vector<double> diagonal(shape_.num_columns, 0.0);
  if (!Overlaps()) {
    for (int j = 0; j < shape_.num_columns && shape_.width > 0; ++j) {
      diagonal[j] = band_[static_cast<std::size_t>(j) * shape_.width];
    }
    return diagonal;
  }
  VisitUpperEntries([&](int row, int k, int column, double entry) {
    if (row == column) diagonal[row] += k == 0 ? entry : 2.0 * entry;
  });
  return diagonal;
}

std::vector<double> NormalBand::AbsoluteRowSums() const {
  std::vector<double> sums(shape_.num_columns, 0.0);
  if (Overlaps()) {
    // Entries on one place add before their absolute value is taken.
    const Eigen::VectorXd dense = ToDense().cwiseAbs().rowwise().sum();
    std::copy_n(dense.data(), sums.size(), sums.begin());
    return sums;
  }
  const int width = shape_.width;
  const int inside_end = std::max(shape_.num_columns - width + 1, 0);
  for (int j = 0; j < shape_.num_columns; ++j) {
    const double* entry = band_.data() + static_cast<std::size_t>(j) * width;
    if (width > 0) sums[j] += std::abs(entry[0]);
    for (int k = 1; k < width; ++k) {
      if (j >= inside_end && j + k >= shape_.num_columns && !shape_.cyclic) break;
      const double size = std::abs(entry[k]);
      sums[j] += size;
      sums[j < inside_end ? j + k : WrappedColumn(j + k)] += size;
    }
  }
  return sums;
}

Eigen::MatrixXd NormalBand::ToDense() const {
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(shape_.num_columns, shape_.num_columns);
  VisitUpperEntries([&](int row, int k, int column, double entry) {
    dense(row, column) += entry;
    if (k > 0) dense(column, row) += entry;
  });
  return dense;
}

}  // namespace batten
