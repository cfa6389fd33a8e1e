#include "splines/banded_rows.h"

#include <Eigen/SparseCore>
#include <limits>
#include <utility>

#include "tests/splines/row_testing.h"

namespace batten {
namespace {

// Rows of small integers at integer points: all sums below 2^53 are exact in any order, so that
// equal means equal.

TEST(BandedRows, EvaluatesTheDenseSumOfSquaresAndItsGradient) {
  for (const BandCase& c : AllBandCases()) {
    SCOPED_TRACE(ToText(c));
    const ListedRows listed = IntegerRows(c, 0, 4, 20240501);
    const BandedRows rows({&listed});
    const Points p = IntegerPoints(c.num_columns, c.dimension, 7);
    const Eigen::MatrixXd a = listed.Matrix();
    const Eigen::MatrixXd residual = a * p - listed.RightHandSides();
    EXPECT_EQ(rows.Evaluate(p.data(), nullptr), residual.squaredNorm());
    Points gradient = Points::Constant(c.num_columns, c.dimension, 3.0);
    EXPECT_EQ(rows.Evaluate(p.data(), gradient.data()), residual.squaredNorm());
    gradient.array() -= 3.0;
    EXPECT_EQ(gradient, Points(2.0 * a.transpose() * residual)) << "is added to the gradient";
    EXPECT_EQ(rows.SquaredNormOfProduct(p.data()), (a * p).squaredNorm());
  }
}

TEST(BandedRows, ResidualsAndTransposedProductAreTheDenseOnes) {
  for (const BandCase& c : AllBandCases()) {
    SCOPED_TRACE(ToText(c));
    const ListedRows listed = IntegerRows(c, 0, 4, 20240502);
    const BandedRows rows({&listed});
    const Points p = IntegerPoints(c.num_columns, c.dimension, 8);
    const Eigen::MatrixXd a = listed.Matrix();
    Points residuals(listed.shape().num_rows, c.dimension);
    rows.Residuals(p.data(), residuals.data());
    EXPECT_EQ(residuals, Points(listed.RightHandSides() - a * p));
    Points product = Points::Ones(c.num_columns, c.dimension);
    rows.AddTransposedProduct(residuals.data(), product.data());
    EXPECT_EQ(product,
              Points(Points::Ones(c.num_columns, c.dimension) + a.transpose() * residuals));
  }
}

TEST(BandedRows, RoundingBoundIsTheDenseOne) {
  for (const BandCase& c : AllBandCases()) {
    if (c.cyclic && c.num_columns < c.width) continue;  // the dense matrix has added coefficients
    SCOPED_TRACE(ToText(c));
    const ListedRows listed = IntegerRows(c, 0, 4, 20240503);
    const BandedRows rows({&listed});
    const Points p = IntegerPoints(c.num_columns, c.dimension, 9);
    const Eigen::MatrixXd a = listed.Matrix().cwiseAbs();
    const Eigen::MatrixXd sizes = a * p.cwiseAbs() + listed.RightHandSides().cwiseAbs();
    Points bound = Points::Ones(c.num_columns, c.dimension);
    rows.AddRoundingBound(p.data(), bound.data());
    EXPECT_EQ(bound, Points(Points::Ones(c.num_columns, c.dimension) + a.transpose() * sizes));
  }
}

TEST(BandedRows, KeepsRowsOfOneColumnTogetherHoweverTheyArrive) {
  const BandCase c = {9, 4, 2, true};
  ListedRows listed = IntegerRows(c, 70, 150, 20240504);
  const BandedRows whole({&listed});
  std::size_t num_blocks = 0;
  for (int column = 0; column < c.num_columns; ++column) {
    num_blocks += (listed.NumRowsAt(column) + kMaxRowsPerBlock - 1) / kMaxRowsPerBlock;
  }
  EXPECT_EQ(whole.num_blocks(), num_blocks);
  for (const int rows_per_block : {1, 5, 63}) {
    listed.set_rows_per_block(rows_per_block);
    const BandedRows pieces({&listed});
    EXPECT_EQ(pieces.num_blocks(), num_blocks);
    EXPECT_EQ(AllRows(pieces), AllRows(whole));
  }
}

TEST(BandedRows, BlocksAreAlignedAndPaddedWithZeros) {
  const ListedRows listed = IntegerRows({9, 3, 2, false}, 1, 70, 20240505);
  const BandedRows rows({&listed});
  for (std::size_t index = 0; index < rows.num_blocks(); ++index) {
    const RowBlock block = rows.block(index);
    EXPECT_EQ(reinterpret_cast<std::size_t>(block.coefficients) % 32, 0u);
    EXPECT_EQ(reinterpret_cast<std::size_t>(block.right_hand_sides) % 32, 0u);
    ASSERT_EQ(block.stride % kRowPack, 0);
    for (int i = block.num_rows; i < block.stride; ++i) {
      for (int k = 0; k < 5; ++k) EXPECT_EQ(block.coefficients[k * block.stride + i], 0.0);
    }
  }
}

TEST(BandedRows, OrdersByColumnThenSourceAndPadsNarrowRows) {
  for (const bool cyclic : {false, true}) {
    ListedRows wide(5, 3, 1, cyclic);
    ListedRows narrow(5, 2, 1, cyclic);
    narrow.Add(0, {1, 2}, {1});
    narrow.Add(2, {3, 4}, {2});
    narrow.Add(3, {5, 6}, {3});  // columns 3 and 4: padded on the right it would leave the matrix
    wide.Add(0, {7, 8, 9}, {4});
    wide.Add(2, {1, 1, 1}, {5});
    const BandedRows rows({&wide, &narrow});
    EXPECT_EQ(rows.shape().num_rows, 5);
    EXPECT_EQ(rows.shape().width, 3);
    Eigen::MatrixXd expected(5, 6);
    expected << 7, 8, 9, 0, 0, 4,  //
        1, 2, 0, 0, 0, 1,          //
        0, 0, 1, 1, 1, 5,          //
        0, 0, 3, 4, 0, 2,          //
        0, 0, 0, 5, 6, 3;
    EXPECT_EQ(AllRows(rows), expected);
  }
}

TEST(BandedRows, LoopsOfFixedLengthAgreeWithThoseOfAnyLength) {
  for (const int width : {2, 3, 4, 5, 6}) {
    for (const int d : {1, 2, 3}) {
      const ListedRows listed = IntegerRows({12, width, d, true}, 1, 90, 20240506);
      const ListedRows no_rows(12, 7, d, true);  // pads the others to a width without fixed loops
      const BandedRows fixed({&listed});
      const BandedRows any({&listed, &no_rows});
      ASSERT_EQ(any.shape().width, 7);
      const Points p = IntegerPoints(12, d, 10);
      Points fixed_gradient = Points::Zero(12, d);
      Points any_gradient = Points::Zero(12, d);
      EXPECT_EQ(fixed.Evaluate(p.data(), fixed_gradient.data()),
                any.Evaluate(p.data(), any_gradient.data()));
      EXPECT_EQ(fixed_gradient, any_gradient);
    }
  }
}

TEST(BandedRows, EnergyKeepsSmallBlocksBesideALargeOne) {
  // 1e16 + 1 is 1e16 in doubles; 1e16 + 1000 is a double.
  ListedRows listed(1001, 1, 1, false);
  listed.Add(0, {1}, {1e8});
  for (int column = 1; column <= 1000; ++column) listed.Add(column, {1}, {1});
  const Points p = Points::Zero(1001, 1);
  EXPECT_EQ(BandedRows({&listed}).Evaluate(p.data(), nullptr), 1e16 + 1000);
}

TEST(BandedRows, MayBeEmpty) {
  const ListedRows none(5, 3, 2, false);
  const BandedRows rows({&none});
  EXPECT_EQ(rows.num_blocks(), 0u);
  EXPECT_EQ(rows.shape().num_rows, 0);
  const Points p = Points::Ones(5, 2);
  Points gradient = Points::Ones(5, 2);
  EXPECT_EQ(rows.Evaluate(p.data(), gradient.data()), 0.0);
  EXPECT_EQ(gradient, p);
}

TEST(BandedRows, NonFiniteNumbersComeOutAsSuch) {
  for (const int width : {4, 7}) {
    for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
      const ListedRows listed = IntegerRows({20, width, 2, false}, 1, 3, 20240507);
      Points p = IntegerPoints(20, 2, 11);
      p(10, 1) = bad;
      EXPECT_FALSE(std::isfinite(BandedRows({&listed}).Evaluate(p.data(), nullptr)));
    }
  }
}

using SparseRowMajor = Eigen::SparseMatrix<double, Eigen::RowMajor>;

void ExpectSubstitution(const ListedRows& listed, const SparseRowMajor& z, const Points& offset) {
  const BandedRows rows({&listed});
  const BandedRows substituted = rows.Substitute(z, offset);
  const int d = rows.shape().dimension;
  const int n = static_cast<int>(z.cols());
  ASSERT_EQ(substituted.shape().num_columns, n);
  EXPECT_EQ(substituted.shape().num_rows, rows.shape().num_rows);
  const Points y = IntegerPoints(n, d, 12);
  const Points p = offset + z * y;
  Points gradient = Points::Zero(n, d);
  Points full_gradient = Points::Zero(offset.rows(), d);
  EXPECT_EQ(substituted.Evaluate(y.data(), gradient.data()),
            rows.Evaluate(p.data(), full_gradient.data()));
  EXPECT_EQ(gradient, Points(z.transpose() * full_gradient));
}

TEST(BandedRows, SubstitutionEvaluatesTheSameEnergy) {
  for (const BandCase& c : AllBandCases()) {
    SCOPED_TRACE(ToText(c));
    const ListedRows listed = IntegerRows(c, 0, 4, 20240508);
    const Points offset = IntegerPoints(c.num_columns, c.dimension, 13);
    std::mt19937 random(20240509);
    for (const int n : {c.num_columns, (c.num_columns + 1) / 2, 1, 0}) {
      SparseRowMajor z(c.num_columns, n);
      for (int row = 0; row < c.num_columns && n > 0; ++row) {
        // A known row, an unknown of its own, or a sum of two neighbours.
        const int kind = static_cast<int>(random() % 3);
        const int column = row * n / c.num_columns;
        if (kind > 0) z.coeffRef(row, column) += kind;
        if (kind > 1) z.coeffRef(row, (column + 1) % n) -= 1;
      }
      ExpectSubstitution(listed, z, offset);
    }
  }
}

int WidthAfter(const ListedRows& listed, const SparseRowMajor& z) {
  const Points offset = Points::Zero(z.rows(), listed.shape().dimension);
  return BandedRows({&listed}).Substitute(z, offset).shape().width;
}

TEST(BandedRows, SubstitutionIsAsWideAsTheShortestArc) {
  SparseRowMajor identity(8, 8);
  identity.setIdentity();
  EXPECT_EQ(WidthAfter(IntegerRows({8, 3, 2, true}, 4, 4, 20240510), identity), 3);

  ListedRows narrow(8, 2, 1, false);
  narrow.Add(1, {1, 2}, {0});
  const ListedRows wide(8, 5, 1, false);
  const BandedRows padded({&narrow, &wide});
  EXPECT_EQ(padded.Substitute(identity, Points::Zero(8, 1)).shape().width, 2) << "not the padding";

  // P_1 hangs on the unknowns at both ends: next to each other on a circle, far apart otherwise.
  SparseRowMajor ends = identity;
  ends.coeffRef(1, 1) = 0;
  ends.coeffRef(1, 0) = 1;
  ends.coeffRef(1, 7) = 1;
  for (const bool cyclic : {false, true}) {
    ListedRows listed(8, 1, 1, cyclic);
    listed.Add(1, {1}, {0});
    EXPECT_EQ(WidthAfter(listed, ends), cyclic ? 2 : 8);
  }
}

TEST(BandedRows, SubstitutionOrdersRowsByTheirNewColumns) {
  ListedRows listed(4, 1, 1, false);
  for (int column = 0; column < 4; ++column) listed.Add(column, {1.0 + column}, {10.0 * column});
  SparseRowMajor reversal(4, 4);
  for (int row = 0; row < 4; ++row) reversal.insert(row, 3 - row) = 1;
  const BandedRows rows = BandedRows({&listed}).Substitute(reversal, Points::Ones(4, 1));
  Eigen::MatrixXd expected(4, 5);
  expected << 4, 0, 0, 0, 26,  // right-hand sides less the offset's part
      0, 3, 0, 0, 17,          //
      0, 0, 2, 0, 8,           //
      0, 0, 0, 1, -1;
  EXPECT_EQ(AllRows(rows), expected);
}

}  // namespace
}  // namespace batten
