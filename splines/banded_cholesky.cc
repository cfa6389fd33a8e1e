#include "splines/banded_cholesky.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "splines/row_pack.h"

namespace batten {
namespace {

/// Fill in the border below this, relative to the largest diagonal entry, is set to zero: products
/// of such entries could only be denormal, and those cost several times as much.
constexpr double kDecayed = 1e-200;
/// Columns from one search for decayed entries to the next.
constexpr int kDecayInterval = 8;

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kLargest = std::numeric_limits<double>::max();

/// Row-major size x size, upper triangle, in place: N = U' D U, U with unit diagonal; 1 / D takes
/// the place of the diagonal. False if a pivot is not above its limit.
bool FactorDense(int size, const double* limits, double* u) {
  for (int j = 0; j < size; ++j) {
    const double pivot = u[j * size + j];
    if (!(pivot > limits[j] && pivot <= kLargest)) return false;
    const double inverse = 1.0 / pivot;
    for (int i = j + 1; i < size; ++i) {
      const double factor = u[j * size + i] * inverse;
      for (int k = i; k < size; ++k) u[i * size + k] -= factor * u[j * size + k];
    }
    for (int k = j + 1; k < size; ++k) u[j * size + k] *= inverse;
    u[j * size + j] = inverse;
  }
  return true;
}

void SolveDense(int size, const double* u, int dimension, double* x) {
  for (int j = 0; j < size; ++j) {
    for (int k = j + 1; k < size; ++k) {
      for (int c = 0; c < dimension; ++c) {
        x[k * dimension + c] -= u[j * size + k] * x[j * dimension + c];
      }
    }
  }
  for (int j = size - 1; j >= 0; --j) {
    for (int c = 0; c < dimension; ++c) {
      double sum = x[j * dimension + c] * u[j * size + j];
      for (int k = j + 1; k < size; ++k) sum -= u[j * size + k] * x[k * dimension + c];
      x[j * dimension + c] = sum;
    }
  }
}

/// Sets decayed entries to zero; true if nothing is left.
bool FlushDecayed(double limit, std::vector<double>* entries) {
  bool all_zero = true;
  for (double& entry : *entries) {
    if (std::abs(entry) < limit) entry = 0.0;
    all_zero = all_zero && entry == 0.0;
  }
  return all_zero;
}

/// `size` zeros, on the stack unless they are many.
class Zeros {
 public:
  explicit Zeros(int size) {
    if (size <= kOnStack) {
      std::fill_n(stack_, size, 0.0);
    } else {
      heap_.resize(size);
      entries_ = heap_.data();
    }
  }
  Zeros(const Zeros&) = delete;
  Zeros& operator=(const Zeros&) = delete;
  double& operator[](int k) { return entries_[k]; }

 private:
  static constexpr int kOnStack = 2048;
  double stack_[kOnStack];
  std::vector<double> heap_;
  double* entries_ = stack_;
};

/// Zeros whose number is known to the compiler, so that they can be registers, or (kSize < 0) not.
template <int kSize>
auto ZeroScratch([[maybe_unused]] int size) {
  if constexpr (kSize >= 0) {
    return std::array<double, kSize>{};
  } else {
    return Zeros(size);
  }
}

}  // namespace

bool BandedCholesky::Factor(const NormalBand& matrix) { return FactorInto(matrix, &factor_); }

bool BandedCholesky::Factor(NormalBand&& matrix) {
  const bool factored = FactorInto(matrix, &matrix.band());
  factor_ = std::move(matrix.band());
  return factored;
}

bool BandedCholesky::FactorInto(const NormalBand& matrix, LargeArray* factor) {
  n_ = matrix.size();
  width_ = matrix.width();
  norm_ = 0.0;
  num_bordered_ = 0;
  dense_.clear();
  if (width_ == 0) return n_ == 0;
  const bool overlaps = matrix.cyclic() && n_ < 2 * width_ - 1;
  num_border_ = matrix.cyclic() && !overlaps ? width_ - 1 : 0;
  const int dense_size = overlaps ? n_ : std::min(n_, width_ - 1 + num_border_);
  num_swept_ = n_ - dense_size;
  MeasureMatrix(matrix, dense_size);
  FirstPending(matrix.band(), &pending_);
  if (factor != &matrix.band()) factor->resize(static_cast<std::size_t>(num_swept_) * width_);
  border_.resize(static_cast<std::size_t>(num_swept_) * num_border_);
  const bool swept = WithFixedShape(width_, 1, [&](auto width, auto) {
    return Sweep<width>(matrix.band().data(), factor->data(), &pending_);
  });
  if (!swept) return false;
  FillDense(matrix, pending_);
  return FactorDense(dense_size, limits_.data(), dense_.data());
}

void BandedCholesky::MeasureMatrix(const NormalBand& matrix, int dense_size) {
  norm_ = matrix.LargestRowSum();
  if (matrix.cyclic() && num_border_ == 0) {
    limits_ = matrix.Diagonal();
  } else {
    const Eigen::Map<const Eigen::VectorXd, 0, Eigen::InnerStride<>> diagonal(
        matrix.band().data(), n_, Eigen::InnerStride<>(width_));
    largest_diagonal_ = num_border_ > 0 ? std::max(0.0, diagonal.maxCoeff()) : 0.0;
    const auto last = diagonal.tail(dense_size);
    limits_.assign(last.begin(), last.end());
  }
  for (double& limit : limits_) limit *= n_ * kEpsilon;
}

void BandedCholesky::FirstPending(const LargeArray& band, Pending* first) const {
  const int border = width_ - 1;
  Pending& pending = *first;
  pending.band.assign(width_ * width_, 0.0);
  pending.border.assign(num_border_ * num_border_, 0.0);
  pending.corner.assign(num_border_ * num_border_, 0.0);
  for (int i = 0; i < std::min(border, n_); ++i) {
    std::copy_n(band.data() + i * width_, std::min(border, n_) - i,
                pending.band.data() + i * width_);
  }
  // Entry k of border row b stands in column b + k - border, past the end of the matrix.
  for (int b = 0; b < num_border_; ++b) {
    const double* row = band.data() + static_cast<std::size_t>(n_ - num_border_ + b) * width_;
    for (int k = border - b; k < width_; ++k) {
      pending.border[(b + k - border) * num_border_ + b] = row[k];
    }
  }
}

template <int kWidth>
[[gnu::always_inline]] inline bool BandedCholesky::SweepBorder(int j, const double* u,
                                                               Pending* pending) {
  const int border = kWidth > 0 ? kWidth - 1 : num_border_;
  double* const row = pending->border.data();
  double* const corner = pending->corner.data();
  double* const factor = border_.data() + static_cast<std::size_t>(j) * border;
  const double inverse = u[0];
  for (int b = 0; b < border; ++b) factor[b] = row[b] * inverse;
  for (int a = 0; a < border; ++a) {
    for (int b = a; b < border; ++b) corner[a * border + b] -= factor[a] * row[b];
  }
  // Row i of the window moves up by one; u[i] is already divided by the pivot.
  for (int b = 0; b < border; ++b) {
    const double first = row[b];
    for (int i = 1; i < border; ++i) {
      row[(i - 1) * border + b] = row[i * border + b] - u[i] * first;
    }
    row[(border - 1) * border + b] = -u[border] * first;
  }
  num_bordered_ = j + 1;
  if (num_bordered_ % kDecayInterval != 0) return true;
  return !FlushDecayed(kDecayed * largest_diagonal_, &pending->border);
}

// Loops over the window are unrolled by order: its entries then are registers, while an array in
// memory would be written in other pieces than it is read, which stalls.
template <int kWidth>
bool BandedCholesky::Sweep(const double* band, double* factor, Pending* pending) {
  const int width = kWidth > 0 ? kWidth : width_;
  // What is left of rows j.., row i from its diagonal to column j + width - 1; the first of them.
  auto window = ZeroScratch < kWidth < 0 ? -1 : kWidth * kWidth > (width * width);
  auto row = ZeroScratch<kWidth>(width);
#pragma GCC unroll 8
  for (int i = 0; i < width; ++i) {
#pragma GCC unroll 8
    for (int k = 0; k < width; ++k) window[i * width + k] = pending->band[i * width + k];
  }
  bool bordered = num_border_ > 0;
  const double pivot_tolerance = n_ * kEpsilon;
  for (int j = 0; j < num_swept_; ++j) {
    const double* entry = band + static_cast<std::size_t>(j) * width;
    double* u = factor + static_cast<std::size_t>(j) * width;
#pragma GCC unroll 8
    for (int i = 0; i < width; ++i) {
      window[i * width + width - 1 - i] = entry[i * width + width - 1 - i];
    }
#pragma GCC unroll 8
    for (int k = 0; k < width; ++k) row[k] = window[k];
    const double pivot = row[0];
    if (!(pivot > pivot_tolerance * entry[0] && pivot <= kLargest)) return false;
    const double inverse = 1.0 / pivot;
    // Products before the quotient: they need not wait for it.
#pragma GCC unroll 8
    for (int i = 1; i < width; ++i) {
#pragma GCC unroll 8
      for (int k = i; k < width; ++k) {
        window[(i - 1) * width + k - i] = window[i * width + k - i] - row[i] * row[k] * inverse;
      }
      u[i] = row[i] * inverse;
    }
    u[0] = inverse;
    if (bordered) bordered = SweepBorder<kWidth>(j, u, pending);
  }
#pragma GCC unroll 8
  for (int i = 0; i < width; ++i) {
#pragma GCC unroll 8
    for (int k = 0; k < width; ++k) pending->band[i * width + k] = window[i * width + k];
  }
  return true;
}

void BandedCholesky::FillDense(const NormalBand& matrix, const Pending& pending) {
  const int size = n_ - num_swept_;
  if (matrix.cyclic() && num_border_ == 0) {
    const Eigen::MatrixXd dense = matrix.ToDense();
    dense_.assign(dense.data(), dense.data() + dense.size());
    return;
  }
  dense_.assign(static_cast<std::size_t>(size) * size, 0.0);
  for (int i = 0; i < size; ++i) {
    const double* row = matrix.band().data() + static_cast<std::size_t>(num_swept_ + i) * width_;
    for (int k = 0; k < width_ && i + k < size; ++k) dense_[i * size + i + k] = row[k];
  }
  const int inner = size - num_border_;
  for (int i = 0; i < inner; ++i) {
    for (int k = 0; i + k < inner; ++k) dense_[i * size + i + k] = pending.band[i * width_ + k];
    for (int b = 0; b < num_border_; ++b) {
      dense_[i * size + inner + b] += pending.border[i * num_border_ + b];
    }
  }
  for (int a = 0; a < num_border_; ++a) {
    for (int b = a; b < num_border_; ++b) {
      dense_[(inner + a) * size + inner + b] += pending.corner[a * num_border_ + b];
    }
  }
}

template <int kWidth, int kDimension, bool kBordered>
void BandedCholesky::SolveForward(int begin, int end, double* x, int dimension) const {
  const int width = kWidth > 0 ? kWidth : width_;
  const int d = kWidth > 0 ? kDimension : dimension;
  double* const border = x + static_cast<std::size_t>(n_ - num_border_) * d;
  auto sum = ZeroScratch < kWidth < 0 ? -1 : kWidth * kDimension > (width * d);
  for (int j = begin; j < end; ++j) {
    const double* u = factor_.data() + static_cast<std::size_t>(j) * width;
    double* const near = x + static_cast<std::size_t>(j) * d;
    for (int k = 1; k < width; ++k) {
      for (int c = 0; c < d; ++c) near[k * d + c] -= u[k] * near[c];
    }
    if (!kBordered) continue;
    const double* factor = border_.data() + static_cast<std::size_t>(j) * (width - 1);
    for (int b = 0; b < width - 1; ++b) {
      for (int c = 0; c < d; ++c) sum[b * d + c] += factor[b] * near[c];
    }
  }
  for (int k = 0; kBordered && k < (width - 1) * d; ++k) border[k] -= sum[k];
}

template <int kWidth, int kDimension, bool kBordered>
void BandedCholesky::SolveBackward(int begin, int end, double* x, int dimension) const {
  const int width = kWidth > 0 ? kWidth : width_;
  const int d = kWidth > 0 ? kDimension : dimension;
  const double* const border = x + static_cast<std::size_t>(n_ - num_border_) * d;
  auto known = ZeroScratch < kWidth < 0 ? -1 : kWidth * kDimension > (width * d);
  for (int k = 0; kBordered && k < (width - 1) * d; ++k) known[k] = border[k];
  for (int j = end - 1; j >= begin; --j) {
    const double* u = factor_.data() + static_cast<std::size_t>(j) * width;
    const double* factor = border_.data() + static_cast<std::size_t>(j) * num_border_;
    double* const near = x + static_cast<std::size_t>(j) * d;
    for (int c = 0; c < d; ++c) {
      double sum = near[c] * u[0];
      for (int b = 0; kBordered && b < width - 1; ++b) sum -= factor[b] * known[b * d + c];
      for (int k = width - 1; k > 0; --k) sum -= u[k] * near[k * d + c];
      near[c] = sum;
    }
  }
}

template <int kWidth, int kDimension>
void BandedCholesky::SolveBand(double* x, int dimension) const {
  // Open matrices have no room for a border in x, even an empty one.
  const bool bordered = num_bordered_ > 0;
  if (bordered) SolveForward<kWidth, kDimension, true>(0, num_bordered_, x, dimension);
  SolveForward<kWidth, kDimension, false>(num_bordered_, num_swept_, x, dimension);
  SolveDense(n_ - num_swept_, dense_.data(), dimension,
             x + static_cast<std::size_t>(num_swept_) * dimension);
  SolveBackward<kWidth, kDimension, false>(num_bordered_, num_swept_, x, dimension);
  if (bordered) SolveBackward<kWidth, kDimension, true>(0, num_bordered_, x, dimension);
}

void BandedCholesky::Solve(double* x, int dimension) const {
  WithFixedShape(width_, dimension, [&](auto width, auto fixed_dimension) {
    SolveBand<width, fixed_dimension>(x, dimension);
  });
}

}  // namespace batten
