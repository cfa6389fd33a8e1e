#include <algorithm>
#include <cmath>
#include <vector>

#include "splines/banded_rows.h"
#include "splines/block_energy.h"
#include "splines/row_window.h"

namespace batten {
namespace {

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

/// ||A P - Q||^2 by kernel, block by block; to gradient, unless it is null, 2 A'(A P - Q) is added.
double SumOfBlocks(const BandedRows& rows, BlockEnergyKernel* kernel, const double* points,
                   double* gradient) {
  const RowShape& shape = rows.shape();
  RowWindow window(shape);
  std::vector<double> part(static_cast<std::size_t>(shape.width) * shape.dimension);
  CompensatedSum energy;
  for (std::size_t index = 0; index < rows.num_blocks(); ++index) {
    const RowBlock block = rows.BlockAndPrefetch(index);
    const double* near = window.Gather(points, block.first_column);
    energy.Add(kernel(shape, block, near, part.data()));
    if (gradient != nullptr) window.Add(part.data(), block.first_column, gradient);
  }
  return energy.value();
}

}  // namespace

double BandedRows::Evaluate(const double* control_points, double* gradient) const {
  const auto quantity =
      gradient == nullptr ? BlockQuantity::kEnergy : BlockQuantity::kEnergyAndGradient;
  return SumOfBlocks(*this, FindBlockEnergyKernel(shape_, quantity), control_points, gradient);
}

double BandedRows::SquaredNormOfProduct(const double* v) const {
  return SumOfBlocks(*this, FindBlockEnergyKernel(shape_, BlockQuantity::kProductNorm), v, nullptr);
}

void BandedRows::Residuals(const double* control_points, double* residuals) const {
  RowWindow window(shape_);
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
  RowWindow window(shape_);
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
  RowWindow window(shape_);
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
