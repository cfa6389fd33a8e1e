#include "splines/smoothing_family.h"

#include <Eigen/Dense>
#include <cmath>

#include "splines/brent_minimum.h"
#include "splines/illinois_root.h"
#include "splines/inverse_band.h"
#include "splines/scaled_rows.h"
#include "tests/splines/row_testing.h"

namespace batten {
namespace {

TEST(InverseBand, TraceIsThatOfTheDenseMatrices) {
  for (const BandCase& c : AllBandCases()) {
    SCOPED_TRACE(ToText(c));
    const ListedRows listed = RandomRows(c, c.width, 4 * c.width, 20250501);
    const ListedRows others = RandomRows(c, 1, 3, 20250502);
    BandedQr qr(listed.shape());
    listed.Stream(&qr);
    qr.Finish();
    ASSERT_TRUE(qr.full_rank());
    const Eigen::MatrixXd a = listed.Matrix();
    const Eigen::MatrixXd inverse = (a.transpose() * a).inverse();
    const NormalBand normal = NormalBand::FromRows(others);
    const Eigen::MatrixXd n = normal.ToDense();
    // The dense inverse is off by its condition; sums of n width products.
    const double tolerance = 64 * c.num_columns * c.width * kEpsilon * (a.transpose() * a).norm() *
                             inverse.norm() * inverse.norm() * n.norm();
    EXPECT_NEAR(TraceOfInverseTimes(qr, normal), (inverse * n).trace(), tolerance);
  }
}

TEST(InverseBand, TraceOfTheRowsOwnNormalMatrixIsTheNumberOfColumns) {
  for (const bool cyclic : {false, true}) {
    const BandCase c = {500, 4, 1, cyclic};
    const ListedRows rows = BsplineRows(c, 3, 20250503);
    BandedQr qr(rows.shape());
    rows.Stream(&qr);
    qr.Finish();
    EXPECT_NEAR(TraceOfInverseTimes(qr, NormalBand::FromRows(rows)), 500.0, 500 * 1e4 * kEpsilon);
  }
}

TEST(SmoothingFamily, HasTheMembersThatDenseAlgebraFinds) {
  for (const bool cyclic : {false, true}) {
    for (const int n : {5, 9, 40}) {
      const BandCase c = {n, 4, 2, cyclic};
      const ListedRows data = BsplineRows(c, 2, 20250504);
      const ListedRows fairing = RandomRows(c, 1, 2, 20250505);
      const SmoothingFamily family(data, fairing);
      EXPECT_EQ(family.num_data(), data.Matrix().rows());
      const Eigen::MatrixXd a = data.Matrix(), d = fairing.Matrix();
      const Eigen::MatrixXd q = data.RightHandSides(), g = fairing.RightHandSides();
      EXPECT_NEAR(family.BalancedWeight(), a.squaredNorm() / d.squaredNorm(), 1e-12);
      for (const double weight : {1e-3, 1.0, 20.0}) {
        const Eigen::MatrixXd normal = a.transpose() * a + weight * d.transpose() * d;
        const Eigen::MatrixXd p =
            normal.ldlt().solve(a.transpose() * q + weight * d.transpose() * g);
        SmoothingFamily::Member member;
        ASSERT_TRUE(family.At(weight, &member));
        const Eigen::JacobiSVD<Eigen::MatrixXd> svd(normal);
        const double condition = svd.singularValues()(0) / svd.singularValues()(n - 1);
        const double tolerance = 64 * n * kEpsilon * condition * (1.0 + p.norm());
        EXPECT_LE((member.control_points - p).norm(), tolerance);
        EXPECT_NEAR(member.residual, (a * p - q).squaredNorm(), tolerance);
        EXPECT_NEAR(member.bend, (d * p - g).squaredNorm(), tolerance * d.norm());
        EXPECT_NEAR(member.trace, normal.ldlt().solve(a.transpose() * a).trace(), n * tolerance);
      }
    }
  }
}

TEST(SmoothingFamily, CountsOthersNeitherAsDataNorAsFairing) {
  for (const bool cyclic : {false, true}) {
    const int n = 12;
    // Of unlike widths: at the end of an open matrix narrow rows are moved among wide ones.
    const ListedRows data = BsplineRows({n, 4, 2, cyclic}, 2, 20250507);
    const ListedRows fairing = RandomRows({n, 3, 2, cyclic}, 1, 2, 20250508);
    const ListedRows others = RandomRows({n, 2, 2, cyclic}, 1, 1, 20250509);
    const SmoothingFamily family(data, fairing, &others);
    EXPECT_EQ(family.num_data(), data.Matrix().rows());
    const Eigen::MatrixXd a = data.Matrix(), b = others.Matrix(), d = fairing.Matrix();
    const double weight = 20.0;
    const Eigen::MatrixXd normal =
        a.transpose() * a + b.transpose() * b + weight * d.transpose() * d;
    const Eigen::LDLT<Eigen::MatrixXd> factor(normal);
    const Eigen::MatrixXd p = factor.solve(a.transpose() * data.RightHandSides() +
                                           b.transpose() * others.RightHandSides() +
                                           weight * d.transpose() * fairing.RightHandSides());
    SmoothingFamily::Member member;
    ASSERT_TRUE(family.At(weight, &member));
    const double tolerance = 1e-9;
    EXPECT_LE((member.control_points - p).norm(), tolerance);
    EXPECT_NEAR(member.residual, (a * p - data.RightHandSides()).squaredNorm(), tolerance);
    EXPECT_NEAR(member.bend, (d * p - fairing.RightHandSides()).squaredNorm(), tolerance);
    EXPECT_NEAR(member.trace, factor.solve(a.transpose() * a).trace(), tolerance);
  }
}

TEST(ScaledRows, AreTheRowsTimesTheirFactors) {
  const ListedRows listed = RandomRows({12, 4, 2, true}, 2, 7, 20250506);
  std::vector<double> factors;
  for (int i = 0; i < listed.shape().num_rows; ++i) factors.push_back(0.5 + i);
  const Eigen::MatrixXd all = AllRows(listed);
  const Eigen::MatrixXd scaled = AllRows(ScaledRows(&listed, factors));
  const Points points = RandomPoints(12, 2, 7);
  const std::vector<double> norms = ResidualNorms(listed, points.data());
  const Eigen::MatrixXd residuals = listed.Matrix() * points - listed.RightHandSides();
  ASSERT_EQ(norms.size(), factors.size());
  for (std::size_t i = 0; i < factors.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    EXPECT_EQ(scaled.row(row), factors[i] * all.row(row));
    EXPECT_NEAR(norms[i], residuals.row(row).norm(), 32 * kEpsilon);
  }
}

TEST(BrentMinimum, FindsAnOffCentreMinimumInFewCalls) {
  int calls = 0;
  const auto f = [&calls](double x) {
    ++calls;
    return std::exp(x) - 2.0 * x;
  };
  const auto [place, value] = BrentMinimum(f, -3.0, 0.0, f(0.0), 5.0, 1e-6, 50);
  EXPECT_NEAR(place, std::log(2.0), 3e-6);
  EXPECT_NEAR(value, 2.0 - 2.0 * std::log(2.0), 1e-11);
  EXPECT_LE(calls, 20);
}

TEST(IllinoisRoot, FindsARootThatPlainSecantsWouldCreepTo) {
  int calls = 0;
  const auto f = [&calls](double x) {
    ++calls;
    return std::pow(x, 9) - 2.0;
  };
  const double root = std::pow(2.0, 1.0 / 9.0);
  EXPECT_NEAR(IllinoisRoot(f, 0.0, -2.0, 3.0, f(3.0), 1e-10, 60), root, 1e-10);
  EXPECT_LE(calls, 40);
  calls = 0;
  IllinoisRoot(f, 0.0, -2.0, 3.0, f(3.0), 1e-10, 5);
  EXPECT_EQ(calls, 6);
}

}  // namespace
}  // namespace batten
