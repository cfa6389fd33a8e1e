#include "splines/block_energy.h"

#include <gtest/gtest.h>

#include <cmath>

#include "splines/points.h"
#include "tests/splines/integer_block.h"

namespace batten {
namespace {

// Whole numbers: every order of summation gives the same bits.
TEST(BlockEnergy, IsTheDenseOneWithAndWithoutWideRegisters) {
  for (int width = 1; width <= 7; ++width) {
    for (int d = 1; d <= 4; ++d) {
      for (const int num_rows : {1, 4, 5, 31, 100, kMaxRowsPerBlock}) {
        RowShape shape;
        shape.width = width;
        shape.dimension = d;
        const IntegerBlock rows(shape, num_rows, true);
        Points points(width, d);
        for (int j = 0; j < width; ++j) {
          for (int c = 0; c < d; ++c) points(j, c) = (5 * j + 3 * c) % 7 - 2;
        }
        const Eigen::MatrixXd product = rows.matrix.leftCols(width) * points;
        const Eigen::MatrixXd residual = product - rows.matrix.rightCols(d);
        const Eigen::MatrixXd gradient = 2.0 * rows.matrix.leftCols(width).transpose() * residual;
        for (const auto& find : {FindBlockEnergyKernel, FindBlockEnergyKernelOfAnyProcessor}) {
          const auto value = [&](BlockQuantity quantity, Points* g) {
            return find(shape, quantity)(shape, rows.block, points.data(), g->data());
          };
          Points g = Points::Constant(width, d, std::nan(""));
          EXPECT_EQ(value(BlockQuantity::kEnergy, &g), residual.squaredNorm());
          EXPECT_EQ(value(BlockQuantity::kProductNorm, &g), product.squaredNorm());
          EXPECT_EQ(value(BlockQuantity::kEnergyAndGradient, &g), residual.squaredNorm());
          EXPECT_TRUE((g.array() == gradient.array()).all())
              << "width " << width << ", d = " << d << ", " << num_rows << " rows";
        }
      }
    }
  }
}

}  // namespace
}  // namespace batten
