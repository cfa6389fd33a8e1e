#include <Eigen/QR>
#include <cmath>

#include "splines/banded_qr.h"
#include "splines/banded_rows.h"
#include "splines/levelled_rows.h"
#include "splines/nearest_solution.h"
#include "tests/splines/row_testing.h"

namespace batten {
namespace {

/// Second differences, times `weight`, and one light row a column, to a wave with a slope.
struct Whittaker {
  Whittaker(int n, double weight, bool cyclic)
      : heavy(n, 4, 1, cyclic), light(n, 4, 1, cyclic), all(n, 4, 1, cyclic), data(n) {
    for (int j = 0; j < n; ++j) {
      data[j] = std::sin(0.37 * j) + 0.02 * j;
      const int first = cyclic ? j : std::min(j, n - 4);
      std::vector<double> unit(4, 0.0);
      unit[j - first] = 1.0;
      light.Add(first, unit, {data[j]});
      all.Add(first, unit, {data[j]});
    }
    for (int j = 0; j < (cyclic ? n : n - 2); ++j) {
      const bool last = !cyclic && j == n - 3;
      const std::vector<double> row = last ? std::vector<double>{0, weight, -2 * weight, weight}
                                           : std::vector<double>{weight, -2 * weight, weight, 0};
      heavy.Add(last ? j - 1 : j, row, {0.0});
      all.Add(last ? j - 1 : j, row, {0.0});
    }
  }
  /// The straight line nearest to the data; of cyclic ones their mean.
  Eigen::VectorXd Limit(bool cyclic) const {
    Eigen::MatrixXd columns(data.size(), cyclic ? 1 : 2);
    columns.col(0).setOnes();
    if (!cyclic) columns.col(1).setLinSpaced(0.0, static_cast<double>(data.size() - 1));
    return columns * columns.householderQr().solve(data);
  }
  ListedRows heavy;
  ListedRows light;
  ListedRows all;
  Eigen::VectorXd data;
};

double DistanceToLimit(const Whittaker& rows, const RowSource& source, bool cyclic) {
  BandedQr qr(source.shape());
  source.Stream(&qr);
  qr.Finish();
  Points solution;
  qr.Solve(&solution);
  return (solution.col(0) - rows.Limit(cyclic)).cwiseAbs().maxCoeff();
}

TEST(GradedRows, KeepTheDigitsOfLightRowsBesideHeavyOnes) {
  for (const bool cyclic : {false, true}) {
    for (const int n : {20, 60}) {
      const double weight = 1e8;
      const Whittaker rows(n, weight, cyclic);
      // The finite weight leaves the data's difference over weight^2 times the least eigenvalue of
      // the squared differences that is not zero: that of a beam, (4.73 / n)^4 free, (2 pi / n)^4
      // closed.
      const double bias = 2.0 / (weight * weight * std::pow(4.73 / n, 4));
      // Heavy rows are off by some roundings, which the beam's root of that eigenvalue enlarges.
      const double rounding = 16 * kEpsilon * std::pow(n / 4.73, 2);
      EXPECT_LE(DistanceToLimit(rows, BandedRows({&rows.light, &rows.heavy}), cyclic),
                bias + rounding)
          << n << (cyclic ? " cyclic" : " open");
      // In the order of their columns, light rows first, they lose what the weight has.
      EXPECT_GE(DistanceToLimit(rows, BandedRows({&rows.all}), cyclic), 1e3 * (bias + rounding));
    }
  }
}

TEST(GradedRows, OfEqualSizesHaveTheSolutionOfAnyQr) {
  for (const BandCase& c : AllBandCases()) {
    SCOPED_TRACE(ToText(c));
    const ListedRows first = RandomRows(c, c.width, 2 * c.width, 20250401);
    const ListedRows second = RandomRows(c, 1, 3, 20250402);
    const BandedRows rows({&first, &second});
    EXPECT_TRUE(rows.shape().graded);
    BandedQr qr(rows.shape());
    rows.Stream(&qr);
    qr.Finish();
    const Eigen::MatrixXd all = AllRows(rows);
    const Eigen::MatrixXd a = all.leftCols(c.num_columns);
    const Eigen::MatrixXd q = all.rightCols(c.dimension);
    const auto dense = a.colPivHouseholderQr();
    ASSERT_EQ(dense.rank(), c.num_columns);
    const Eigen::MatrixXd expected = dense.solve(q);
    const Eigen::VectorXd r = dense.matrixR().diagonal().cwiseAbs();
    // As in BandedQr.SolvesToTheConditionOfTheRows; the ratio of R is the condition to a few n.
    const double condition = c.num_columns * r.maxCoeff() / r.minCoeff();
    const double roundings = (c.num_columns + 8 * c.width) * kEpsilon;
    const double residual = (a * expected - q).norm();
    const double size = 1 + expected.norm() + condition * residual / a.norm();
    Points solution;
    qr.Solve(&solution);
    EXPECT_LE((solution - expected).norm(), roundings * condition * size);
    EXPECT_NEAR(qr.residual_sum_of_squares(), residual * residual, roundings * q.squaredNorm());
  }
}

TEST(GradedRows, HaveTheRankOfTheirDirectionsWhateverTheirSizes) {
  const int n = 30;
  const Whittaker rows(n, 1e14, false);
  const BandedRows graded({&rows.heavy, &rows.light});
  const NearestSolution full = SolveNearest(graded, Points::Zero(n, 1));
  EXPECT_TRUE(full.unique);
  EXPECT_LT(full.diagonal_ratio, BandedQr::kRankTolerance);
  ListedRows one(n, 4, 1, false);
  one.Add(3, {1, 0, 0, 0}, {2.0});
  const NearestSolution deficient =
      SolveNearest(BandedRows({&rows.heavy, &one}), Points::Zero(n, 1));
  EXPECT_FALSE(deficient.unique) << "one point and no slope";
}

TEST(LevelledRows, HaveNormOne) {
  ListedRows listed(5, 4, 2, false);
  listed.Add(0, {3, 0, 4, 0}, {5, 10});
  listed.Add(1, {0, 0, 0, 0}, {7, 8});
  listed.Add(1, {1e-200, 0, 0, 0}, {0, 0});
  const Eigen::MatrixXd all = AllRows(LevelledRows(&listed));
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(3, 7);
  expected.row(0) << 0.6, 0, 0.8, 0, 0, 1, 2;
  expected.row(1) << 0, 0, 0, 0, 0, 7, 8;
  EXPECT_LE((all.topRows(2) - expected.topRows(2)).norm(), 4 * kEpsilon);
  // Its square underflows: as good as zero.
  EXPECT_EQ(all(2, 1), 1e-200);
}

}  // namespace
}  // namespace batten
