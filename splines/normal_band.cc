#include "splines/normal_band.h"

#include <algorithm>
#include <cmath>
#include <thread>

#include "splines/block_gram.h"
#include "splines/row_pack.h"

namespace batten {
NormalBand::NormalBand(const RowShape& shape)
    : shape_(shape),
      band_(LargeZeros(static_cast<std::size_t>(shape.num_columns) * shape.width)),
      right_hand_side_(LargeZeros(static_cast<std::size_t>(shape.num_columns) * shape.dimension)),
      scratch_(shape) {}

void NormalBand::Add(const RowBlock& block, Scratch* scratch) {
  double* const gram = scratch->gram.data();
  scratch->squared_norm_of_data += BlockGram(shape_, block, gram);
  WithFixedShape(shape_.width, shape_.dimension, [&](auto fixed_width, auto fixed_dimension) {
    const int width = fixed_width > 0 ? fixed_width : shape_.width;
    const int d = fixed_width > 0 ? fixed_dimension : shape_.dimension;
    for (int j = 0; j < width; ++j) {
      const int column = WrappedColumn(block.first_column + j);
      const double* row = gram + j * (width + d);
      double* target = band_.data() + static_cast<std::size_t>(column) * width;
      for (int k = j; k < width; ++k) target[k - j] += row[k];
      double* right = right_hand_side_.data() + static_cast<std::size_t>(column) * d;
      for (int c = 0; c < d; ++c) right[c] += row[width + c];
    }
  });
}

template <int kWidth, int kDimension, int kRows>
void NormalBand::AddFew(const RowBlock& block, Scratch* scratch) {
  double row[kRows][kWidth];
  double data[kRows][kDimension];
  bool has_data = false;  // fairing has none
  for (int i = 0; i < kRows; ++i) {
    for (int j = 0; j < kWidth; ++j) row[i][j] = block.coefficients[j * kRowPack + i];
    for (int c = 0; c < kDimension; ++c) {
      data[i][c] = block.right_hand_sides[c * kRowPack + i];
      has_data = has_data || data[i][c] != 0.0;
      scratch->squared_norm_of_data += data[i][c] * data[i][c];
    }
  }
  for (int j = 0; j < kWidth; ++j) {
    const auto column = static_cast<std::size_t>(WrappedColumn(block.first_column + j));
    double* const target = band_.data() + column * kWidth;
    for (int k = 0; k + j < kWidth; ++k) {
      double sum = row[0][j] * row[0][j + k];
      for (int i = 1; i < kRows; ++i) sum += row[i][j] * row[i][j + k];
      target[k] += sum;
    }
    if (!has_data) continue;
    double* const right = right_hand_side_.data() + column * kDimension;
    for (int c = 0; c < kDimension; ++c) {
      double sum = row[0][j] * data[0][c];
      for (int i = 1; i < kRows; ++i) sum += row[i][j] * data[i][c];
      right[c] += sum;
    }
  }
}

void NormalBand::Consume(const RowBlock& block, Scratch* scratch) {
  if (block.num_rows >= kRowPack) return Add(block, scratch);
  WithFixedShape(shape_.width, shape_.dimension, [&](auto width, auto dimension) {
    if constexpr (width > 0) {
      if (block.num_rows == 1) return AddFew<width, dimension, 1>(block, scratch);
      if (block.num_rows == 2) return AddFew<width, dimension, 2>(block, scratch);
      if (block.num_rows == 3) return AddFew<width, dimension, 3>(block, scratch);
    }
    Add(block, scratch);
  });
}

/// One thread's rows.
class NormalBand::Part : public RowConsumer {
 public:
  explicit Part(NormalBand* band) : band_(*band), scratch_(band->shape_) {}
  void Consume(const RowBlock& block) override { band_.Consume(block, &scratch_); }
  double squared_norm_of_data() const { return scratch_.squared_norm_of_data; }

 private:
  NormalBand& band_;
  Scratch scratch_;
};

void NormalBand::AddRows(const RowSource& source, int threads) {
  const int parts = source.num_parts();
  if (parts == 1) return source.Stream(this);
  std::vector<double> squared_norms(static_cast<std::size_t>(parts));
  const auto take_every = [&](int first, int step) {
    for (int k = first; k < parts; k += step) {
      Part part(this);
      source.StreamPart(k, &part);
      squared_norms[static_cast<std::size_t>(k)] = part.squared_norm_of_data();
    }
  };
  // Neighbours have columns in common. With one thread too in this order: the same bits.
  for (const int parity : {0, 1}) {
    std::vector<std::thread> others;
    for (int thread = 1; thread < std::min(threads, parts / 2); ++thread) {
      others.emplace_back(take_every, parity + 2 * thread, 2 * threads);
    }
    take_every(parity, 2 * threads);
    for (std::thread& other : others) other.join();
  }
  for (const double squared_norm : squared_norms) {
    scratch_.squared_norm_of_data += squared_norm;
  }
}

NormalBand NormalBand::FromRows(const RowSource& source, int threads) {
  NormalBand matrix(source.shape());
  matrix.AddRows(source, threads);
  return matrix;
}

bool NormalBand::Overlaps() const {
  return shape_.cyclic && shape_.num_columns < 2 * shape_.width - 1;
}

template <typename Visitor>
void NormalBand::VisitRow(int j, const Visitor& visit) const {
  const int n = shape_.num_columns;
  const auto entry = [this](int row, int k) {
    return band_[static_cast<std::size_t>(row) * shape_.width + k];
  };
  for (int k = shape_.width - 1; k > 0; --k) {
    if (j - k < 0 && !shape_.cyclic) continue;
    const int before = j >= k ? j - k : ((j - k) % n + n) % n;
    visit(before, entry(before, k));
  }
  for (int k = 0; k < shape_.width && (shape_.cyclic || j + k < n); ++k) {
    visit(WrappedColumn(j + k), entry(j, k));
  }
}

void NormalBand::MultiplyRow(int j, const double* v, const double* right, double* product) const {
  const int d = shape_.dimension;
  double* target = product + static_cast<std::size_t>(j) * d;
  std::fill_n(target, d, 0.0);
  VisitRow(j, [&](int column, double entry) {
    const double* source = v + static_cast<std::size_t>(column) * d;
    for (int c = 0; c < d; ++c) target[c] += entry * source[c];
  });
  const std::size_t place = static_cast<std::size_t>(j) * d;
  for (int c = 0; right != nullptr && c < d; ++c) target[c] = right[place + c] - target[c];
}

template <int kWidth, int kDimension>
void NormalBand::MultiplyInside(int begin, int end, const double* v, const double* right,
                                double* product) const {
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
        const std::size_t place = static_cast<std::size_t>(j) * d + c;
        product[place] = right == nullptr ? sum : right[place] - sum;
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
      const std::size_t place = static_cast<std::size_t>(j) * kDimension;
      for (int c = 0; c < kDimension; ++c) {
        product[place + c] = right == nullptr ? sum[c] : right[place + c] - sum[c];
      }
    }
  }
}

void NormalBand::MultiplyAll(const double* v, const double* right, double* product) const {
  const int n = shape_.num_columns;
  const int reach = std::max(shape_.width - 1, 0);
  const int inside_begin = std::min(reach, n);
  const int inside_end = std::max(inside_begin, n - reach);
  for (int j = 0; j < inside_begin; ++j) MultiplyRow(j, v, right, product);
  WithFixedShape(shape_.width, shape_.dimension, [&](auto width, auto dimension) {
    MultiplyInside<width, dimension>(inside_begin, inside_end, v, right, product);
  });
  for (int j = inside_end; j < n; ++j) MultiplyRow(j, v, right, product);
}

void NormalBand::Multiply(const double* v, double* product) const {
  MultiplyAll(v, nullptr, product);
}

void NormalBand::NormalResidual(const double* control_points, double* residual) const {
  MultiplyAll(control_points, right_hand_side_.data(), residual);
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

double NormalBand::AbsoluteRowSum(int j) const {
  double sum = 0.0;
  VisitRow(j, [&sum](int /*column*/, double entry) { sum += std::abs(entry); });
  return sum;
}

template <typename Visitor>
void NormalBand::VisitAbsoluteRowSums(const Visitor& visit) const {
  const int n = shape_.num_columns;
  const int reach = std::max(shape_.width - 1, 0);
  const int inside_begin = std::min(reach, n);
  const int inside_end = std::max(inside_begin, n - reach);
  for (int j = 0; j < inside_begin; ++j) visit(j, AbsoluteRowSum(j));
  WithFixedShape(shape_.width, 1, [&](auto fixed_width, auto) {
    const int width = fixed_width > 0 ? fixed_width : shape_.width;
    for (int j = inside_begin; j < inside_end; ++j) {
      const double* const entry = band_.data() + static_cast<std::size_t>(j) * width;
      double sum = 0.0;
      for (int k = width - 1; k > 0; --k) sum += std::abs(entry[k - k * width]);
      for (int k = 0; k < width; ++k) sum += std::abs(entry[k]);
      visit(j, sum);
    }
  });
  for (int j = inside_end; j < n; ++j) visit(j, AbsoluteRowSum(j));
}

std::vector<double> NormalBand::AbsoluteRowSums() const {
  std::vector<double> sums(shape_.num_columns, 0.0);
  if (Overlaps()) {
    // Entries on one place add before their absolute value is taken.
    const Eigen::VectorXd dense = ToDense().cwiseAbs().rowwise().sum();
    std::copy_n(dense.data(), sums.size(), sums.begin());
  } else {
    VisitAbsoluteRowSums([&](int j, double sum) { sums[static_cast<std::size_t>(j)] = sum; });
  }
  return sums;
}

double NormalBand::LargestRowSum() const {
  double largest = 0.0;
  if (Overlaps()) {
    for (const double sum : AbsoluteRowSums()) largest = std::max(largest, sum);
  } else {
    VisitAbsoluteRowSums([&](int, double sum) { largest = std::max(largest, sum); });
  }
  return largest;
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
