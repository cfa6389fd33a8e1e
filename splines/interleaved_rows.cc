#include "splines/interleaved_rows.h"

#include <algorithm>

#include "splines/row_pack.h"

namespace batten {
namespace {

class Interleaver final : public RowConsumer {
 public:
  Interleaver(const RowShape& shape, RowConsumer* consumer)
      : shape_(shape),
        consumer_(consumer),
        storage_(static_cast<std::size_t>(shape.width * shape.dimension + 1) * kMaxRowsPerBlock) {}
  void Consume(const RowBlock& block) override {
    const int d = shape_.dimension;
    double* const coefficients = storage_.data();
    double* const right = coefficients + shape_.width * d * block.stride;
    for (int c = 0; c < d; ++c) {
      std::fill(coefficients, right, 0.0);
      for (int j = 0; j < shape_.width; ++j) {
        std::copy_n(block.coefficients + j * block.stride, block.stride,
                    coefficients + (j * d + c) * block.stride);
      }
      std::copy_n(block.right_hand_sides + c * block.stride, block.stride, right);
      RowBlock part = block;
      part.first_column = block.first_column * d;
      part.coefficients = coefficients;
      part.right_hand_sides = right;
      consumer_->Consume(part);
    }
  }

 private:
  RowShape shape_;
  RowConsumer* consumer_;
  RowStorage storage_;
};

}  // namespace

RowShape InterleavedRows::shape() const {
  RowShape shape = rows_->shape();
  shape.num_rows *= shape.dimension;
  shape.num_columns *= shape.dimension;
  shape.width *= shape.dimension;
  shape.dimension = 1;
  return shape;
}

void InterleavedRows::Stream(RowConsumer* consumer) const {
  Interleaver interleaver(rows_->shape(), consumer);
  rows_->Stream(&interleaver);
}

}  // namespace batten
