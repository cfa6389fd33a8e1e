#include "splines/band_sweep.h"

#include <algorithm>

#include "splines/row_pack.h"

namespace batten {

BandSweep::BandSweep(const NormalBand* band) : band_(band), inverse_diagonal_(band->Diagonal()) {
  for (double& entry : inverse_diagonal_) entry = entry > 0.0 ? 1.0 / entry : 0.0;
}

void BandSweep::RowResidual(int j, const double* control_points, double* residual) const {
  const int n = band_->size();
  const int width = band_->width();
  const int d = band_->dimension();
  const double* right = band_->right_hand_side().data() + static_cast<std::size_t>(j) * d;
  std::copy_n(right, d, residual);
  const auto subtract = [&](int row, int k, int column) {
    const double entry = band_->band()[static_cast<std::size_t>(row) * width + k];
    const double* source = control_points + static_cast<std::size_t>(column) * d;
    for (int c = 0; c < d; ++c) residual[c] -= entry * source[c];
  };
  for (int k = width - 1; k > 0; --k) {
    if (j - k < 0 && !band_->cyclic()) continue;
    const int before = ((j - k) % n + n) % n;
    subtract(before, k, before);
  }
  for (int k = 0; k < width; ++k) {
    if (j + k >= n && !band_->cyclic()) break;
    subtract(j, k, (j + k) % n);
  }
}

void BandSweep::SweepRows(int begin, int end, double relaxation, double* control_points) const {
  const int d = band_->dimension();
  std::vector<double> residual(static_cast<std::size_t>(d));
  for (int j = begin; j < end; ++j) {
    RowResidual(j, control_points, residual.data());
    const double factor = relaxation * inverse_diagonal_[static_cast<std::size_t>(j)];
    double* point = control_points + static_cast<std::size_t>(j) * d;
    for (int c = 0; c < d; ++c) point[c] += factor * residual[static_cast<std::size_t>(c)];
  }
}

template <int kWidth, int kDimension>
void BandSweep::SweepInside(int begin, int end, double relaxation, double* control_points) const {
  if constexpr (kWidth < 0) {
    SweepRows(begin, end, relaxation, control_points);
  } else {
    const double* const band = band_->band().data();
    const double* const right = band_->right_hand_side().data();
    for (int j = begin; j < end; ++j) {
      const double* entry = band + static_cast<std::size_t>(j) * kWidth;
      double* const near = control_points + static_cast<std::size_t>(j) * kDimension;
      double sum[kDimension];
      for (int c = 0; c < kDimension; ++c) {
        sum[c] = right[static_cast<std::size_t>(j) * kDimension + c];
      }
      // What was moved last comes last: a row waits for the one before it no longer than it must.
      for (int k = 0; k < kWidth; ++k) {
        for (int c = 0; c < kDimension; ++c) sum[c] -= entry[k] * near[k * kDimension + c];
      }
      for (int k = kWidth - 1; k > 0; --k) {
        for (int c = 0; c < kDimension; ++c) {
          sum[c] -= entry[k - k * kWidth] * near[c - k * kDimension];
        }
      }
      const double factor = relaxation * inverse_diagonal_[static_cast<std::size_t>(j)];
      for (int c = 0; c < kDimension; ++c) near[c] += factor * sum[c];
    }
  }
}

void BandSweep::Sweep(double relaxation, double* control_points) const {
  const int n = band_->size();
  const int reach = std::max(band_->width() - 1, 0);
  const int inside_begin = std::min(reach, n);
  const int inside_end = std::max(inside_begin, n - reach);
  SweepRows(0, inside_begin, relaxation, control_points);
  WithFixedShape(band_->width(), band_->dimension(), [&](auto width, auto dimension) {
    SweepInside<width, dimension>(inside_begin, inside_end, relaxation, control_points);
  });
  SweepRows(inside_end, n, relaxation, control_points);
}

}  // namespace batten
