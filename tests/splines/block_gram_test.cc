#include "splines/block_gram.h"

#include "tests/splines/row_testing.h"

namespace batten {
namespace {

/// A block of integer rows, whose products and sums are exact.
struct IntegerBlock {
  IntegerBlock(const RowShape& shape, int num_rows, bool adjoin)
      : storage((shape.width + shape.dimension) * PaddedRows(num_rows)),
        apart(shape.dimension * PaddedRows(num_rows)) {
    block.num_rows = num_rows;
    block.stride = PaddedRows(num_rows);
    double* const a = storage.data();
    double* const q = adjoin ? a + shape.width * block.stride : apart.data();
    std::mt19937 random(20240606);
    std::uniform_int_distribution<int> entry(-3, 3);
    matrix.resize(num_rows, shape.width + shape.dimension);
    for (int i = 0; i < num_rows; ++i) {
      for (int j = 0; j < matrix.cols(); ++j) {
        double* const column =
            j < shape.width ? a + j * block.stride : q + (j - shape.width) * block.stride;
        column[i] = matrix(i, j) = entry(random);
      }
    }
    block.coefficients = a;
    block.right_hand_sides = q;
  }

  RowStorage storage;
  RowStorage apart;
  RowBlock block;
  Eigen::MatrixXd matrix;  // [A | Q]
};

TEST(BlockGram, IsTheDenseProductWithAndWithoutWideRegisters) {
  for (int width = 1; width <= 7; ++width) {
    for (int d = 1; d <= 4; ++d) {
      for (const int num_rows : {4, 5, 8, 31, 100, kMaxRowsPerBlock}) {
        for (const bool adjoin : {true, false}) {
          RowShape shape;
          shape.width = width;
          shape.dimension = d;
          const IntegerBlock rows(shape, num_rows, adjoin);
          const Eigen::MatrixXd dense = rows.matrix.transpose() * rows.matrix;
          for (const auto& gram_of : {BlockGram, BlockGramOfAnyProcessor}) {
            Points gram = Points::Constant(width, width + d, std::nan(""));
            const double norm = gram_of(shape, rows.block, gram.data());
            EXPECT_EQ(norm, rows.matrix.rightCols(d).squaredNorm());
            for (int j = 0; j < width; ++j) {
              for (int k = j; k < width + d; ++k) {
                ASSERT_EQ(gram(j, k), dense(j, k))
                    << "width " << width << ", d = " << d << ", " << num_rows << " rows";
              }
            }
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace batten
