#include "splines/banded_rows.h"

#include "tests/splines/row_testing.h"

namespace batten {
namespace {

// A sum of 60 rows x 10 products of numbers <= 1, twice over, in any order.
constexpr double kTolerance = 2 * 60 * 10 * kEpsilon;

TEST(BandedRows, EvaluatesTheDenseSumOfSquaresAndItsGradient) {
  for (const BandCase& c : AllBandCases()) {
    SCOPED_TRACE(ToText(c));
    const ListedRows listed = RandomRows(c, 0, 4, 20240501);
    const BandedRows rows({&listed});
    const Points p = RandomPoints(c.num_columns, c.dimension, 7);
    const Eigen::MatrixXd a = listed.Matrix();
    const Eigen::MatrixXd residual = a * p - listed.RightHandSides();
    const Points expected = 2.0 * a.transpose() * residual;
    const double size = 1.0 + residual.squaredNorm();
    EXPECT_NEAR(rows.Evaluate(p.data(), nullptr), residual.squaredNorm(), kTolerance * size);
    Points gradient = Points::Constant(c.num_columns, c.dimension, 3.0);
    EXPECT_NEAR(rows.Evaluate(p.data(), gradient.data()), residual.squaredNorm(),
                kTolerance * size);
    gradient.array() -= 3.0;
    EXPECT_LE((gradient - expected).cwiseAbs().maxCoeff(), 100 * kTolerance);
    EXPECT_NEAR(rows.SquaredNormOfProduct(p.data()), (a * p).squaredNorm(), kTolerance * size * 10);
  }
}

}  // namespace
}  // namespace batten
