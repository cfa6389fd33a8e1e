#include "splines/banded_qr.h"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <cmath>
#include <limits>

#include "splines/banded_cholesky.h"
#include "splines/banded_rows.h"
#include "tests/splines/row_testing.h"

namespace batten {
namespace {

BandedQr Factor(const RowSource& rows) {
  BandedQr qr(rows.shape());
  rows.Stream(&qr);
  qr.Finish();
  return qr;
}

double Condition(const Eigen::MatrixXd& matrix) {
  const Eigen::VectorXd sizes = Eigen::JacobiSVD<Eigen::MatrixXd>(matrix).singularValues();
  return sizes(0) / sizes(sizes.size() - 1);
}

/// R and the right-hand side that goes with it, read row by row.
struct DenseTriangle {
  DenseTriangle(const BandedQr& qr, int n, int dimension)
      : r(Eigen::MatrixXd::Zero(n, n)), right(n, dimension) {
    const int num_band = qr.num_band_columns();
    EXPECT_EQ(num_band + qr.num_tail_columns(), n);
    std::vector<double> window(qr.width());
    std::vector<double> tail(qr.num_tail_columns());
    for (int j = 0; j < n; ++j) {
      Eigen::RowVectorXd values(dimension);
      qr.CopyRow(j, window.data(), tail.data(), values.data());
      right.row(j) = values;
      for (int k = 0; k < qr.width() && j + k < num_band; ++k) r(j, j + k) = window[k];
      for (int k = 0; k < qr.num_tail_columns(); ++k) r(j, num_band + k) = tail[k];
    }
  }
  Eigen::MatrixXd r;
  Eigen::MatrixXd right;
};

TEST(BandedQr, SolvesToTheConditionOfTheRows) {
  for (const BandCase& c : AllBandCases()) {
    SCOPED_TRACE(ToText(c));
    const ListedRows listed = RandomRows(c, c.width, 4 * c.width, 20240801);
    const BandedQr qr = Factor(listed);
    ASSERT_TRUE(qr.full_rank());
    const Eigen::MatrixXd a = listed.Matrix();
    const Eigen::MatrixXd q = listed.RightHandSides();
    const Eigen::MatrixXd expected = a.householderQr().solve(q);
    const double residual = (a * expected - q).squaredNorm();
    // Both solutions are off by cond |P| + cond^2 |r| / ||A|| roundings (Higham 2002,
    // theorem 20.1), of which there are some width in the band and some n in the dense factor.
    const double condition = Condition(a);
    const double roundings = (c.num_columns + 8 * c.width) * kEpsilon;
    const double size = 1 + expected.norm() + condition * std::sqrt(residual) / a.norm();
    Points solution;
    qr.Solve(&solution);
    EXPECT_LE((solution - expected).norm(), roundings * condition * size);
    EXPECT_NEAR(qr.residual_sum_of_squares(), residual, roundings * q.squaredNorm());
  }
}

TEST(BandedQr, TriangleHasTheNormalMatrixOfTheRows) {
  for (const BandCase& c : AllBandCases()) {
    SCOPED_TRACE(ToText(c));
    const ListedRows listed = RandomRows(c, c.width, 2 * c.width, 20240802);
    const BandedQr qr = Factor(listed);
    const int n = c.num_columns;
    const Eigen::MatrixXd a = listed.Matrix();
    const double tolerance = (n + 8 * c.width) * kEpsilon * a.squaredNorm();
    const Points x = RandomPoints(n, c.dimension, 3);
    const DenseTriangle dense(qr, n, c.dimension);
    EXPECT_TRUE(dense.r.isUpperTriangular());
    EXPECT_LE((dense.r.transpose() * dense.r - a.transpose() * a).norm(), tolerance);
    const Eigen::MatrixXd q = listed.RightHandSides();
    EXPECT_LE((dense.r.transpose() * dense.right - a.transpose() * q).norm(),
              tolerance * (1 + q.norm()));
    const double inverse_tolerance = 8 * c.width * kEpsilon * Condition(a) * x.norm();
    Points product = dense.r * x;
    qr.SolveTriangle(c.dimension, product.data());
    EXPECT_LE((product - x).norm(), inverse_tolerance);
    Points back = dense.r.transpose() * x;
    qr.SolveTransposedTriangle(c.dimension, back.data());
    EXPECT_LE((back - x).norm(), inverse_tolerance * a.norm());
  }
}

TEST(BandedQr, FindsTheDiagonalOfOrthogonalColumns) {
  // Rows (3, 4) and (4, -3) on disjoint pairs of columns: all columns are orthogonal, of norm 5.
  for (const bool cyclic : {false, true}) {
    for (const int n : {2, 4, 30}) {
      ListedRows listed(n, 2, 1, cyclic);
      for (int j = 0; j < n; j += 2) {
        listed.Add(j, {3, 4}, {3.0 * j + 4.0 * (j + 1)});
        listed.Add(j, {4, -3}, {4.0 * j - 3.0 * (j + 1)});
      }
      const BandedQr qr = Factor(listed);
      EXPECT_NEAR(qr.LargestDiagonal(), 5, 20 * kEpsilon);
      EXPECT_NEAR(qr.DiagonalRatio(), 1, 8 * kEpsilon);
      Points solution;
      qr.Solve(&solution);
      for (int j = 0; j < n; ++j) EXPECT_NEAR(solution(j, 0), j, 20 * kEpsilon * (j + 1));
    }
  }
}

TEST(BandedQr, RatioOfADiagonalMatrixIsThatOfItsEntries) {
  for (const bool cyclic : {false, true}) {
    for (const int n : {5, 11, 40}) {
      ListedRows listed(n, 4, 1, cyclic);
      for (int j = 0; j < n; ++j) {
        std::vector<double> row(4, 0.0);
        const int first = cyclic ? j : std::min(j, n - 4);
        row[j - first] = j == 2 ? 1.0 / 1024 : 8;
        listed.Add(first, row, {1});
      }
      EXPECT_EQ(Factor(listed).DiagonalRatio(), 1.0 / 8192);
    }
  }
}

TEST(BandedQr, ReturnsThePointsThatTheRowsInterpolate) {
  for (const BandCase& c : AllBandCases()) {
    if (c.width > 6 || (c.cyclic && c.num_columns < c.width)) continue;
    SCOPED_TRACE(ToText(c));
    ListedRows listed(c.num_columns, c.width, c.dimension, c.cyclic);
    const Points p = IntegerPoints(c.num_columns, c.dimension, 4);
    // Diagonally dominant: 2 width on one place, -1 or 1 elsewhere.
    for (int j = 0; j < c.num_columns; ++j) {
      const int first = c.cyclic ? j : std::min(j, c.num_columns - c.width);
      std::vector<double> row(c.width);
      for (int k = 0; k < c.width; ++k) row[k] = (j + k) % 3 == 0 ? -1 : 1;
      row[j - first] = 2 * c.width;
      std::vector<double> right(c.dimension, 0.0);
      for (int k = 0; k < c.width; ++k) {
        for (int i = 0; i < c.dimension; ++i) {
          right[i] += row[k] * p((first + k) % c.num_columns, i);
        }
      }
      listed.Add(first, row, right);
    }
    const BandedQr qr = Factor(listed);
    Points solution;
    qr.Solve(&solution);
    // Entries up to 5, condition below (3 width) / width.
    EXPECT_LE((solution - p).cwiseAbs().maxCoeff(), 5 * 3 * 8 * c.width * kEpsilon);
    EXPECT_LE(qr.residual_sum_of_squares(), std::pow(100 * c.width * kEpsilon, 2) * p.size());
  }
}

TEST(BandedQr, ErrorGrowsWithTheConditionAndCholeskysWithItsSquare) {
  for (const double delta : {1e-2, 1e-4, 1e-6, 1e-7}) {
    // Pairs of columns with rows (1, 1) and (1, 1 + delta), condition about 4 / delta, next to rows
    // that couple the pairs; the points interpolate.
    ListedRows listed(20, 3, 1, true);
    for (int j = 0; j < 20; j += 2) {
      listed.Add(j, {1, 1, 0}, {0.3 + 0.7});
      listed.Add(j, {1, 1 + delta, 0}, {0.3 + (1 + delta) * 0.7});
      listed.Add(j + 1, {1, 1, 0}, {0.7 + 0.3});
    }
    const double condition = Condition(listed.Matrix());
    EXPECT_GT(condition, 1 / delta);
    Points expected(20, 1);
    for (int j = 0; j < 20; ++j) expected(j, 0) = j % 2 == 0 ? 0.3 : 0.7;
    Points solution;
    Factor(listed).Solve(&solution);
    const double tolerance = 8 * 3 * kEpsilon * condition;
    EXPECT_LE((solution - expected).norm(), tolerance);
    const NormalBand band = NormalBand::FromRows(listed);
    BandedCholesky cholesky;
    if (!cholesky.Factor(band)) continue;
    solution = band.right_hand_side();
    cholesky.Solve(solution.data(), 1);
    EXPECT_LE((solution - expected).norm(), tolerance * condition);
  }
}

TEST(BandedQr, LongCyclicRowsSolveTheNormalEquations) {
  // With a data row on each span what is carried from the end decays within 300 columns; with
  // second differences and two data rows alone it goes all the way round.
  const int n = 1000;
  for (const bool decays : {true, false}) {
    const BandCase c = {n, 4, 2, true};
    ListedRows listed =
        BsplineRows(c, decays ? 3 : 2, 20240803, [&](int j) { return decays || j % 500 == 0; });
    for (int j = 0; j < n; ++j) listed.Add(j, {1, -2, 1, 0}, {0, 0});
    const BandedRows rows({&listed});
    const BandedQr qr = Factor(rows);
    ASSERT_TRUE(qr.full_rank());
    Points solution;
    qr.Solve(&solution);
    Points gradient = Points::Zero(n, 2);
    Points rounding = Points::Zero(n, 2);
    const double energy = rows.Evaluate(solution.data(), gradient.data());
    rows.AddRoundingBound(solution.data(), rounding.data());
    // 2 A'r with A and Q each off by some width roundings; the largest bound for all, since
    // reflections mix rows of different sizes.
    EXPECT_LE(gradient.cwiseAbs().maxCoeff(), 100 * 4 * kEpsilon * rounding.maxCoeff());
    EXPECT_NEAR(qr.residual_sum_of_squares(), energy, 1000 * kEpsilon * energy);
  }
}

TEST(BandedQr, LoopsOfFixedLengthAgreeWithThoseOfAnyLength) {
  for (const int width : {2, 3, 4, 5, 6}) {
    for (const int d : {1, 2, 3}) {
      const ListedRows listed = RandomRows({24, width, d, true}, 60, 150, 20240804);
      const ListedRows no_rows(24, 7, d, true);  // pads the others to a width without fixed loops
      Points fixed;
      Points any;
      Factor(BandedRows({&listed})).Solve(&fixed);
      Factor(BandedRows({&listed, &no_rows})).Solve(&any);
      // Some 100 random rows a column: condition below 3, solutions below 1.
      EXPECT_LE((fixed - any).cwiseAbs().maxCoeff(), 3 * 8 * 7 * kEpsilon);
    }
  }
}

TEST(BandedQr, DoesNotMindHowRowsAreCutIntoBlocks) {
  ListedRows listed = RandomRows({12, 4, 2, true}, 60, 300, 20240805);
  Points whole;
  Factor(listed).Solve(&whole);
  for (const int rows_per_block : {1, 7, 63}) {
    listed.set_rows_per_block(rows_per_block);
    Points pieces;
    Factor(listed).Solve(&pieces);
    EXPECT_LE((pieces - whole).cwiseAbs().maxCoeff(), 3 * 8 * 4 * kEpsilon);
  }
}

TEST(BandedQr, SeesThatTheRankIsNotFull) {
  const auto rows_of = [](const BandCase& c, auto keep) {
    return BsplineRows(c, 9, 20240806, keep);
  };
  for (const bool cyclic : {false, true}) {
    const BandCase c = {40, 4, 2, cyclic};
    EXPECT_TRUE(Factor(rows_of(c, [](int) { return true; })).full_rank());
    EXPECT_FALSE(Factor(rows_of(c, [](int j) { return j < 10 || j > 15; })).full_rank());
    EXPECT_FALSE(Factor(rows_of(c, [](int j) { return j == 5; })).full_rank());
    EXPECT_FALSE(Factor(rows_of(c, [](int j) { return j >= 35; })).full_rank());
    const BandedQr none = Factor(ListedRows(40, 4, 2, cyclic));
    EXPECT_FALSE(none.full_rank());
    EXPECT_EQ(none.DiagonalRatio(), 0);
    ListedRows zeros(40, 4, 2, cyclic);
    for (int j = 0; j < 36; ++j) zeros.Add(j, {0, 0, 0, 0}, {1, 2});
    EXPECT_FALSE(Factor(zeros).full_rank());
    EXPECT_EQ(Factor(zeros).residual_sum_of_squares(), 36 * 5);
    EXPECT_FALSE(Factor(ListedRows(3, 0, 2, cyclic)).full_rank());
    EXPECT_TRUE(Factor(ListedRows(0, 4, 2, cyclic)).full_rank()) << "no columns";
  }
}

TEST(BandedQr, NonFiniteRowsHaveNoRank) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    for (const BandCase& c : {BandCase{20, 4, 2, false}, BandCase{20, 4, 2, true},
                              BandCase{20, 7, 2, true}, BandCase{3, 4, 2, true}}) {
      for (const int column : {0, NumWindows(c) - 1}) {
        ListedRows listed = RandomRows(c, 2, 9, 20240807);
        std::vector<double> row(c.width, 1.0);
        row.back() = bad;
        listed.Add(column, row, {0, 0});
        const BandedQr qr = Factor(listed);
        EXPECT_FALSE(qr.full_rank());
        EXPECT_FALSE(std::isfinite(qr.LargestDiagonal()));
      }
    }
  }
}

}  // namespace
}  // namespace batten
