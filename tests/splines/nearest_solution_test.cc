#include "splines/nearest_solution.h"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <cmath>
#include <limits>

#include "splines/banded_qr.h"
#include "splines/banded_rows.h"
#include "tests/splines/row_testing.h"

namespace batten {
namespace {

constexpr char kMinimumNorm[] = "minimum norm, front by front";

/// By singular values, those below kRankTolerance of the largest left out.
struct DenseSolution {
  DenseSolution(const ListedRows& listed, const Points& start) {
    const Eigen::MatrixXd a = listed.Matrix();
    const Eigen::MatrixXd q = listed.RightHandSides() - a * start;
    points = start;
    if (a.rows() == 0) return;
    Eigen::BDCSVD<Eigen::MatrixXd> svd(a, Eigen::ComputeThinU | Eigen::ComputeThinV);
    svd.setThreshold(BandedQr::kRankTolerance);
    rank = static_cast<int>(svd.rank());
    if (rank == 0) return;
    condition = svd.singularValues()(0) / svd.singularValues()(rank - 1);
    if (rank < svd.singularValues().size()) {
      left_out = svd.singularValues()(rank) / svd.singularValues()(0);
    }
    points += svd.solve(q);
    // Errors in a solution y of a least-squares problem: cond |y| + cond^2 |r| / ||A|| roundings.
    size = points.norm() + condition * (a * (points - start) - q).norm() / a.norm();
  }
  Points points;
  int rank = 0;
  double condition = 1;
  double left_out = 0;  // the largest singular value taken as zero, over the largest
  double size = 1;
};

TEST(SolveNearest, AgreesWithSingularValuesForAnyRank) {
  int num_deficient = 0;
  for (const BandCase& c : AllBandCases()) {
    SCOPED_TRACE(ToText(c));
    const ListedRows listed = RandomRows(c, 0, 2, 20240901);
    const Points start = RandomPoints(c.num_columns, c.dimension, 9);
    const DenseSolution expected(listed, start);
    // Near the rank tolerance ranks may differ.
    if (expected.condition > 1e8 || expected.left_out > 1e-14) continue;
    const NearestSolution nearest = SolveNearest(listed, start);
    EXPECT_EQ(nearest.rank, expected.rank);
    EXPECT_EQ(nearest.unique, expected.rank == c.num_columns);
    EXPECT_EQ(nearest.method, nearest.unique ? "banded QR" : kMinimumNorm);
    num_deficient += nearest.unique ? 0 : 1;
    const double roundings = (c.num_columns + 8 * c.width) * kEpsilon;
    EXPECT_LE((nearest.control_points - expected.points).norm(),
              roundings * expected.condition * expected.size);
  }
  EXPECT_GT(num_deficient, 50);
}

TEST(SolveNearest, LeavesUnseenControlPointsAtTheStart) {
  for (const bool cyclic : {false, true}) {
    const BandCase c = {60, 4, 2, cyclic};
    const ListedRows listed = BsplineRows(c, 9, 20240902, [](int j) { return j < 20 || j > 29; });
    const Points start = RandomPoints(60, 2, 10);
    const NearestSolution nearest = SolveNearest(listed, start);
    // Spans 20..29 would have touched 20..32; the neighbours' data touch 20..22 and 30..32.
    EXPECT_EQ(nearest.rank, 60 - 7);
    EXPECT_EQ(nearest.control_points.middleRows(23, 7), start.middleRows(23, 7));
    EXPECT_NE(nearest.control_points.row(22), start.row(22));
  }
}

TEST(SolveNearest, ReturnsAStartThatIsAMinimiser) {
  const BandCase c = {30, 4, 2, true};
  const Points start = IntegerPoints(30, 2, 11);
  const ListedRows empty_right = IntegerRows(c, 0, 1, 20240903);
  const Eigen::MatrixXd a = empty_right.Matrix();
  const Eigen::MatrixXd q = a * start;
  ListedRows listed(30, 4, 2, true);
  int i = 0;
  for (int column = 0; column < 30; ++column) {
    for (std::size_t k = 0; k < empty_right.NumRowsAt(column); ++k, ++i) {
      listed.Add(
          column,
          {a(i, column), a(i, (column + 1) % 30), a(i, (column + 2) % 30), a(i, (column + 3) % 30)},
          {q(i, 0), q(i, 1)});
    }
  }
  const NearestSolution nearest = SolveNearest(listed, start);
  EXPECT_FALSE(nearest.unique);
  EXPECT_EQ(nearest.control_points, start) << "integer rows: their residual is exactly zero";
}

TEST(SolveNearest, TakesMatricesWithoutRowsOrWithZeros) {
  for (const bool cyclic : {false, true}) {
    for (const int n : {0, 1, 4, 600}) {
      ListedRows listed(n, 4, 2, cyclic);
      const Points start = RandomPoints(n, 2, 12);
      NearestSolution nearest = SolveNearest(listed, start);
      EXPECT_EQ(nearest.control_points, start);
      EXPECT_EQ(nearest.unique, n == 0);
      if (n == 0 || (!cyclic && n < 4)) continue;
      listed.Add(0, {0, 0, 0, 0}, {1, 2});
      nearest = SolveNearest(listed, start);
      EXPECT_EQ(nearest.control_points, start);
      EXPECT_FALSE(nearest.unique);
      EXPECT_EQ(nearest.diagonal_ratio, 0);
    }
  }
}

TEST(SolveNearest, MovesManyPairsAlongTheirRows) {
  // Pairs of columns with one row (1, 2) p = s each: nearest to the start a is
  // a + (1, 2) (s - (1, 2) a) / 5.
  const int n = 2000;
  for (const bool cyclic : {false, true}) {
    ListedRows listed(n, 4, 2, cyclic);
    const Points start = RandomPoints(n, 2, 13);
    Points expected = start;
    for (int j = 0; j < n; j += 2) {
      const int first = cyclic ? j : std::min(j, n - 4);
      std::vector<double> row(4, 0.0);
      row[j - first] = 1;
      row[j - first + 1] = 2;
      listed.Add(first, row, {1.0 + j % 7, 2.0});
      const Eigen::RowVector2d step =
          (Eigen::RowVector2d(1.0 + j % 7, 2.0) - start.row(j) - 2 * start.row(j + 1)) / 5;
      expected.row(j) += step;
      expected.row(j + 1) += 2 * step;
    }
    const NearestSolution nearest = SolveNearest(listed, start);
    EXPECT_EQ(nearest.method, kMinimumNorm);
    EXPECT_EQ(nearest.rank, n / 2);
    EXPECT_FALSE(nearest.unique);
    // Numbers up to 7, each with a handful of roundings: the pairs have condition 1.
    EXPECT_LE((nearest.control_points - expected).cwiseAbs().maxCoeff(), 100 * kEpsilon);
  }
}

TEST(SolveNearest, AgreesWithADenseFactorOverManySpansWithoutData) {
  for (const bool cyclic : {false, true}) {
    const BandCase c = {510, 4, 2, cyclic};
    const ListedRows listed =
        BsplineRows(c, 3, 20240904, [](int j) { return j % 50 < 40 || j % 50 > 46; });
    const Points start = RandomPoints(510, 2, 14);
    const NearestSolution nearest = SolveNearest(listed, start);
    EXPECT_EQ(nearest.method, kMinimumNorm);
    const DenseSolution expected(listed, start);
    EXPECT_EQ(nearest.rank, expected.rank);
    EXPECT_LE((nearest.control_points - expected.points).norm(),
              c.num_columns * kEpsilon * expected.condition * expected.size);
  }
}

TEST(SolveNearest, TakesPivotsDownToItsToleranceAsTheyAre) {
  // Column 1 leaves column 0 by `part`; whether it depends on it is a matter of the tolerance.
  for (const bool cyclic : {false, true}) {
    for (const double part : {1e-9, 1e-13}) {
      ListedRows listed(40, 4, 1, cyclic);
      for (int j = 2; j < 37; ++j) listed.Add(j, {1, 0, 0, 0}, {1});
      if (!cyclic) listed.Add(36, {0, 0, 1, 1}, {2});
      listed.Add(0, {1, 1, 0, 0}, {2});
      listed.Add(0, {0, part, 0, 0}, {3 * part});
      const NearestSolution nearest = SolveNearest(listed, Points::Zero(40, 1));
      const bool depends = part < BandedQr::kRankTolerance;
      EXPECT_NEAR(nearest.control_points(0, 0), depends ? 1 : -1, depends ? 1e-12 : 1e-5);
      EXPECT_NEAR(nearest.control_points(1, 0), depends ? 1 : 3, depends ? 1e-12 : 1e-5);
    }
  }
}

TEST(SolveNearest, ReturnsTheStartIfNumbersAreNotFinite) {
  for (const int n : {10, 600}) {
    for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
      const BandCase c = {n, 4, 2, true};
      const Points start = RandomPoints(n, 2, 15);
      for (const bool in_matrix : {false, true}) {
        for (const bool full : {false, true}) {
          ListedRows listed = RandomRows(c, full ? 4 : 0, full ? 4 : 1, 20240905);
          listed.Add(3, {1, in_matrix ? bad : 1, 1, 1}, {in_matrix ? 1 : bad, 1});
          const NearestSolution nearest = SolveNearest(BandedRows({&listed}), start);
          EXPECT_EQ(nearest.control_points, start);
          EXPECT_EQ(nearest.method.substr(0, 4), "none");
          EXPECT_FALSE(nearest.unique);
        }
      }
      Points bad_start = start;
      bad_start(2, 1) = bad;
      const NearestSolution nearest = SolveNearest(RandomRows(c, 0, 1, 20240906), bad_start);
      EXPECT_EQ(nearest.method.substr(0, 4), "none");
    }
  }
}

}  // namespace
}  // namespace batten
