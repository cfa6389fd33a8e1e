#include "splines/banded_qr.h"

#include <algorithm>
#include <cmath>

#include "splines/fold_graded_rows.h"

namespace batten {
namespace {

/// Carried entries below this, relative to the largest of the triangle, are zero: they could only
/// add squares that underflow.
constexpr double kDecayedEntry = 1e-140;

}  // namespace

/// Any rows x columns, packed; all zero at first.
class BandedQr::RowBuffer {
 public:
  RowBuffer(int num_rows, int num_columns)
      : stride_(PaddedRows(num_rows)), data_(static_cast<std::size_t>(stride_) * num_columns) {}
  double& operator()(int row, int column) { return data_[column * stride_ + row]; }
  PackedRows packed() {
    return {AsPacks(data_.data()), stride_ / kPackLanes, stride_ / kPackLanes};
  }
  /// The first `count` columns lose their first one and get a zero one.
  void ShiftColumns(int count) {
    std::copy_n(data_.begin() + stride_, (count - 1) * stride_, data_.begin());
    std::fill_n(data_.begin() + (count - 1) * stride_, stride_, 0.0);
  }
  double LargestInColumns(int count) const {
    double largest = 0.0;
    for (int k = 0; k < count * stride_; ++k) largest = std::max(largest, std::abs(data_[k]));
    return largest;
  }

 private:
  int stride_;
  std::vector<double> data_;
};

BandedQr::BandedQr(const RowShape& shape)
    : shape_(shape),
      overlaps_(shape.cyclic && shape.num_columns < 2 * shape.width - 1),
      width_(overlaps_ ? shape.num_columns : std::min(shape.width, shape.num_columns)),
      num_border_(shape.cyclic && !overlaps_ ? std::max(width_ - 1, 0) : 0),
      num_swept_(shape.num_columns - 2 * num_border_),
      row_size_(width_ + shape.dimension),
      triangle_(static_cast<std::size_t>(shape.num_columns) * row_size_, 0.0),
      wrapped_(static_cast<std::size_t>(2 * num_border_) * row_size_, 0.0),
      pending_(static_cast<std::size_t>(kRowsPerFold) * row_size_, 0.0) {}

void BandedQr::Consume(const RowBlock& block) {
  const int first_column = overlaps_ ? 0 : block.first_column;
  if (first_column != pending_column_ || num_pending_ + block.stride > kRowsPerFold) {
    FoldPending();
    pending_column_ = first_column;
  }
  const auto target = [&](int column) {
    return pending_.data() + column * kRowsPerFold + num_pending_;
  };
  if (overlaps_) {
    for (int k = 0; k < width_; ++k) std::fill_n(target(k), block.stride, 0.0);
    for (int j = 0; j < shape_.width; ++j) {
      double* column = target((block.first_column + j) % width_);
      for (int i = 0; i < block.stride; ++i) {
        column[i] += block.coefficients[j * block.stride + i];
      }
    }
  } else {
    for (int j = 0; j < width_; ++j) {
      std::copy_n(block.coefficients + j * block.stride, block.stride, target(j));
    }
  }
  for (int c = 0; c < shape_.dimension; ++c) {
    std::copy_n(block.right_hand_sides + c * block.stride, block.stride, target(width_ + c));
  }
  num_pending_ += block.stride;
}

void BandedQr::FoldPending() {
  if (num_pending_ == 0) return;
  const bool wraps = pending_column_ + width_ > shape_.num_columns;
  const int first_border = shape_.num_columns - num_border_;
  double* triangle = wraps
                         ? wrapped_.data() + (pending_column_ - first_border) * row_size_
                         : triangle_.data() + static_cast<std::size_t>(pending_column_) * row_size_;
  const PackedRows rows = {AsPacks(pending_.data()), num_pending_ / kPackLanes, kFoldStride};
  residual_ += WithFixedShape(width_, shape_.dimension, [&](auto width, auto dimension) {
    return shape_.graded
               ? FoldGraded<width, dimension>(width_, shape_.dimension, rows, triangle, row_size_)
               : FoldRows<width, dimension>(width_, shape_.dimension, rows, triangle, row_size_);
  });
  num_pending_ = 0;
}

double BandedQr::Fold(int width, int dimension, PackedRows rows, double* triangle,
                      std::ptrdiff_t triangle_stride) const {
  return shape_.graded ? FoldGraded<-1, -1>(width, dimension, rows, triangle, triangle_stride)
                       : FoldAny(width, dimension, rows, triangle, triangle_stride);
}

void BandedQr::Finish() {
  FoldPending();
  if (num_border_ > 0) FoldWrapped();
  double smallest = 0.0;
  bool finite = true;
  largest_ = 0.0;
  for (int j = 0; j < shape_.num_columns; ++j) {
    const double size = std::abs(DiagonalEntry(j));
    smallest = j == 0 ? size : std::min(smallest, size);
    finite = finite && std::isfinite(size);
    largest_ = std::max(largest_, size);
  }
  if (!finite) largest_ = std::nan("");
  ratio_ = shape_.num_columns == 0 ? 1.0 : largest_ == 0.0 ? 0.0 : smallest / largest_;
  full_rank_ = ratio_ > kRankTolerance;
}

void BandedQr::FoldWrapped() {
  const int size = 2 * num_border_;
  const int d = shape_.dimension;
  // The wrapped rows' columns stand in the order border, 0..num_border_ - 1. Another triangle has
  // the latter, which have been eliminated, before the former, which are eliminated last.
  RowBuffer wrapped(size, size + d);
  for (int i = 0; i < size; ++i) {
    const double* row = wrapped_.data() + i * row_size_;
    for (int k = 0; k < width_ && i + k < size; ++k)
      wrapped(i, (i + k + num_border_) % size) = row[k];
    for (int c = 0; c < d; ++c) wrapped(i, size + c) = row[width_ + c];
  }
  std::vector<double> reordered(static_cast<std::size_t>(size) * (size + d), 0.0);
  residual_ += Fold(size, d, wrapped.packed(), reordered.data(), size + d);

  // Its lower half is in the border; its upper half, and the carried rows it becomes, are folded
  // along the band.
  RowBuffer last(size, size + d);
  CarryAlong(reordered, &last);
  for (int i = num_border_; i < size; ++i) {
    const double* row = reordered.data() + i * (size + d);
    for (int k = i; k < size; ++k) last(i, k) = row[k - i];
    for (int c = 0; c < d; ++c) last(i, size + c) = row[size + c];
  }
  dense_.assign(static_cast<std::size_t>(size) * (size + d), 0.0);
  for (int i = 0; i < size; ++i) {
    const double* row = triangle_.data() + static_cast<std::size_t>(num_swept_ + i) * row_size_;
    double* target = dense_.data() + i * (size + d);
    std::copy_n(row, std::min(width_, size - i), target);
    std::copy_n(row + width_, d, target + size);
  }
  residual_ += Fold(size, d, last.packed(), dense_.data(), size + d);
}

void BandedQr::CarryAlong(const std::vector<double>& reordered, RowBuffer* last) {
  const int size = 2 * num_border_;
  const int d = shape_.dimension;
  const int others = width_ - 1 + num_border_ + d;  // columns beside the one eliminated
  // Columns: those of the window j..j + width - 1, the border, right-hand sides.
  RowBuffer carried(num_border_, 1 + others);
  for (int i = 0; i < num_border_; ++i) {
    const double* row = reordered.data() + i * (size + d);
    for (int k = i; k < size; ++k) carried(i, k < num_border_ ? k : k + 1) = row[k - i];
    for (int c = 0; c < d; ++c) carried(i, width_ + num_border_ + c) = row[size + c];
  }
  double scale = 0.0;  // so far the whole diagonal of R is in the band
  for (int j = 0; j < shape_.num_columns; ++j) {
    scale = std::max(scale, std::abs(triangle_[static_cast<std::size_t>(j) * row_size_]));
  }
  std::vector<double> row(1 + others);
  double* const border = row.data() + width_;
  for (int j = 0; j < num_swept_; ++j) {
    if (carried.LargestInColumns(num_border_) <= kDecayedEntry * scale) break;
    double* const entry = triangle_.data() + static_cast<std::size_t>(j) * row_size_;
    std::copy_n(entry, width_, row.begin());
    std::fill_n(border, num_border_, 0.0);
    std::copy_n(entry + width_, d, border + num_border_);
    Fold(1, others, carried.packed(), row.data(), 1 + others);
    std::copy_n(row.begin(), width_, entry);
    std::copy_n(border + num_border_, d, entry + width_);
    for (int b = 0; b < num_border_; ++b) {
      border_.push_back(std::abs(border[b]) > kDecayedEntry * scale ? border[b] : 0.0);
    }
    carried.ShiftColumns(width_);
    num_bordered_ = j + 1;
  }
  const bool decayed = num_bordered_ < num_swept_;
  for (int i = 0; i < num_border_; ++i) {
    for (int k = 0; k < num_border_; ++k) {
      (*last)(i, k) = decayed ? 0.0 : carried(i, k);
      (*last)(i, num_border_ + k) = carried(i, width_ + k);
    }
    for (int c = 0; c < d; ++c) (*last)(i, size + c) = carried(i, width_ + num_border_ + c);
  }
}

double BandedQr::DiagonalEntry(int j) const {
  const int size = 2 * num_border_;
  return num_border_ > 0 && j >= num_swept_ ? dense_[(j - num_swept_) * (size + shape_.dimension)]
                                            : triangle_[static_cast<std::size_t>(j) * row_size_];
}

template <typename Visitor>
void BandedQr::VisitRow(int j, const Visitor& visit) const {
  if (num_border_ > 0 && j >= num_swept_) {
    const int size = 2 * num_border_;
    const int i = j - num_swept_;
    const double* row = dense_.data() + i * (size + shape_.dimension);
    for (int k = size - 1 - i; k > 0; --k) visit(j + k, row[k]);
    return;
  }
  if (j < num_bordered_) {
    const double* border = border_.data() + static_cast<std::size_t>(j) * num_border_;
    for (int b = 0; b < num_border_; ++b) visit(shape_.num_columns - num_border_ + b, border[b]);
  }
  const double* row = triangle_.data() + static_cast<std::size_t>(j) * row_size_;
  for (int k = std::min(width_, shape_.num_columns - j) - 1; k > 0; --k) visit(j + k, row[k]);
}

const double* BandedQr::RightHandSide(int j) const {
  const int size = 2 * num_border_;
  return num_border_ > 0 && j >= num_swept_
             ? dense_.data() + (j - num_swept_) * (size + shape_.dimension) + size
             : triangle_.data() + static_cast<std::size_t>(j) * row_size_ + width_;
}

void BandedQr::Solve(Points* control_points) const {
  control_points->resize(shape_.num_columns, shape_.dimension);
  for (int j = 0; j < shape_.num_columns; ++j) {
    std::copy_n(RightHandSide(j), shape_.dimension,
                control_points->data() + static_cast<std::ptrdiff_t>(j) * shape_.dimension);
  }
  SolveTriangle(shape_.dimension, control_points->data());
}

template <int kDimension>
void BandedQr::SolveTriangleFixed(double* x) const {
  for (int j = shape_.num_columns - 1; j >= 0; --j) {
    double* const target = x + static_cast<std::size_t>(j) * kDimension;
    double sum[kDimension];  // not in memory: each entry would wait for the one before
    for (int c = 0; c < kDimension; ++c) sum[c] = target[c];
    VisitRow(j, [&](int column, double entry) {
      const double* source = x + static_cast<std::size_t>(column) * kDimension;
      for (int c = 0; c < kDimension; ++c) sum[c] -= entry * source[c];
    });
    const double inverse = 1.0 / DiagonalEntry(j);
    for (int c = 0; c < kDimension; ++c) target[c] = sum[c] * inverse;
  }
}

void BandedQr::SolveTriangle(int dimension, double* x) const {
  if (dimension == 1) return SolveTriangleFixed<1>(x);
  if (dimension == 2) return SolveTriangleFixed<2>(x);
  if (dimension == 3) return SolveTriangleFixed<3>(x);
  for (int j = shape_.num_columns - 1; j >= 0; --j) {
    double* const target = x + static_cast<std::size_t>(j) * dimension;
    VisitRow(j, [&](int column, double entry) {
      const double* source = x + static_cast<std::size_t>(column) * dimension;
      for (int c = 0; c < dimension; ++c) target[c] -= entry * source[c];
    });
    for (int c = 0; c < dimension; ++c) target[c] /= DiagonalEntry(j);
  }
}

void BandedQr::SolveTransposedTriangle(int dimension, double* x) const {
  for (int j = 0; j < shape_.num_columns; ++j) {
    double* const source = x + static_cast<std::size_t>(j) * dimension;
    for (int c = 0; c < dimension; ++c) source[c] /= DiagonalEntry(j);
    VisitRow(j, [&](int column, double entry) {
      double* target = x + static_cast<std::size_t>(column) * dimension;
      for (int c = 0; c < dimension; ++c) target[c] -= entry * source[c];
    });
  }
}

void BandedQr::CopyRow(int j, double* window, double* tail, double* right) const {
  const int num_band = num_band_columns();
  const auto set = [&](int column, double entry) {
    if (column < num_band) {
      window[column - j] = entry;
    } else {
      tail[column - num_band] = entry;
    }
  };
  std::fill_n(window, width_, 0.0);
  std::fill_n(tail, num_tail_columns(), 0.0);
  set(j, DiagonalEntry(j));
  VisitRow(j, set);
  std::copy_n(RightHandSide(j), shape_.dimension, right);
}

}  // namespace batten
