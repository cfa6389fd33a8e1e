#include "splines/banded_cholesky.h"

#include <Eigen/LU>

#include "tests/splines/row_testing.h"

namespace batten {
namespace {

TEST(BandedCholesky, SolvesWhatTheDenseFactorSolves) {
  for (const BandCase& c : AllBandCases()) {
    SCOPED_TRACE(ToText(c));
    const ListedRows listed = RandomRows(c, 1, 4 * c.width, 20240502);
    const NormalBand band = NormalBand::FromRows(listed);
    BandedCholesky factor;
    ASSERT_TRUE(factor.Factor(band));
    const Points x = RandomPoints(c.num_columns, c.dimension, 9);
    Points solution(c.num_columns, c.dimension);
    band.Multiply(x.data(), solution.data());
    factor.Solve(solution.data(), c.dimension);
    const Eigen::MatrixXd dense = band.ToDense();
    const double norm = dense.cwiseAbs().colwise().sum().maxCoeff();
    const double inverse_norm = dense.inverse().cwiseAbs().colwise().sum().maxCoeff();
    EXPECT_LE((solution - x).cwiseAbs().maxCoeff(), 10 * c.width * kEpsilon * norm * inverse_norm);
    EXPECT_LE(factor.ConditionEstimate(), norm * inverse_norm * (1 + 1e-10));
    EXPECT_GE(factor.ConditionEstimate(), 0.1 * norm * inverse_norm);
  }
}

}  // namespace
}  // namespace batten
