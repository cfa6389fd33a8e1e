#ifndef BATTEN_SPLINES_FOLD_ROWS_H_
#define BATTEN_SPLINES_FOLD_ROWS_H_

#include <cmath>
#include <cstddef>

#include "splines/row_pack.h"

namespace batten {

/// Rows of one window that are folded at a time, at most: square roots and divisions per fold are
/// then shared by the rows of as many small blocks as make up a large one.
inline constexpr int kRowsPerFold = kMaxRowsPerBlock;

/// Rows to be folded, column by column, coefficients first, then right-hand sides: entry (i, k)
/// stands at columns[k * stride + i], counted in packs of rows. Internal to splines/.
struct PackedRows {
  RowPack* columns = nullptr;
  int packs = 0;
  int stride = 0;
};

/// The stride where width and dimension are fixed too: all columns are then offsets from one
/// register.
inline constexpr int kFoldStride = kRowsPerFold / kPackLanes;

/// The Householder reflection I - gamma v v' of v = (pivot - beta, b), which takes (pivot, b) to
/// (beta, 0). Nothing happens if b'b underflows: with b below 1e-150 gamma would overflow.
class Reflection {
 public:
  Reflection(double pivot, double squared_norm) {
    if (squared_norm < 1e-300) return;
    const double beta = -std::copysign(std::sqrt(pivot * pivot + squared_norm), pivot);
    first_ = pivot - beta;
    gamma_ = -1.0 / (beta * first_);
  }
  /// Reflects the first entry of a column whose others have the inner product `dot` with b;
  /// returns what of b is to be subtracted from the others.
  double Apply(double dot, double* entry) const {
    const double factor = (first_ * *entry + dot) * gamma_;
    *entry -= factor * first_;
    return factor;
  }

 private:
  double first_ = 0.0;
  double gamma_ = 0.0;
};

/// One pass over the rows: reflects columns kFirst.. with the factors of column kFirst - 1 and sums
/// the inner products of column kFirst with itself and those after it.
template <int kColumns, int kFirst>
void ReflectAndMultiply(PackedRows rows, const double* factors, double* dots) {
  RowPack factor[kColumns];
  RowPack sum[kColumns];
  for (int k = kFirst; k < kColumns; ++k) {
    factor[k] = kFirst > 0 ? Broadcast(factors[k]) : RowPack{};
    sum[k] = RowPack{};
  }
  for (int i = 0; i < rows.packs; ++i) {
    RowPack* const row = rows.columns + i;
    const RowPack previous = kFirst > 0 ? row[(kFirst - 1) * kFoldStride] : RowPack{};
    RowPack head = {};
    for (int k = kFirst; k < kColumns; ++k) {
      RowPack entry = row[k * kFoldStride];
      if (kFirst > 0) {
        entry -= factor[k] * previous;
        row[k * kFoldStride] = entry;
      }
      if (k == kFirst) head = entry;
      sum[k] += head * entry;
    }
  }
  for (int k = kFirst; k < kColumns; ++k) dots[k] = SumOfLanes(sum[k]);
}

/// The last pass: the squared norm of what is left of the right-hand sides.
template <int kWidth, int kDimension>
double SquaredRemainder(PackedRows rows, const double* factors) {
  RowPack sum = {};
  for (int c = 0; c < kDimension; ++c) {
    const RowPack factor = Broadcast(factors[kWidth + c]);
    const RowPack* pivot = rows.columns + (kWidth - 1) * kFoldStride;
    const RowPack* column = rows.columns + (kWidth + c) * kFoldStride;
    for (int i = 0; i < rows.packs; ++i) {
      const RowPack entry = column[i] - factor * pivot[i];
      sum += entry * entry;
    }
  }
  return SumOfLanes(sum);
}

template <int kWidth, int kDimension, int kFirst = 0>
double FoldFixed(PackedRows rows, double* triangle, std::ptrdiff_t triangle_stride,
                 double* factors) {
  constexpr int kColumns = kWidth + kDimension;
  double dots[kColumns];
  ReflectAndMultiply<kColumns, kFirst>(rows, factors, dots);
  double* const r = triangle + kFirst * triangle_stride;
  const Reflection reflection(r[0], dots[kFirst]);
  reflection.Apply(dots[kFirst], r);
  for (int k = kFirst + 1; k < kWidth; ++k) {
    factors[k] = reflection.Apply(dots[k], r + k - kFirst);
  }
  for (int k = kWidth; k < kColumns; ++k) factors[k] = reflection.Apply(dots[k], r + k);
  if constexpr (kFirst + 1 < kWidth) {
    return FoldFixed<kWidth, kDimension, kFirst + 1>(rows, triangle, triangle_stride, factors);
  } else {
    return SquaredRemainder<kWidth, kDimension>(rows, factors);
  }
}

/// Any width and number of right-hand sides.
inline double FoldAny(int width, int dimension, PackedRows rows, double* triangle,
                      std::ptrdiff_t triangle_stride) {
  for (int j = 0; j < width; ++j) {
    RowPack* const pivot = rows.columns + j * rows.stride;
    double* const r = triangle + j * triangle_stride;
    const double squared_norm = DotPacks(pivot, pivot, rows.packs);
    const Reflection reflection(r[0], squared_norm);
    reflection.Apply(squared_norm, r);
    for (int k = j + 1; k < width + dimension; ++k) {
      RowPack* const column = rows.columns + k * rows.stride;
      double* const entry = k < width ? r + k - j : r + k;
      const RowPack factor =
          Broadcast(reflection.Apply(DotPacks(pivot, column, rows.packs), entry));
      for (int i = 0; i < rows.packs; ++i) column[i] -= factor * pivot[i];
    }
  }
  double remainder = 0.0;
  for (int c = 0; c < dimension; ++c) {
    const RowPack* const column = rows.columns + (width + c) * rows.stride;
    remainder += DotPacks(column, column, rows.packs);
  }
  return remainder;
}

/// Householder QR of [triangle; rows], in place. Row j of the triangle starts at
/// triangle[j * triangle_stride] with entries (j, j), (j, j + 1), ..., its right-hand sides follow
/// at [width]. Returns the squared norm of the right-hand sides left in the rows; the rows
/// themselves are destroyed. kWidth > 0 needs a stride of kFoldStride, kWidth < 0 takes any width,
/// dimension and stride.
template <int kWidth, int kDimension>
double FoldRows(int width, int dimension, PackedRows rows, double* triangle,
                std::ptrdiff_t triangle_stride) {
  if constexpr (kWidth > 0) {
    double factors[kWidth + kDimension];
    return FoldFixed<kWidth, kDimension>(rows, triangle, triangle_stride, factors);
  } else {
    return FoldAny(width, dimension, rows, triangle, triangle_stride);
  }
}

}  // namespace batten

#endif  // BATTEN_SPLINES_FOLD_ROWS_H_
