#include "splines/least_norm_fronts.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <utility>

namespace batten {
namespace {

using Eigen::MatrixXd;

/// Rows of one kind of all parts, columns in the order of `columns`.
MatrixXd Gather(const std::vector<const Front*>& parts, MatrixXd Front::*rows,
                const std::vector<int>& columns, int dimension) {
  Eigen::Index num_rows = 0;
  for (const Front* part : parts) num_rows += (part->*rows).rows();
  const auto num_columns = static_cast<Eigen::Index>(columns.size());
  MatrixXd all = MatrixXd::Zero(num_rows, num_columns + dimension);
  Eigen::Index row = 0;
  for (const Front* part : parts) {
    const MatrixXd& source = part->*rows;
    for (std::size_t k = 0; k < part->columns.size(); ++k) {
      const auto place = std::find(columns.begin(), columns.end(), part->columns[k]);
      // An unknown may stand twice in a part that wraps around.
      all.block(row, place - columns.begin(), source.rows(), 1) +=
          source.col(static_cast<Eigen::Index>(k));
    }
    all.block(row, num_columns, source.rows(), dimension) = source.rightCols(dimension);
    row += source.rows();
  }
  return all;
}

/// No more rows than coefficients: a triangle of the same sums of squares, up to a constant.
MatrixXd Compressed(const MatrixXd& rows, Eigen::Index num_coefficients) {
  if (rows.rows() <= num_coefficients) return rows;
  if (num_coefficients == 0) return MatrixXd(0, rows.cols());
  const Eigen::HouseholderQR<MatrixXd> qr(rows.leftCols(num_coefficients));
  MatrixXd turned = rows.rightCols(rows.cols() - num_coefficients);
  turned.applyOnTheLeft(qr.householderQ().transpose());
  MatrixXd result(num_coefficients, rows.cols());
  result << MatrixXd(qr.matrixQR().topRows(num_coefficients).triangularView<Eigen::Upper>()),
      turned.topRows(num_coefficients);
  return result;
}

}  // namespace

/// The part of `first` that pivoted QR of its interior columns splits it into.
class LeastNormFronts::Split {
 public:
  Split(const MatrixXd& first, Eigen::Index num_interior, Eigen::Index num_boundary,
        double threshold)
      : order_(num_interior), rows_(first) {
    order_.setIdentity();
    if (first.rows() == 0 || num_interior == 0) return;
    const Eigen::ColPivHouseholderQR<MatrixXd> qr(first.leftCols(num_interior));
    order_ = qr.colsPermutation();
    MatrixXd others = first.rightCols(first.cols() - num_interior);
    others.applyOnTheLeft(qr.householderQ().transpose());
    rows_ << MatrixXd(qr.matrixR().triangularView<Eigen::Upper>()), others;
    const Eigen::Index most = std::min(first.rows(), num_interior);
    while (rank_ < most) {
      const double pivot = std::abs(rows_(rank_, rank_));
      if (!(pivot > threshold)) return;
      if (num_boundary > 0) {
        // Dividing by less would carry rounding of this size over to the boundary's columns.
        constexpr double kSmallestPivot = 1e-3;
        const double boundary = others.bottomLeftCorner(others.rows() - rank_, num_boundary)
                                    .colwise()
                                    .norm()
                                    .maxCoeff();
        if (pivot < kSmallestPivot * boundary) {
          delays_ = true;
          return;
        }
      }
      ++rank_;
    }
  }
  Eigen::Index rank() const { return rank_; }
  /// Interior unknowns beyond the first rank() are better eliminated later, with others.
  bool delays() const { return delays_; }
  const Eigen::PermutationMatrix<Eigen::Dynamic>& order() const { return order_; }
  const MatrixXd& rows() const { return rows_; }

 private:
  Eigen::PermutationMatrix<Eigen::Dynamic> order_;
  MatrixXd rows_;  // interior columns in their new order
  Eigen::Index rank_ = 0;
  bool delays_ = false;
};

/// The parts of one elimination as one problem, interior unknowns first.
struct LeastNormFronts::Merged {
  Merged(const std::vector<const Front*>& parts, const std::vector<int>& kept, int dimension) {
    const auto is_new = [](const std::vector<int>& known, int column) {
      return std::find(known.begin(), known.end(), column) == known.end();
    };
    for (const Front* part : parts) {
      for (const int column : part->columns) {
        if (is_new(kept, column) && is_new(columns, column)) columns.push_back(column);
      }
    }
    num_interior = static_cast<Eigen::Index>(columns.size());
    for (const int column : kept) {
      if (is_new(columns, column)) columns.push_back(column);
    }
    first = Gather(parts, &Front::first, columns, dimension);
    second = Gather(parts, &Front::second, columns, dimension);
  }
  Eigen::Index num_boundary() const {
    return static_cast<Eigen::Index>(columns.size()) - num_interior;
  }
  /// Puts interior unknowns into the order of the split; those it delays become boundary ones.
  void Follow(const Split& split) {
    const MatrixXd turned = second.leftCols(num_interior) * split.order();
    second.leftCols(num_interior) = turned;
    const std::vector<int> unordered = columns;
    for (Eigen::Index k = 0; k < num_interior; ++k) {
      columns[static_cast<std::size_t>(k)] =
          unordered[static_cast<std::size_t>(split.order().indices()[k])];
    }
    if (split.delays()) num_interior = split.rank();
  }

  std::vector<int> columns;
  Eigen::Index num_interior = 0;
  MatrixXd first;
  MatrixXd second;
};

// Notation: i interior and c boundary unknowns. first is, once split, [R11 R12] i + X c = q (rank
// rows) and rows without i. With QR of the transposed triangle, [R11 R12] = [L 0] V', V = [V1 V2],
// i = V1 L^-1 (q - X c) + V2 f with f free. second determines f.
Front LeastNormFronts::Eliminate(const std::vector<const Front*>& parts,
                                 const std::vector<int>& kept) {
  Merged merged(parts, kept, dimension_);
  const Split split(merged.first, merged.num_interior, merged.num_boundary(), threshold_);
  merged.Follow(split);
  const Eigen::Index num_interior = merged.num_interior;
  const Eigen::Index num_boundary = merged.num_boundary();
  const Eigen::Index num_known = num_boundary + dimension_;  // what i is expressed by
  const Eigen::Index rank = split.rank();
  rank_ += static_cast<int>(rank);

  MatrixXd v = MatrixXd::Identity(num_interior, num_interior);
  MatrixXd determined = split.rows().topRightCorner(rank, num_known);  // V1'i, by (c, 1)
  determined.leftCols(num_boundary) *= -1.0;
  if (rank > 0) {
    const MatrixXd upper = split.rows().topLeftCorner(rank, num_interior);
    const Eigen::HouseholderQR<MatrixXd> transposed(upper.transpose());
    v = transposed.householderQ();
    const auto l = transposed.matrixQR().topRows(rank).triangularView<Eigen::Upper>().transpose();
    l.solveInPlace(determined);
  }
  Record record;
  record.solution = v.leftCols(rank) * determined;
  MatrixXd rest = SettleFree(merged.second, v.rightCols(num_interior - rank), &record.solution);
  const auto boundary = merged.columns.begin() + num_interior;
  record.interior.assign(merged.columns.begin(), boundary);
  record.boundary.assign(boundary, merged.columns.end());
  Front front;
  front.columns = record.boundary;
  const Eigen::Index num_left = split.rows().rows() - rank;
  front.first = Compressed(split.rows().bottomRightCorner(num_left, num_known), num_boundary);
  front.second = Compressed(rest, num_boundary);
  records_.push_back(std::move(record));
  return front;
}

MatrixXd LeastNormFronts::SettleFree(const MatrixXd& second, const MatrixXd& v2,
                                     MatrixXd* solution) const {
  const Eigen::Index num_interior = v2.rows();
  const Eigen::Index num_free = v2.cols();
  const Eigen::Index num_boundary = solution->cols() - dimension_;
  const MatrixXd through = second.leftCols(num_interior) * *solution;
  MatrixXd rest(second.rows(), num_free + solution->cols());  // of f, of c, right-hand sides
  rest << second.leftCols(num_interior) * v2,
      second.middleCols(num_interior, num_boundary) + through.leftCols(num_boundary),
      second.rightCols(dimension_) - through.rightCols(dimension_);
  if (num_free > 0) {
    const Eigen::HouseholderQR<MatrixXd> qr(rest.leftCols(num_free));
    rest.applyOnTheLeft(qr.householderQ().transpose());
    MatrixXd free = rest.topRightCorner(num_free, solution->cols());
    free.leftCols(num_boundary) *= -1.0;
    qr.matrixQR().topRows(num_free).triangularView<Eigen::Upper>().solveInPlace(free);
    *solution += v2 * free;
  }
  return rest.bottomRightCorner(rest.rows() - num_free, solution->cols());
}

Points LeastNormFronts::Solve(int num_columns) const {
  Points x = Points::Zero(num_columns, dimension_);
  for (auto record = records_.rbegin(); record != records_.rend(); ++record) {
    const auto num_boundary = static_cast<Eigen::Index>(record->boundary.size());
    MatrixXd interior = record->solution.rightCols(dimension_);
    for (Eigen::Index k = 0; k < num_boundary; ++k) {
      interior += record->solution.col(k) * x.row(record->boundary[static_cast<std::size_t>(k)]);
    }
    for (std::size_t k = 0; k < record->interior.size(); ++k) {
      x.row(record->interior[k]) = interior.row(static_cast<Eigen::Index>(k));
    }
  }
  return x;
}

}  // namespace batten
