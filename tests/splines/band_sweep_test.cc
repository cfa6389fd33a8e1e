#include "splines/band_sweep.h"

#include <cmath>

#include "splines/banded_rows.h"
#include "tests/splines/row_testing.h"

namespace batten {
namespace {

TEST(BandSweep, RowResidualIsARowOfTheDenseResidual) {
  // Integer rows: equal means equal, in any order of sums.
  for (const BandCase& c : AllBandCases()) {
    SCOPED_TRACE(ToText(c));
    const NormalBand band = NormalBand::FromRows(IntegerRows(c, 0, 4, 20240701));
    const BandSweep sweep(&band);
    const Points p = IntegerPoints(c.num_columns, c.dimension, 11);
    const Points expected = band.right_hand_side() - band.ToDense() * p;
    Points residual = Points::Constant(c.num_columns, c.dimension, std::nan(""));
    for (int j = 0; j < c.num_columns; ++j) sweep.RowResidual(j, p.data(), residual.row(j).data());
    EXPECT_EQ(residual, expected);
  }
}

/// Row j of a sweep from `before`, with `after` what the sweep has made of the rows above it:
/// P_j + w (B - N P)_j / N_jj, by the dense matrix. `rounding` is what the sums are worth.
Eigen::RowVectorXd SweptRow(const NormalBand& band, const Eigen::MatrixXd& dense, double relaxation,
                            int j, const Points& before, const Points& after, double* rounding) {
  const Eigen::Index below = before.rows() - j;
  const auto upper = dense.row(j).head(j);
  const auto lower = dense.row(j).tail(below);
  const Eigen::RowVectorXd residual =
      band.right_hand_side().row(j) - upper * after.topRows(j) - lower * before.bottomRows(below);
  const double size =
      (band.right_hand_side().row(j).cwiseAbs() + upper.cwiseAbs() * after.topRows(j).cwiseAbs() +
       lower.cwiseAbs() * before.bottomRows(below).cwiseAbs())
          .maxCoeff();
  const double factor = dense(j, j) > 0.0 ? relaxation / dense(j, j) : 0.0;
  // Each of 2 width - 1 products and sums rounds once, on both sides; then the step and the sum.
  *rounding = kEpsilon * (4.0 * band.width() * factor * size + 4.0 * before.row(j).norm());
  return before.row(j) + factor * residual;
}

void ExpectSweepOfDenseRows(const NormalBand& band, double relaxation) {
  const Eigen::MatrixXd dense = band.ToDense();
  const Points before = RandomPoints(band.size(), band.dimension(), 12);
  Points after = before;
  BandSweep(&band).Sweep(relaxation, after.data());
  for (int j = 0; j < band.size(); ++j) {
    double rounding = 0.0;
    const Eigen::RowVectorXd expected =
        SweptRow(band, dense, relaxation, j, before, after, &rounding);
    EXPECT_LE((after.row(j) - expected).lpNorm<Eigen::Infinity>(), rounding) << "row " << j;
  }
}

TEST(BandSweep, MovesEachRowByTheNewestValuesOfTheOthers) {
  // Among the cases are cyclic bands that overlap themselves, n < 2 width - 1.
  for (const BandCase& c : AllBandCases()) {
    SCOPED_TRACE(ToText(c));
    for (const double relaxation : {1.0, 0.3, 1.7}) {
      ExpectSweepOfDenseRows(NormalBand::FromRows(RandomRows(c, 1, 4, 20240702)), relaxation);
    }
  }
}

TEST(BandSweep, SolvesWithTheLowerTriangleWhereNothingIsCyclic) {
  // (L + D / w) (P+ - P) = B - N P, D and L diagonal and lower triangle of N.
  const double relaxation = 1.4;
  const ListedRows rows = BsplineRows({30, 4, 2, false}, 3, 20240703);
  const NormalBand band = NormalBand::FromRows(rows);
  const Eigen::MatrixXd n = band.ToDense();
  Eigen::MatrixXd triangle = n.triangularView<Eigen::StrictlyLower>();
  triangle.diagonal() = n.diagonal() / relaxation;
  const Points before = RandomPoints(30, 2, 13);
  const Points moves = triangle.triangularView<Eigen::Lower>().solve(
      Eigen::MatrixXd(band.right_hand_side() - n * before));
  Points after = before;
  BandSweep(&band).Sweep(relaxation, after.data());
  // Numbers are below 10 and a row hands on less than its neighbours' errors together.
  EXPECT_LT((after - before - moves).norm(), 1e-12);
}

TEST(BandSweep, ARowWithoutDataStays) {
  for (const bool cyclic : {false, true}) {
    const BandCase c = {20, 4, 3, cyclic};
    // Windows 5 to 11 have no rows: columns 8 to 11 are in none that has.
    const ListedRows rows =
        BsplineRows(c, 3, 20240704, [](int window) { return window < 5 || window > 11; });
    const NormalBand band = NormalBand::FromRows(rows);
    ASSERT_EQ(band.Diagonal()[9], 0.0);
    const BandSweep sweep(&band);
    EXPECT_EQ(sweep.inverse_diagonal()[9], 0.0);
    const Points before = RandomPoints(20, 3, 14);
    Points after = before;
    sweep.Sweep(1.5, after.data());
    for (int j = 8; j <= 11; ++j) EXPECT_EQ(after.row(j), before.row(j)) << j;
    EXPECT_NE(after.row(7), before.row(7));
    EXPECT_NE(after.row(12), before.row(12));
    ExpectSweepOfDenseRows(band, 1.5);
  }
}

TEST(BandSweep, LeavesTheSolutionWhereItIs) {
  // N and B of integers with N P = B exactly: nothing may move, not even by rounding.
  for (const bool cyclic : {false, true}) {
    ListedRows rows(24, 4, 2, cyclic);
    const Points solution = IntegerPoints(24, 2, 15);
    for (int window = 0; window < (cyclic ? 24 : 21); ++window) {
      std::vector<double> right(2, 0.0);
      const std::vector<double> coefficients = {1.0, 3.0, 2.0, -1.0};
      for (int k = 0; k < 4; ++k) {
        for (int c = 0; c < 2; ++c) right[c] += coefficients[k] * solution((window + k) % 24, c);
      }
      rows.Add(window, coefficients, right);
    }
    const NormalBand band = NormalBand::FromRows(rows);
    Points after = solution;
    BandSweep(&band).Sweep(1.9, after.data());
    EXPECT_EQ(after, solution);
  }
}

}  // namespace
}  // namespace batten
