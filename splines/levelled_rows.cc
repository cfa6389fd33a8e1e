#include "splines/levelled_rows.h"

#include <algorithm>
#include <cmath>

#include "splines/row_pack.h"

namespace batten {
namespace {

class Leveller : public RowConsumer {
 public:
  Leveller(const RowShape& shape, RowConsumer* next)
      : shape_(shape),
        next_(next),
        storage_(static_cast<std::size_t>(kMaxRowsPerBlock) * (shape.width + shape.dimension)) {}

  void Consume(const RowBlock& block) override {
    RowBlock levelled = block;
    double* const coefficients = storage_.data();
    double* const right_hand_sides = coefficients + shape_.width * block.stride;
    std::copy_n(block.coefficients, shape_.width * block.stride, coefficients);
    std::copy_n(block.right_hand_sides, shape_.dimension * block.stride, right_hand_sides);
    for (int i = 0; i < block.num_rows; ++i) {
      const double norm = Norm(block, i);
      if (!(norm > 0.0)) continue;
      for (int j = 0; j < shape_.width; ++j) coefficients[j * block.stride + i] /= norm;
      for (int c = 0; c < shape_.dimension; ++c) right_hand_sides[c * block.stride + i] /= norm;
    }
    levelled.coefficients = coefficients;
    levelled.right_hand_sides = right_hand_sides;
    next_->Consume(levelled);
  }

 private:
  double Norm(const RowBlock& block, int i) const {
    double squares = 0.0;
    for (int j = 0; j < shape_.width; ++j) {
      const double entry = block.coefficients[j * block.stride + i];
      squares += entry * entry;
    }
    return std::sqrt(squares);
  }

  RowShape shape_;
  RowConsumer* next_;
  RowStorage storage_;
};

}  // namespace

RowShape LevelledRows::shape() const {
  RowShape shape = source_->shape();
  shape.graded = false;
  return shape;
}

void LevelledRows::Stream(RowConsumer* consumer) const {
  Leveller leveller(source_->shape(), consumer);
  source_->Stream(&leveller);
}

}  // namespace batten
