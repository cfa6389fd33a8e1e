#include <algorithm>
#include <cmath>
#include <vector>

#include "splines/banded_rows.h"
#include "splines/row_pack.h"

namespace batten {
namespace {

/// The window's rows of an n x d array: where they stand, or copied together if they wrap.
class Window {
 public:
  explicit Window(const RowShape& shape)
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

/// Sum whose error does not grow with the number of terms (Knuth's two-sum, without branches).
class CompensatedSum {
 public:
  void Add(double term) {
    const double sum = sum_ + term;
    const double added = sum - sum_;
    lost_ += (sum_ - (sum - added)) + (term - added);
    sum_ = sum;
  }
  /// What is lost of an infinite sum is not a number.
  double value() const { return std::isfinite(lost_) ? sum_ + lost_ : sum_; }

 private:
  double sum_ = 0.0;
  double lost_ = 0.0;
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
void GradientOfCoordinate(const RowShape& shape, const RowBlock& block, const RowPack* residual,
                          int c, double factor, double* gradient) {
  const int packs = block.stride / kPackLanes;
  for (int j = 0; j < shape.width; ++j) {
    const RowPack* a = AsPacks(block.coefficients) + j * packs;
    gradient[j * shape.dimension + c] = factor * DotPacks(a, residual, packs);
  }
}

/// ||A P - Q||^2 of a block; with kGradient, gradient (width x dimension) = 2 A'(A P - Q).
template <int kWidth, int kDimension, bool kGradient, bool kWithData>
double EvaluateBlock(const RowShape& shape, const RowBlock& block, const double* points,
                     double* gradient) {
  const int packs = block.stride / kPackLanes;
  if constexpr (kWidth < 0) {
    double energy = 0.0;
    RowPack residual[kMaxRowsPerBlock / kPackLanes];
    for (int c = 0; c < shape.dimension; ++c) {
      ResidualOfCoordinate<kWithData>(shape, block, points, c, residual);
      energy += DotPacks(residual, residual, packs);
      if (kGradient) GradientOfCoordinate(shape, block, residual, c, 2.0, gradient);
    }
    return energy;
  } else {
    constexpr int kEntries = kWidth * kDimension;
    RowPack point[kEntries];
    RowPack sum[kEntries] = {};
    RowPack energy = {};
    for (int k = 0; k < kEntries; ++k) point[k] = Broadcast(points[k]);
    const RowPack* a = AsPacks(block.coefficients);
    const RowPack* q = AsPacks(block.right_hand_sides);
    for (int i = 0; i < packs; ++i) {
      RowPack residual[kDimension];
      for (int c = 0; c < kDimension; ++c) {
        residual[c] = kWithData ? -q[c * packs + i] : RowPack{};
        for (int j = 0; j < kWidth; ++j) {
          residual[c] += a[j * packs + i] * point[j * kDimension + c];
        }
        energy += residual[c] * residual[c];
        if (!kGradient) continue;
        for (int j = 0; j < kWidth; ++j) sum[j * kDimension + c] += a[j * packs + i] * residual[c];
      }
    }
    for (int k = 0; kGradient && k < kEntries; ++k) gradient[k] = 2.0 * SumOfLanes(sum[k]);
    return SumOfLanes(energy);
  }
}

template <int kWidth, int kDimension, bool kGradient, bool kWithData>
double EvaluateAll(const BandedRows& rows, const double* points, double* gradient) {
  RowShape shape = rows.shape();
  if (kWidth > 0) {  // known to the loops over the window too
    shape.width = kWidth;
    shape.dimension = kDimension;
  }
  Window window(shape);
  std::vector<double> part(static_cast<std::size_t>(shape.width) * shape.dimension);
  CompensatedSum energy;
  for (std::size_t index = 0; index < rows.num_blocks(); ++index) {
    const RowBlock block = rows.BlockAndPrefetch(index);
    const double* near = window.Gather(points, block.first_column);
    energy.Add(
        EvaluateBlock<kWidth, kDimension, kGradient, kWithData>(shape, block, near, part.data()));
    if (kGradient) window.Add(part.data(), block.first_column, gradient);
  }
  return energy.value();
}

}  // namespace

double BandedRows::Evaluate(const double* control_points, double* gradient) const {
  return WithFixedShape(shape_.width, shape_.dimension, [&](auto width, auto dimension) {
    if (gradient == nullptr) {
      return EvaluateAll<width, dimension, false, true>(*this, control_points, nullptr);
    }
    return EvaluateAll<width, dimension, true, true>(*this, control_points, gradient);
  });
}

double BandedRows::SquaredNormOfProduct(const double* v) const {
  return WithFixedShape(shape_.width, shape_.dimension, [&](auto width, auto dimension) {
    return EvaluateAll<width, dimension, false, false>(*this, v, nullptr);
  });
}

void BandedRows::Residuals(const double* control_points, double* residuals) const {
  Window window(shape_);
  RowPack residual[kMaxRowsPerBlock / kPackLanes];
  const double* value = reinterpret_cast<const double*>(residual);
  const int d = shape_.dimension;
  for (std::size_t index = 0; index < num_blocks(); ++index) {
    const RowBlock rows = BlockAndPrefetch(index);
    const double* near = window.Gather(control_points, rows.first_column);
    double* target = residuals + static_cast<std::size_t>(blocks_[index].first_row) * d;
    for (int c = 0; c < d; ++c) {
      ResidualOfCoordinate<true>(shape_, rows, near, c, residual);
      for (int i = 0; i < rows.num_rows; ++i) target[i * d + c] = -value[i];
    }
  }
}

void BandedRows::AddTransposedProduct(const double* r, double* product) const {
  Window window(shape_);
  std::vector<double> part(static_cast<std::size_t>(shape_.width) * shape_.dimension);
  RowPack coordinate[kMaxRowsPerBlock / kPackLanes] = {};
  double* value = reinterpret_cast<double*>(coordinate);
  const int d = shape_.dimension;
  for (std::size_t index = 0; index < num_blocks(); ++index) {
    const RowBlock rows = BlockAndPrefetch(index);
    const double* source = r + static_cast<std::size_t>(blocks_[index].first_row) * d;
    for (int c = 0; c < d; ++c) {
      for (int i = 0; i < rows.num_rows; ++i) value[i] = source[i * d + c];
      std::fill(value + rows.num_rows, value + rows.stride, 0.0);
      GradientOfCoordinate(shape_, rows, coordinate, c, 1.0, part.data());
    }
    window.Add(part.data(), rows.first_column, product);
  }
}

void BandedRows::AddRoundingBound(const double* control_points, double* bound) const {
  Window window(shape_);
  const int d = shape_.dimension;
  std::vector<double> part(static_cast<std::size_t>(shape_.width) * d);
  for (std::size_t index = 0; index < num_blocks(); ++index) {
    const RowBlock rows = BlockAndPrefetch(index);
    const double* near = window.Gather(control_points, rows.first_column);
    std::fill(part.begin(), part.end(), 0.0);
    for (int c = 0; c < d; ++c) {
      for (int i = 0; i < rows.num_rows; ++i) {
        double size = std::abs(rows.right_hand_sides[c * rows.stride + i]);
        for (int j = 0; j < shape_.width; ++j) {
          size += std::abs(rows.coefficients[j * rows.stride + i] * near[j * d + c]);
        }
        for (int j = 0; j < shape_.width; ++j) {
          part[j * d + c] += std::abs(rows.coefficients[j * rows.stride + i]) * size;
        }
      }
    }
    window.Add(part.data(), rows.first_column, bound);
  }
}

}  // namespace batten
