#include "splines/block_gram.h"

#include <gtest/gtest.h>

#include <cmath>

#include "splines/points.h"
#include "tests/splines/integer_block.h"

namespace batten {
namespace {

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
