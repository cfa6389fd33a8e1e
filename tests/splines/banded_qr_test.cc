#include "splines/banded_qr.h"

#include <Eigen/QR>

#include "splines/banded_rows.h"
#include "tests/splines/row_testing.h"

namespace batten {
namespace {

BandedQr FactorRows(const RowSource& rows) {
  BandedQr qr(rows.shape());
  rows.Stream(&qr);
  qr.Finish();
  return qr;
}

TEST(BandedQr, SolvesWhatTheDenseFactorSolves) {
  for (const BandCase& c : AllBandCases()) {
    SCOPED_TRACE(ToText(c));
    const ListedRows listed = RandomRows(c, 1, 4 * c.width, 20240502);
    const BandedQr qr = FactorRows(listed);
    ASSERT_TRUE(qr.full_rank());
    const Eigen::MatrixXd a = listed.Matrix();
    const Eigen::MatrixXd q = listed.RightHandSides();
    const Eigen::MatrixXd expected = a.householderQr().solve(q);
    Points solution;
    qr.Solve(&solution);
    EXPECT_LE((solution - expected).cwiseAbs().maxCoeff(), 1e-11);
    EXPECT_NEAR(qr.residual_sum_of_squares(), (a * expected - q).squaredNorm(), 1e-11);
  }
}

TEST(SolveNearest, AgreesWithDense) {
  for (const BandCase& c : AllBandCases()) {
    SCOPED_TRACE(ToText(c));
    const ListedRows listed = RandomRows(c, 0, 2, 20240502);
    const Points start = RandomPoints(c.num_columns, c.dimension, 9);
    const Eigen::MatrixXd a = listed.Matrix();
    const Eigen::MatrixXd q = listed.RightHandSides();
    NearestSolution nearest = SolveNearest(BandedRows({&listed}), start);
    if (listed.shape().num_rows == 0) {
      EXPECT_EQ(nearest.control_points, start);
      continue;
    }
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> cod;
    cod.setThreshold(1e-11);
    cod.compute(a);
    Eigen::MatrixXd e = start + cod.solve(q - a * start);
    EXPECT_LE((nearest.control_points - e).cwiseAbs().maxCoeff(), 1e-7);
    EXPECT_EQ(nearest.rank, cod.rank());
  }
}

}  // namespace
}  // namespace batten
