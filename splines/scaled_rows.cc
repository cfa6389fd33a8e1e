#include "splines/scaled_rows.h"

#include <cmath>
#include <utility>

#include "splines/row_pack.h"

namespace batten {
namespace {

class Scaler : public RowConsumer {
 public:
  Scaler(const RowShape& shape, const std::vector<double>& factors, RowConsumer* next)
      : columns_(shape.width + shape.dimension),
        width_(shape.width),
        factors_(factors),
        next_(next),
        storage_(static_cast<std::size_t>(kMaxRowsPerBlock) * columns_) {}

  void Consume(const RowBlock& block) override {
    for (int k = 0; k < columns_; ++k) {
      const double* const from = k < width_ ? block.coefficients + k * block.stride
                                            : block.right_hand_sides + (k - width_) * block.stride;
      double* const to = storage_.data() + k * block.stride;
      for (int i = 0; i < block.num_rows; ++i) to[i] = from[i] * factors_[next_row_ + i];
      for (int i = block.num_rows; i < block.stride; ++i) to[i] = 0.0;
    }
    next_row_ += static_cast<std::size_t>(block.num_rows);
    RowBlock scaled = block;
    scaled.coefficients = storage_.data();
    scaled.right_hand_sides = storage_.data() + width_ * block.stride;
    next_->Consume(scaled);
  }

 private:
  int columns_;
  int width_;
  const std::vector<double>& factors_;
  RowConsumer* next_;
  RowStorage storage_;
  std::size_t next_row_ = 0;
};

class NormCollector : public RowConsumer {
 public:
  NormCollector(const RowShape& shape, const double* control_points)
      : shape_(shape), control_points_(control_points) {}
  void Consume(const RowBlock& block) override {
    for (int i = 0; i < block.num_rows; ++i) {
      double squares = 0.0;
      for (int c = 0; c < shape_.dimension; ++c) {
        double residual = -block.right_hand_sides[c * block.stride + i];
        for (int j = 0; j < shape_.width; ++j) {
          const int column = (block.first_column + j) % shape_.num_columns;
          residual += block.coefficients[j * block.stride + i] *
                      control_points_[static_cast<std::ptrdiff_t>(column) * shape_.dimension + c];
        }
        squares += residual * residual;
      }
      norms.push_back(std::sqrt(squares));
    }
  }
  std::vector<double> norms;

 private:
  RowShape shape_;
  const double* control_points_;
};

}  // namespace

ScaledRows::ScaledRows(const RowSource* source, std::vector<double> factors)
    : source_(source), factors_(std::move(factors)) {}

void ScaledRows::Stream(RowConsumer* consumer) const {
  Scaler scaler(source_->shape(), factors_, consumer);
  source_->Stream(&scaler);
}

std::vector<double> ResidualNorms(const RowSource& source, const double* control_points) {
  NormCollector collector(source.shape(), control_points);
  source.Stream(&collector);
  return std::move(collector.norms);
}

}  // namespace batten
