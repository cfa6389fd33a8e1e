#include "solvers/paired_rows.h"

#include "splines/row_pack.h"

namespace batten {

PairedRows::PairedRows(const BandedRows& rows, const std::vector<int>& control_point_of_row)
    : width_(rows.shape().width),
      first_columns_(static_cast<std::size_t>(rows.shape().num_columns)),
      coefficients_(first_columns_.size() * static_cast<std::size_t>(width_)),
      data_(rows.shape().num_columns, rows.shape().dimension) {
  std::size_t row = 0;
  for (std::size_t b = 0; b < rows.num_blocks(); ++b) {
    const RowBlock block = rows.block(b);
    for (int i = 0; i < block.num_rows; ++i, ++row) {
      const auto j = static_cast<std::size_t>(control_point_of_row[row]);
      first_columns_[j] = block.first_column;
      for (int k = 0; k < width_; ++k) {
        coefficients_[j * static_cast<std::size_t>(width_) + static_cast<std::size_t>(k)] =
            block.coefficients[k * block.stride + i];
      }
      for (int c = 0; c < data_.cols(); ++c) {
        data_(static_cast<Eigen::Index>(j), c) = block.right_hand_sides[c * block.stride + i];
      }
    }
  }
}

template <int kWidth, int kDimension>
void PairedRows::ResidualsFixed(const double* control_points, double* residuals) const {
  const int n = size();
  const int width = kWidth > 0 ? kWidth : width_;
  const int d = kWidth > 0 ? kDimension : static_cast<int>(data_.cols());
  for (int j = 0; j < n; ++j) {
    const double* entry = coefficients_.data() + static_cast<std::size_t>(j) * width;
    const double* right = data_.data() + static_cast<std::size_t>(j) * d;
    double* const target = residuals + static_cast<std::size_t>(j) * d;
    const int first = first_columns_[static_cast<std::size_t>(j)];
    if (first + width <= n) {
      const double* near = control_points + static_cast<std::size_t>(first) * d;
      for (int c = 0; c < d; ++c) {
        double sum = right[c];
        for (int k = 0; k < width; ++k) sum -= entry[k] * near[k * d + c];
        target[c] = sum;
      }
    } else {
      for (int c = 0; c < d; ++c) {
        double sum = right[c];
        for (int k = 0; k < width; ++k) sum -= entry[k] * control_points[(first + k) % n * d + c];
        target[c] = sum;
      }
    }
  }
}

void PairedRows::Residuals(const double* control_points, Points* residuals) const {
  residuals->resize(data_.rows(), data_.cols());
  WithFixedShape(width_, static_cast<int>(data_.cols()), [&](auto width, auto dimension) {
    ResidualsFixed<width, dimension>(control_points, residuals->data());
  });
}

Eigen::SparseMatrix<double, Eigen::RowMajor> PairedRows::ToSparse() const {
  const int n = size();
  std::vector<Eigen::Triplet<double>> entries;
  for (int j = 0; j < n; ++j) {
    for (int k = 0; k < width_; ++k) {
      entries.emplace_back(j, (first_columns_[static_cast<std::size_t>(j)] + k) % n,
                           coefficients_[static_cast<std::size_t>(j * width_ + k)]);
    }
  }
  Eigen::SparseMatrix<double, Eigen::RowMajor> matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace batten
