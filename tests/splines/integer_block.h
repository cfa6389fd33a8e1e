#ifndef BATTEN_TESTS_SPLINES_INTEGER_BLOCK_H_
#define BATTEN_TESTS_SPLINES_INTEGER_BLOCK_H_

#include <Eigen/Core>
#include <random>

#include "splines/row_block.h"
#include "splines/row_pack.h"

namespace batten {

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

}  // namespace batten

#endif  // BATTEN_TESTS_SPLINES_INTEGER_BLOCK_H_
