#ifndef BATTEN_TESTS_SPLINES_ROW_TESTING_H_
#define BATTEN_TESTS_SPLINES_ROW_TESTING_H_

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "splines/basis_functions.h"
#include "splines/row_block.h"
#include "splines/row_pack.h"
#include "tests/roundoff.h"

namespace batten {

/// Rows written down one by one, in any order of Add(): the dense matrix that banded code is
/// compared with, and a RowSource of the same rows.
class ListedRows : public RowSource {
 public:
  ListedRows(int num_columns, int width, int dimension, bool cyclic) {
    shape_.num_columns = num_columns;
    shape_.width = width;
    shape_.dimension = dimension;
    shape_.cyclic = cyclic;
    by_column_.resize(std::max(num_columns, 1));
  }

  void Add(int first_column, const std::vector<double>& coefficients,
           const std::vector<double>& right_hand_sides) {
    by_column_[first_column].push_back({coefficients, right_hand_sides});
    ++shape_.num_rows;
  }
  std::size_t NumRowsAt(int first_column) const { return by_column_[first_column].size(); }
  /// At most this many rows a block.
  void set_rows_per_block(int rows) { rows_per_block_ = rows; }

  RowShape shape() const override { return shape_; }
  void Stream(RowConsumer* consumer) const override {
    for (int column = 0; column < static_cast<int>(by_column_.size()); ++column) {
      const std::vector<Row>& rows = by_column_[column];
      for (std::size_t begin = 0; begin < rows.size(); begin += rows_per_block_) {
        StreamBlock(column, begin, std::min(rows.size(), begin + rows_per_block_), consumer);
      }
    }
  }

  /// In the order of Stream.
  Eigen::MatrixXd Matrix() const {
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(shape_.num_rows, shape_.num_columns);
    Visit([&](int i, int column, const Row& row) {
      for (int j = 0; j < shape_.width; ++j) {
        if (row.coefficients[j] == 0.0) continue;
        matrix(i, (column + j) % shape_.num_columns) += row.coefficients[j];
      }
    });
    return matrix;
  }
  Eigen::MatrixXd RightHandSides() const {
    Eigen::MatrixXd right(shape_.num_rows, shape_.dimension);
    Visit([&](int i, int, const Row& row) {
      for (int c = 0; c < shape_.dimension; ++c) right(i, c) = row.right_hand_sides[c];
    });
    return right;
  }

 private:
  struct Row {
    std::vector<double> coefficients;
    std::vector<double> right_hand_sides;
  };

  template <typename Visitor>
  void Visit(const Visitor& visit) const {
    int i = 0;
    for (std::size_t column = 0; column < by_column_.size(); ++column) {
      for (const Row& row : by_column_[column]) visit(i++, static_cast<int>(column), row);
    }
  }

  void StreamBlock(int column, std::size_t begin, std::size_t end, RowConsumer* consumer) const {
    RowBlock block;
    block.first_column = column;
    block.num_rows = static_cast<int>(end - begin);
    block.stride = PaddedRows(block.num_rows);
    RowStorage storage((shape_.width + shape_.dimension) * block.stride);
    double* const a = storage.data();
    double* const q = a + shape_.width * block.stride;
    for (int i = 0; i < block.num_rows; ++i) {
      const Row& row = by_column_[column][begin + i];
      for (int j = 0; j < shape_.width; ++j) a[j * block.stride + i] = row.coefficients[j];
      for (int c = 0; c < shape_.dimension; ++c) q[c * block.stride + i] = row.right_hand_sides[c];
    }
    block.coefficients = a;
    block.right_hand_sides = q;
    consumer->Consume(block);
  }

  RowShape shape_;
  std::size_t rows_per_block_ = kMaxRowsPerBlock;
  std::vector<std::vector<Row>> by_column_;
};

struct BandCase {
  int num_columns;
  int width;
  int dimension;
  bool cyclic;
};

inline void PrintTo(const BandCase& c, std::ostream* out) {
  *out << "n = " << c.num_columns << ", width " << c.width << ", d = " << c.dimension
       << (c.cyclic ? ", cyclic" : ", open");
}

inline int NumWindows(const BandCase& c) {
  return c.cyclic ? c.num_columns : c.num_columns - c.width + 1;
}

/// `least`..`most` rows on each window, their entries from `entry()`.
template <typename Entry>
ListedRows MakeRows(const BandCase& c, int least, int most, std::mt19937* random,
                    const Entry& entry) {
  std::uniform_int_distribution<int> count(least, most);
  ListedRows rows(c.num_columns, c.width, c.dimension, c.cyclic);
  std::vector<double> coefficients(c.width);
  std::vector<double> right(c.dimension);
  for (int column = 0; column < NumWindows(c); ++column) {
    for (int i = count(*random); i > 0; --i) {
      for (double& value : coefficients) value = entry();
      for (double& value : right) value = entry();
      rows.Add(column, coefficients, right);
    }
  }
  return rows;
}

/// Entries uniform in (-1, 1).
inline ListedRows RandomRows(const BandCase& c, int least, int most, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> entry(-1.0, 1.0);
  return MakeRows(c, least, most, &random, [&] { return entry(random); });
}

/// Integer entries in -3..3: products and sums are exact, in any order.
inline ListedRows IntegerRows(const BandCase& c, int least, int most, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> entry(-3, 3);
  return MakeRows(c, least, most, &random, [&] { return entry(random); });
}

/// Rows of a uniform B-spline's collocation matrix, `rows_per_span` at random places of each span
/// that `keep_span` accepts.
template <typename KeepSpan>
ListedRows BsplineRows(const BandCase& c, int rows_per_span, unsigned seed,
                       const KeepSpan& keep_span) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const int degree = c.width - 1;
  std::vector<double> knots(2 * c.width);
  for (std::size_t k = 0; k < knots.size(); ++k) knots[k] = static_cast<double>(k);
  ListedRows rows(c.num_columns, c.width, c.dimension, c.cyclic);
  std::vector<double> coefficients(c.width);
  std::vector<double> right(c.dimension);
  for (int column = 0; column < NumWindows(c); ++column) {
    if (!keep_span(column)) continue;
    for (int i = 0; i < rows_per_span; ++i) {
      EvaluateBasis(degree, knots.data(), degree, degree + uniform(random), coefficients.data());
      for (double& value : right) value = uniform(random) - 0.5;
      rows.Add(column, coefficients, right);
    }
  }
  return rows;
}

inline ListedRows BsplineRows(const BandCase& c, int rows_per_span, unsigned seed) {
  return BsplineRows(c, rows_per_span, seed, [](int) { return true; });
}

inline Points RandomPoints(int n, int dimension, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> entry(-1.0, 1.0);
  Points points(n, dimension);
  for (Eigen::Index k = 0; k < points.size(); ++k) points.data()[k] = entry(random);
  return points;
}

inline Points IntegerPoints(int n, int dimension, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> entry(-5, 5);
  Points points(n, dimension);
  for (Eigen::Index k = 0; k < points.size(); ++k) points.data()[k] = entry(random);
  return points;
}

/// [A | Q] of any source, in the order of Stream.
inline Eigen::MatrixXd AllRows(const RowSource& source) {
  struct Reader : RowConsumer {
    explicit Reader(const RowShape& s)
        : shape(s), all(Eigen::MatrixXd::Zero(s.num_rows, s.num_columns + s.dimension)) {}
    void Consume(const RowBlock& block) override {
      for (int i = 0; i < block.num_rows; ++i, ++next) {
        for (int j = 0; j < shape.width; ++j) {
          const double a = block.coefficients[j * block.stride + i];
          if (a != 0.0) all(next, (block.first_column + j) % shape.num_columns) += a;
        }
        for (int c = 0; c < shape.dimension; ++c) {
          all(next, shape.num_columns + c) = block.right_hand_sides[c * block.stride + i];
        }
      }
    }
    RowShape shape;
    Eigen::MatrixXd all;
    int next = 0;
  };
  Reader reader(source.shape());
  source.Stream(&reader);
  return reader.all;
}

/// Widths 1..10, dimensions 1..4, open and cyclic, the smallest n, those around where a cyclic
/// band overlaps itself, and larger ones. Widths 2, 3, 4, 6 with d <= 3 have loops of fixed length.
inline std::vector<BandCase> AllBandCases() {
  std::vector<BandCase> cases;
  for (int width = 1; width <= 10; ++width) {
    for (const bool cyclic : {false, true}) {
      for (const int n : {1, 2, 3, width, 2 * width - 2, 2 * width - 1, 2 * width, 33, 60}) {
        if (n < 1 || (!cyclic && n < width)) continue;
        cases.push_back({n, width, 1 + (n + width) % 4, cyclic});
      }
      cases.push_back({25, width, 1, cyclic});
      cases.push_back({25, width, 2, cyclic});
      cases.push_back({25, width, 3, cyclic});
    }
  }
  return cases;
}

inline std::string ToText(const BandCase& c) { return ::testing::PrintToString(c); }

}  // namespace batten

#endif  // BATTEN_TESTS_SPLINES_ROW_TESTING_H_
