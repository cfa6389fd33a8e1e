#ifndef BATTEN_SPLINES_ROW_WINDOW_H_
#define BATTEN_SPLINES_ROW_WINDOW_H_

#include <algorithm>
#include <cstddef>
#include <vector>

#include "splines/row_pack.h"

namespace batten {

/// The window's rows of an n x d array: where they stand, or copied together if they wrap.
class RowWindow {
 public:
  explicit RowWindow(const RowShape& shape)
      : shape_(shape), copy_(static_cast<std::size_t>(shape.width) * shape.dimension) {}

  const double* Gather(const double* all, int first_column) {
    if (first_column + shape_.width <= shape_.num_columns) return all + At(first_column);
    for (int j = 0; j < shape_.width; ++j) {
      std::copy_n(all + At((first_column + j) % shape_.num_columns), shape_.dimension,
                  copy_.data() + At(j));
    }
    return copy_.data();
  }
  void Add(const double* values, int first_column, double* all) const {
    const int d = shape_.dimension;
    if (first_column + shape_.width <= shape_.num_columns) {
      double* target = all + At(first_column);
      for (int k = 0; k < shape_.width * d; ++k) target[k] += values[k];
      return;
    }
    for (int j = 0; j < shape_.width; ++j) {
      double* target = all + At((first_column + j) % shape_.num_columns);
      for (int c = 0; c < d; ++c) target[c] += values[At(j) + c];
    }
  }

 private:
  std::size_t At(int row) const { return static_cast<std::size_t>(row) * shape_.dimension; }
  RowShape shape_;
  std::vector<double> copy_;
};

/// One coordinate of A P - Q on the block's rows, or of A P without right-hand sides.
template <bool kWithData>
void ResidualOfCoordinate(const RowShape& shape, const RowBlock& block, const double* points, int c,
                          RowPack* residual) {
  const int packs = block.stride / kPackLanes;
  const RowPack* q = AsPacks(block.right_hand_sides) + c * packs;
  for (int i = 0; i < packs; ++i) residual[i] = kWithData ? -q[i] : RowPack{};
  for (int j = 0; j < shape.width; ++j) {
    const RowPack* a = AsPacks(block.coefficients) + j * packs;
    const RowPack point = Broadcast(points[j * shape.dimension + c]);
    for (int i = 0; i < packs; ++i) residual[i] += a[i] * point;
  }
}

/// gradient[j * dimension + c] = factor * a_j' residual.
inline void GradientOfCoordinate(const RowShape& shape, const RowBlock& block,
                                 const RowPack* residual, int c, double factor, double* gradient) {
  const int packs = block.stride / kPackLanes;
  for (int j = 0; j < shape.width; ++j) {
    const RowPack* a = AsPacks(block.coefficients) + j * packs;
    gradient[j * shape.dimension + c] = factor * DotPacks(a, residual, packs);
  }
}

}  // namespace batten

#endif  // BATTEN_SPLINES_ROW_WINDOW_H_
