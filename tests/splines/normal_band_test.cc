#include "splines/normal_band.h"

#include "splines/banded_rows.h"
#include "tests/splines/row_testing.h"

namespace batten {
namespace {

constexpr double kTolerance = 2 * 60 * 10 * kEpsilon;

TEST(NormalBand, IsTheDenseNormalMatrix) {
  for (const BandCase& c : AllBandCases()) {
    SCOPED_TRACE(ToText(c));
    const ListedRows listed = RandomRows(c, 0, 4, 20240502);
    const NormalBand band = NormalBand::FromRows(BandedRows({&listed}));
    const Eigen::MatrixXd a = listed.Matrix();
    const Eigen::MatrixXd dense = a.transpose() * a;
    const Eigen::MatrixXd right = a.transpose() * listed.RightHandSides();
    EXPECT_LE((band.ToDense() - dense).cwiseAbs().maxCoeff(), kTolerance);
    EXPECT_LE((band.right_hand_side() - right).cwiseAbs().maxCoeff(), kTolerance);
    EXPECT_NEAR(band.squared_norm_of_data(), listed.RightHandSides().squaredNorm(), kTolerance);
    const Points v = RandomPoints(c.num_columns, c.dimension, 8);
    Points product(c.num_columns, c.dimension);
    band.Multiply(v.data(), product.data());
    EXPECT_LE((product - dense * v).cwiseAbs().maxCoeff(), kTolerance * 10);
    for (int j = 0; j < c.num_columns; ++j) {
      EXPECT_NEAR(band.Diagonal()[j], dense(j, j), kTolerance);
      EXPECT_NEAR(band.AbsoluteRowSums()[j], dense.row(j).cwiseAbs().sum(), kTolerance * 10);
    }
  }
}

}  // namespace
}  // namespace batten
