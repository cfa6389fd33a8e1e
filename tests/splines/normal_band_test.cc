#include "splines/normal_band.h"

#include "splines/banded_rows.h"
#include "tests/splines/row_testing.h"

namespace batten {
namespace {

// Integer rows throughout: equal means equal, in any order of sums.

TEST(NormalBand, IsTheDenseNormalMatrix) {
  for (const BandCase& c : AllBandCases()) {
    SCOPED_TRACE(ToText(c));
    const ListedRows listed = IntegerRows(c, 0, 4, 20240601);
    const NormalBand band = NormalBand::FromRows(BandedRows({&listed}));
    const Eigen::MatrixXd a = listed.Matrix();
    const Eigen::MatrixXd dense = a.transpose() * a;
    EXPECT_EQ(band.ToDense(), dense);
    EXPECT_EQ(band.right_hand_side(), Points(a.transpose() * listed.RightHandSides()));
    EXPECT_EQ(band.squared_norm_of_data(), listed.RightHandSides().squaredNorm());
    for (int j = 0; j < c.num_columns; ++j) {
      EXPECT_EQ(band.Diagonal()[j], dense(j, j));
      EXPECT_EQ(band.AbsoluteRowSums()[j], dense.row(j).cwiseAbs().sum());
    }
    EXPECT_EQ(band.LargestRowSum(), dense.cwiseAbs().rowwise().sum().maxCoeff());
  }
}

TEST(NormalBand, MultipliesLikeTheDenseMatrix) {
  for (const BandCase& c : AllBandCases()) {
    SCOPED_TRACE(ToText(c));
    const NormalBand band = NormalBand::FromRows(IntegerRows(c, 0, 4, 20240602));
    const Points v = IntegerPoints(c.num_columns, c.dimension, 8);
    const Points expected = band.ToDense() * v;
    Points product = Points::Constant(c.num_columns, c.dimension, std::nan(""));
    band.Multiply(v.data(), product.data());
    EXPECT_EQ(product, expected);
    band.NormalResidual(v.data(), product.data());
    EXPECT_EQ(product, Points(band.right_hand_side() - expected));
  }
}

TEST(NormalBand, ResidualIsMinusHalfTheGradientOfTheRows) {
  for (const BandCase& c : {BandCase{20, 4, 2, false}, BandCase{20, 4, 2, true},
                            BandCase{5, 4, 3, true}, BandCase{2, 4, 1, true}}) {
    SCOPED_TRACE(ToText(c));
    const ListedRows listed = IntegerRows(c, 1, 90, 20240603);
    const BandedRows rows({&listed});
    const NormalBand band = NormalBand::FromRows(rows);
    const Points p = IntegerPoints(c.num_columns, c.dimension, 9);
    Points gradient = Points::Zero(c.num_columns, c.dimension);
    const double energy = rows.Evaluate(p.data(), gradient.data());
    Points residual(c.num_columns, c.dimension);
    band.NormalResidual(p.data(), residual.data());
    EXPECT_EQ(gradient, Points(-2.0 * residual));
    // E = ||Q||^2 - tr P'(B + (B - N P)).
    const Points sum = band.right_hand_side() + residual;
    EXPECT_EQ(energy, band.squared_norm_of_data() - p.cwiseProduct(sum).sum());
  }
}

TEST(NormalBand, AddsEntriesThatFallOnOnePlace) {
  // All coefficients of a row stand on the only column: its entry is their sum.
  ListedRows listed(1, 3, 1, true);
  listed.Add(0, {1, 2, 3}, {5});
  const NormalBand band = NormalBand::FromRows(listed);
  EXPECT_EQ(band.band(), (LargeArray{14, 8, 3}));  // 1+4+9, 1*2+2*3, 1*3
  EXPECT_EQ(band.ToDense()(0, 0), 36);
  EXPECT_EQ(band.Diagonal()[0], 36);
  EXPECT_EQ(band.right_hand_side()(0, 0), 30);
  const double v = 2;
  double product = 0;
  band.Multiply(&v, &product);
  EXPECT_EQ(product, 72);
}

TEST(NormalBand, LoopsOfFixedLengthAgreeWithThoseOfAnyLength) {
  for (const int width : {2, 3, 4, 5, 6}) {
    for (const int d : {1, 2, 3}) {
      const ListedRows listed = IntegerRows({14, width, d, true}, 1, 90, 20240604);
      const ListedRows no_rows(14, 7, d, true);  // pads the others to a width without fixed loops
      const NormalBand fixed = NormalBand::FromRows(BandedRows({&listed}));
      const NormalBand any = NormalBand::FromRows(BandedRows({&listed, &no_rows}));
      ASSERT_EQ(any.width(), 7);
      EXPECT_EQ(fixed.ToDense(), any.ToDense());
      EXPECT_EQ(fixed.right_hand_side(), any.right_hand_side());
    }
  }
}

/// Rows in an even number of parts, each over some neighbouring columns.
struct RowsInParts : RowSource {
  RowsInParts(const RowShape& shape_in, int columns_per_part) : whole(shape_in) {
    std::mt19937 random(20240607);
    std::uniform_int_distribution<int> entry(-3, 3);
    const int last = whole.cyclic ? whole.num_columns : whole.num_columns - whole.width + 1;
    for (int begin = 0; begin < last; begin += columns_per_part) {
      parts.emplace_back(whole.num_columns, whole.width, whole.dimension, whole.cyclic);
      for (int column = begin; column < std::min(begin + columns_per_part, last); ++column) {
        for (int i = 0; i < 9; ++i) {
          std::vector<double> coefficients(whole.width);
          std::vector<double> right(whole.dimension);
          for (double& value : coefficients) value = entry(random);
          for (double& value : right) value = entry(random);
          parts.back().Add(column, coefficients, right);
        }
      }
    }
  }
  RowShape shape() const override { return whole; }
  void Stream(RowConsumer* consumer) const override {
    for (const ListedRows& part : parts) part.Stream(consumer);
  }
  int num_parts() const override { return static_cast<int>(parts.size()); }
  void StreamPart(int part, RowConsumer* consumer) const override { parts[part].Stream(consumer); }

  RowShape whole;
  std::vector<ListedRows> parts;
};

TEST(NormalBand, IsTheSameSumByAnyNumberOfThreads) {
  for (const bool cyclic : {false, true}) {
    RowShape shape;
    shape.num_columns = cyclic ? 80 : 83;
    shape.width = 4;
    shape.dimension = 2;
    shape.cyclic = cyclic;
    const RowsInParts rows(shape, 5);
    ASSERT_EQ(rows.num_parts(), 16);
    NormalBand whole(shape);
    rows.Stream(&whole);
    for (const int threads : {1, 2, 3, 8, 50}) {
      const NormalBand band = NormalBand::FromRows(rows, threads);
      EXPECT_EQ(band.band(), whole.band()) << threads << " threads";
      EXPECT_EQ(band.right_hand_side(), whole.right_hand_side());
      EXPECT_EQ(band.squared_norm_of_data(), whole.squared_norm_of_data());
    }
  }
}

TEST(NormalBand, TakesRightHandSidesThatStandApart) {
  struct MovingApart : RowConsumer {
    explicit MovingApart(NormalBand* band_in) : band(band_in) {}
    void Consume(const RowBlock& block) override {
      RowStorage storage(band->dimension() * block.stride);
      std::copy_n(block.right_hand_sides, band->dimension() * block.stride, storage.data());
      RowBlock moved = block;
      moved.right_hand_sides = storage.data();
      band->Consume(moved);
    }
    NormalBand* band;
  };
  const ListedRows listed = IntegerRows({14, 4, 2, false}, 1, 90, 20240605);
  NormalBand band(listed.shape());
  MovingApart moving(&band);
  listed.Stream(&moving);
  EXPECT_EQ(band.band(), NormalBand::FromRows(listed).band());
  EXPECT_EQ(band.right_hand_side(), NormalBand::FromRows(listed).right_hand_side());
}

TEST(NormalBand, MayBeEmptyOrNarrowerThanItsRows) {
  EXPECT_EQ(NormalBand::FromRows(ListedRows(0, 4, 2, false)).ToDense().size(), 0);
  EXPECT_EQ(NormalBand::FromRows(ListedRows(0, 4, 2, true)).Diagonal().size(), 0u);
  for (const int width : {0, 1, 4, 5}) {
    const NormalBand band = NormalBand::FromRows(ListedRows(3, width, 2, false));
    const Points v = Points::Ones(3, 2);
    Points product = v;
    band.Multiply(v.data(), product.data());
    EXPECT_TRUE(product.isZero(0.0)) << width;
    EXPECT_EQ(band.AbsoluteRowSums(), std::vector<double>(3, 0.0)) << width;
    EXPECT_EQ(band.Diagonal(), std::vector<double>(3, 0.0)) << width;
  }
}

}  // namespace
}  // namespace batten
