#ifndef BATTEN_SPLINES_FOLD_GRADED_ROWS_H_
#define BATTEN_SPLINES_FOLD_GRADED_ROWS_H_

#include <cmath>
#include <cstddef>
#include <utility>

#include "splines/fold_rows.h"

namespace batten {

/// FoldAny for rows whose sizes differ by orders of magnitude. Before a column is eliminated its
/// largest entry is exchanged into the triangle: heavy rows are reflected first, and no light row
/// becomes a sum in which a heavy one has to cancel. Each row then carries roundings of its own
/// size only (Powell & Reid 1969; Cox & Higham, BIT 38, 1998), where the order of arrival would
/// round light rows to eps times the heavy ones. Takes half as long again.
template <int kWidth, int kDimension>
double FoldGraded(int any_width, int any_dimension, PackedRows rows, double* triangle,
                  std::ptrdiff_t triangle_stride) {
  const int width = kWidth > 0 ? kWidth : any_width;
  const int columns = width + (kWidth > 0 ? kDimension : any_dimension);
  for (int j = 0; j < width; ++j) {
    RowPack* const pivot = rows.columns + j * rows.stride;
    double* const r = triangle + j * triangle_stride;
    const auto entry_of_triangle = [&](int k) { return k < width ? r + k - j : r + k; };
    const auto entry_of_row = [&](int k, int i) {
      return reinterpret_cast<double*>(rows.columns + k * rows.stride) + i;
    };
    int largest = -1;
    double size = std::abs(r[0]);
    const double* const entries = reinterpret_cast<const double*>(pivot);
    for (int i = 0; i < rows.packs * kPackLanes; ++i) {
      if (!(std::abs(entries[i]) > size)) continue;
      size = std::abs(entries[i]);
      largest = i;
    }
    if (largest >= 0) {
      for (int k = j; k < columns; ++k) {
        std::swap(*entry_of_triangle(k), *entry_of_row(k, largest));
      }
    }
    const double squared_norm = DotPacks(pivot, pivot, rows.packs);
    const Reflection reflection(r[0], squared_norm);
    reflection.Apply(squared_norm, r);
    for (int k = j + 1; k < columns; ++k) {
      RowPack* const column = rows.columns + k * rows.stride;
      const RowPack factor =
          Broadcast(reflection.Apply(DotPacks(pivot, column, rows.packs), entry_of_triangle(k)));
      for (int i = 0; i < rows.packs; ++i) column[i] -= factor * pivot[i];
    }
  }
  double remainder = 0.0;
  for (int k = width; k < columns; ++k) {
    const RowPack* const column = rows.columns + k * rows.stride;
    remainder += DotPacks(column, column, rows.packs);
  }
  return remainder;
}

}  // namespace batten

#endif  // BATTEN_SPLINES_FOLD_GRADED_ROWS_H_
