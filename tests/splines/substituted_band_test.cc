#include "splines/substituted_band.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/splines/row_testing.h"

namespace batten {
namespace {

using SparseRowMajor = SubstitutedBand::SparseRowMajor;

struct SubstitutionCase {
  int num_blocks;
  int block;
  int width_in_blocks;
  bool cyclic;
};

/// Symmetric, with numbers wherever one may be.
NormalBand RandomBand(const SubstitutionCase& c, std::mt19937* random) {
  RowShape shape;
  shape.num_columns = c.num_blocks * c.block;
  shape.width = c.width_in_blocks * c.block;
  shape.dimension = 1;
  shape.cyclic = c.cyclic;
  NormalBand band(shape);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  for (int j = 0; j < shape.num_columns; ++j) {
    for (int k = 0; k < shape.width - j % c.block; ++k) {
      if (j + k < shape.num_columns || c.cyclic) band.band()[j * shape.width + k] = number(*random);
    }
  }
  return band;
}

/// The identity less the columns of `pivots`, whose rows get `tail` numbers behind and before them.
SparseRowMajor LocalMap(int n, const std::vector<int>& pivots, int tail, bool cyclic,
                        std::mt19937* random) {
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  std::vector<int> column(static_cast<std::size_t>(n), 0);
  for (const int pivot : pivots) column[static_cast<std::size_t>(pivot)] = -1;
  int num_columns = 0;
  for (int& c : column) c = c < 0 ? -1 : num_columns++;
  std::vector<Eigen::Triplet<double>> entries;
  for (int j = 0; j < n; ++j) {
    if (column[j] >= 0) {
      entries.emplace_back(j, column[j], 1.0);
      continue;
    }
    for (int k = -tail; k <= tail; ++k) {
      const int other = cyclic ? ((j + k) % n + n) % n : j + k;
      if (other < 0 || other >= n || column[other] < 0) continue;
      entries.emplace_back(j, column[other], number(*random));
    }
  }
  SparseRowMajor z(n, num_columns);
  z.setFromTriplets(entries.begin(), entries.end());
  return z;
}

TEST(SubstitutedBand, IsTheDenseProduct) {
  std::mt19937 random(20240901);
  for (const SubstitutionCase& c : {SubstitutionCase{12, 2, 4, false},
                                    {12, 2, 4, true},
                                    {9, 3, 3, true},
                                    {5, 2, 4, true},  // the band overlaps its corner
                                    {3, 2, 4, true},  // it wraps onto itself
                                    {20, 1, 2, false}}) {
    SCOPED_TRACE(::testing::Message() << c.num_blocks << " blocks of " << c.block << ", "
                                      << (c.cyclic ? "cyclic" : "open"));
    const NormalBand band = RandomBand(c, &random);
    const SparseRowMajor z = LocalMap(band.size(), {0, 3}, 4, c.cyclic, &random);
    RowShape shape;
    shape.num_columns = band.size();
    shape.width = band.width();
    shape.dimension = 1;
    shape.cyclic = c.cyclic;
    SubstitutedBand substituted(shape, c.block, &z);
    const Eigen::MatrixXd dense = Eigen::MatrixXd(z);
    const Eigen::MatrixXd expected = dense.transpose() * band.ToDense() * dense;
    // Sums of at most n^2 products of numbers up to 1, twice: nothing is left of the first.
    const double tolerance = kEpsilon * band.size() * band.size();
    for (int time = 0; time < 2; ++time) {
      substituted.Sum(band);
      EXPECT_LT((substituted.band().ToDense() - expected).cwiseAbs().maxCoeff(), tolerance);
    }
  }
}

TEST(SubstitutedBand, StaysNarrowWhereTheMapIsLocal) {
  std::mt19937 random(20240902);
  RowShape shape;
  shape.num_columns = 400;
  shape.width = 8;
  shape.dimension = 1;
  for (const bool cyclic : {false, true}) {
    shape.cyclic = cyclic;
    const SparseRowMajor z = LocalMap(400, {30, 200, 399}, 7, cyclic, &random);
    const SubstitutedBand substituted(shape, 2, &z);
    EXPECT_EQ(substituted.band().size(), 397);
    EXPECT_EQ(substituted.band().cyclic(), cyclic);
    // A tail reaches 7 to both sides, the entries of N 7 more; no two tails meet.
    EXPECT_LE(substituted.band().width(), 15);
  }
}

TEST(SubstitutedBand, GoesAroundWhereTheMapTiesTheEndToTheBegin) {
  RowShape shape;
  shape.num_columns = 100;
  shape.width = 3;
  shape.dimension = 1;
  std::vector<Eigen::Triplet<double>> entries;
  for (int j = 0; j < 98; ++j) entries.emplace_back(j, j, 1.0);
  entries.emplace_back(98, 0, 1.0);
  entries.emplace_back(99, 1, 1.0);
  SparseRowMajor z(100, 98);
  z.setFromTriplets(entries.begin(), entries.end());
  const SubstitutedBand substituted(shape, 1, &z);
  EXPECT_TRUE(substituted.band().cyclic());
  EXPECT_EQ(substituted.band().width(), 3);
}

}  // namespace
}  // namespace batten
