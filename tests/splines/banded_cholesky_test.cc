#include "splines/banded_cholesky.h"

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <utility>

#include "tests/splines/row_testing.h"

namespace batten {
namespace {

double OneNorm(const Eigen::MatrixXd& matrix) {
  return matrix.cwiseAbs().colwise().sum().maxCoeff();
}

/// max |factor^-1 b - x| where b = N x.
double ErrorOfSolution(const NormalBand& band, const BandedCholesky& factor, const Points& x) {
  Points solution = band.ToDense() * x;
  factor.Solve(solution.data(), static_cast<int>(x.cols()));
  return (solution - x).cwiseAbs().maxCoeff();
}

/// Symmetric with `diagonal` on and `beside` next to the diagonal.
NormalBand Tridiagonal(int n, int width, bool cyclic, double diagonal, double beside) {
  RowShape shape;
  shape.num_columns = n;
  shape.width = width;
  shape.dimension = 1;
  shape.cyclic = cyclic;
  NormalBand band(shape);
  for (int j = 0; j < n; ++j) {
    band.band()[j * width] = diagonal;
    if (cyclic || j + 1 < n) band.band()[j * width + 1] = beside;
  }
  return band;
}

TEST(BandedCholesky, SolvesToTheConditionOfTheMatrix) {
  for (const BandCase& c : AllBandCases()) {
    SCOPED_TRACE(ToText(c));
    const ListedRows listed = RandomRows(c, c.width, 4 * c.width, 20240701);
    const NormalBand band = NormalBand::FromRows(listed);
    BandedCholesky factor;
    ASSERT_TRUE(factor.Factor(band));
    EXPECT_EQ(factor.size(), c.num_columns);
    const Eigen::MatrixXd dense = band.ToDense();
    const double condition = OneNorm(dense) * OneNorm(dense.inverse());
    // Backward error of some width roundings, |x| <= 1 (Higham 2002, theorem 10.4).
    const double tolerance = 8 * c.width * kEpsilon * condition;
    for (int d = 1; d <= 4; ++d) {
      EXPECT_LE(ErrorOfSolution(band, factor, RandomPoints(c.num_columns, d, 9)), tolerance);
    }
  }
}

TEST(BandedCholesky, ConditionEstimateIsALowerBoundWithinAFactorOfTen) {
  for (const BandCase& c : AllBandCases()) {
    SCOPED_TRACE(ToText(c));
    // B-splines of degree 9 have Gram matrices with condition 1e8 and more.
    if (c.num_columns < c.width) continue;
    const NormalBand band = NormalBand::FromRows(BsplineRows(c, 12, 20240702));
    BandedCholesky factor;
    if (!factor.Factor(band)) continue;
    const Eigen::MatrixXd dense = band.ToDense();
    const double condition = OneNorm(dense) * OneNorm(dense.inverse());
    if (condition > 1e12) continue;  // neither inverse is accurate enough to tell
    EXPECT_LE(factor.ConditionEstimate(), 1.01 * condition);
    EXPECT_GE(factor.ConditionEstimate(), 0.1 * condition);
  }
}

TEST(BandedCholesky, KnowsTheConditionOfSimpleMatrices) {
  BandedCholesky factor;
  ASSERT_TRUE(factor.Factor(Tridiagonal(30, 2, false, 3, 0)));
  EXPECT_DOUBLE_EQ(factor.ConditionEstimate(), 1);
  // (2, -1) open: row sums of the inverse are (j + 1)(n - j) / 2, at most 31 * 31 / 8 for odd n.
  ASSERT_TRUE(factor.Factor(Tridiagonal(29, 2, false, 2, -1)));
  EXPECT_NEAR(factor.ConditionEstimate(), 4 * 15 * 15 / 2.0, 1e-9);
}

TEST(BandedCholesky, SolvesTheDiscretePoissonProblem) {
  // -x_(j-1) + 2 x_j - x_(j+1) = 1 with zeros at both ends: x_j = (j + 1)(n - j) / 2.
  const int n = 50;
  for (const int width : {2, 4, 7}) {
    BandedCholesky factor;
    ASSERT_TRUE(factor.Factor(Tridiagonal(n, width, false, 2, -1)));
    std::vector<double> x(n, 1.0);
    factor.Solve(x.data(), 1);
    for (int j = 0; j < n; ++j) {
      // Entries up to 325, condition n^2 / 2.
      EXPECT_NEAR(x[j], (j + 1) * (n - j) / 2.0, 325 * n * n * kEpsilon);
    }
  }
}

TEST(BandedCholesky, SolvesCyclicSystemsWhereTheBorderDecaysOrNot) {
  // Circulant (2 + shift, -1): x = 1 has the right-hand side `shift`, and a unit right-hand side
  // the geometric solution r^|j| / (r^-1 - r) to the rounding of r^n, r + 1 / r = 2 + shift. With a
  // shift of 1 the fill in the border passes 1e-200 after 480 columns, with 1e-6 not at all.
  const int n = 3000;
  for (const double shift : {1.0, 1e-2, 1e-6}) {
    for (const int width : {2, 4, 7}) {
      SCOPED_TRACE(::testing::Message() << "shift " << shift << ", width " << width);
      BandedCholesky factor;
      ASSERT_TRUE(factor.Factor(Tridiagonal(n, width, true, 2 + shift, -1)));
      const double tolerance = 8 * width * kEpsilon * (4 + shift) / shift;
      std::vector<double> x(n, shift);
      factor.Solve(x.data(), 1);
      for (int j = 0; j < n; ++j) ASSERT_NEAR(x[j], 1.0, tolerance);
      if (shift < 1e-3) continue;
      const double root = 1 + shift / 2 - std::sqrt(shift + shift * shift / 4);
      std::fill(x.begin(), x.end(), 0.0);
      x[n - 2] = 1;
      factor.Solve(x.data(), 1);
      for (int j = 0; j < n; ++j) {
        const int distance = std::min((j + 2) % n, n - (j + 2) % n);
        ASSERT_NEAR(x[j], std::pow(root, distance) / (1 / root - root), tolerance / shift);
      }
    }
  }
}

TEST(BandedCholesky, RefusesWhatIsNotPositiveDefinite) {
  BandedCholesky factor;
  for (const int n : {1, 2, 3, 4, 9, 40}) {
    EXPECT_FALSE(factor.Factor(Tridiagonal(n, 2, true, 2, -1))) << "constants, n = " << n;
    EXPECT_FALSE(factor.Factor(Tridiagonal(n, 2, false, 0, 0))) << n;
    EXPECT_FALSE(factor.Factor(Tridiagonal(n, 4, true, -1, 0))) << n;
    for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
      for (const int width : {4, 7}) {
        EXPECT_FALSE(factor.Factor(Tridiagonal(n, width, true, bad, 0))) << n;
      }
    }
  }
  // A span without data: its middle columns have zero rows.
  const ListedRows gap =
      BsplineRows({30, 4, 2, false}, 9, 20240703, [](int j) { return j < 10 || j > 16; });
  EXPECT_FALSE(factor.Factor(NormalBand::FromRows(gap)));
}

TEST(BandedCholesky, MayBeEmpty) {
  BandedCholesky factor;
  ASSERT_TRUE(factor.Factor(Tridiagonal(0, 4, false, 1, 0)));
  factor.Solve(nullptr, 2);
  EXPECT_EQ(factor.ConditionEstimate(), 1);
  EXPECT_FALSE(factor.Factor(NormalBand::FromRows(ListedRows(3, 0, 1, false))));
}

TEST(BandedCholesky, FactorsInTheMemoryOfTheMatrixToo) {
  for (const bool cyclic : {false, true}) {
    for (const int n : {3, 7, 300}) {
      const NormalBand band = Tridiagonal(n, 4, cyclic, 4, 1);
      NormalBand lost = band;
      BandedCholesky factor;
      BandedCholesky same;
      ASSERT_TRUE(factor.Factor(band));
      ASSERT_TRUE(same.Factor(std::move(lost)));
      const Points right = RandomPoints(n, 2, 11);
      Points x = right;
      Points y = right;
      factor.Solve(x.data(), 2);
      same.Solve(y.data(), 2);
      EXPECT_EQ(x, y);
      EXPECT_EQ(factor.ConditionEstimate(), same.ConditionEstimate());
      EXPECT_LE(ErrorOfSolution(band, same, right), 8 * 4 * kEpsilon * 3);
    }
  }
}

TEST(BandedCholesky, CanBeUsedAgain) {
  BandedCholesky factor;
  ASSERT_TRUE(factor.Factor(Tridiagonal(400, 4, true, 4, 1)));
  ASSERT_FALSE(factor.Factor(Tridiagonal(9, 2, true, 2, -1)));
  ASSERT_TRUE(factor.Factor(Tridiagonal(50, 3, false, 4, 1)));
  const NormalBand band = Tridiagonal(50, 3, false, 4, 1);
  EXPECT_LE(ErrorOfSolution(band, factor, RandomPoints(50, 2, 10)), 8 * 3 * kEpsilon * 3);
}

}  // namespace
}  // namespace batten
