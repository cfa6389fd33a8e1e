#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "splines/banded_qr.h"
#include "splines/banded_rows.h"
#include "splines/row_pack.h"

namespace batten {
namespace {

/// Up to here a rank-deficient triangle is decomposed densely: n^3 operations, a fraction of a
/// second.
constexpr int kMaxDenseColumns = 500;

/// Rows A (P - start) = Q - A start.
class ShiftedRows : public RowSource {
 public:
  ShiftedRows(const RowSource& rows, const Points& start) : rows_(rows), start_(start) {}
  RowShape shape() const override { return rows_.shape(); }
  void Stream(RowConsumer* consumer) const override {
    Shifter shifter(rows_.shape(), start_, consumer);
    rows_.Stream(&shifter);
  }

 private:
  class Shifter : public RowConsumer {
   public:
    Shifter(const RowShape& shape, const Points& start, RowConsumer* consumer)
        : shape_(shape),
          start_(start),
          consumer_(consumer),
          right_(static_cast<std::size_t>(shape.dimension) * kMaxRowsPerBlock) {}
    void Consume(const RowBlock& block) override;

   private:
    RowShape shape_;
    const Points& start_;
    RowConsumer* consumer_;
    RowStorage right_;
  };

  const RowSource& rows_;
  const Points& start_;
};

void ShiftedRows::Shifter::Consume(const RowBlock& block) {
  const int stride = block.stride;
  double* const right = right_.data();
  std::copy_n(block.right_hand_sides, shape_.dimension * stride, right);
  for (int j = 0; j < shape_.width; ++j) {
    const int column = (block.first_column + j) % shape_.num_columns;
    for (int c = 0; c < shape_.dimension; ++c) {
      for (int i = 0; i < stride; ++i) {
        right[c * stride + i] -= block.coefficients[j * stride + i] * start_(column, c);
      }
    }
  }
  RowBlock shifted = block;
  shifted.right_hand_sides = right;
  consumer_->Consume(shifted);
}

BandedQr Factor(const RowSource& rows) {
  BandedQr qr(rows.shape());
  rows.Stream(&qr);
  qr.Finish();
  return qr;
}

void SolveDense(const BandedQr& qr, int n, NearestSolution* result) {
  Eigen::MatrixXd triangle(n, n);
  Points unit = Points::Identity(n, n);
  qr.MultiplyTriangle(n, unit.data());
  triangle = unit;
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
  decomposition.setThreshold(BandedQr::kRankTolerance);
  decomposition.compute(triangle);
  result->control_points += decomposition.solve(Eigen::MatrixXd(qr.TriangleRightHandSide()));
  result->rank = static_cast<int>(decomposition.rank());
  result->method = "complete orthogonal decomposition";
}

/// Conjugate gradients on the normal equations (CGLS, Hestenes & Stiefel 1952) from the start:
/// moves are sums of rows of A, so the minimiser reached is the one nearest to the start. Ends when
/// A'r is as small as its rounding, or after 10 n steps, which is then said.
void SolveIteratively(const RowSource& source, NearestSolution* result) {
  const BandedRows rows({&source});
  Points& p = result->control_points;
  const auto make_residuals = [&rows, &p](const Points& at) {
    Points residuals(rows.shape().num_rows, p.cols());
    rows.Residuals(at.data(), residuals.data());
    return residuals;
  };
  const auto transposed = [&rows, &p](const Points& r) {
    Points product = Points::Zero(p.rows(), p.cols());
    rows.AddTransposedProduct(r.data(), product.data());
    return product;
  };
  const Points data = make_residuals(Points::Zero(p.rows(), p.cols()));
  Points bound = Points::Zero(p.rows(), p.cols());
  rows.AddRoundingBound(p.data(), bound.data());
  const double floor = std::numeric_limits<double>::epsilon() * bound.norm();
  Points residuals = make_residuals(p);
  Points direction = transposed(residuals);
  double squared = direction.squaredNorm();
  const int max_steps = 10 * static_cast<int>(p.rows());
  int step = 0;
  while (squared > floor * floor && step < max_steps) {
    ++step;
    const Points product = data - make_residuals(direction);
    const double length = squared / product.squaredNorm();
    if (!std::isfinite(length)) break;
    p += length * direction;
    residuals -= length * product;
    const Points next = transposed(residuals);
    const double next_squared = next.squaredNorm();
    direction = next + (next_squared / squared) * direction;
    squared = next_squared;
  }
  // Without a number there is no minimiser: the caller says so.
  if (!std::isfinite(squared)) p.setConstant(std::numeric_limits<double>::quiet_NaN());
  result->method = "CGLS, " + std::to_string(step) + " steps";
  if (squared > floor * floor) result->method += ", not settled";
}

}  // namespace

NearestSolution SolveNearest(const RowSource& rows, const Points& start) {
  const int n = rows.shape().num_columns;
  NearestSolution result;
  result.control_points = start;
  const BandedQr qr = Factor(rows);
  result.diagonal_ratio = qr.DiagonalRatio();
  if (qr.full_rank()) {
    qr.Solve(&result.control_points);
    result.rank = n;
    result.method = "banded QR";
  } else if (!std::isfinite(qr.LargestDiagonal()) || !start.allFinite()) {
    result.diagonal_ratio = 0.0;
  } else {
    if (n <= kMaxDenseColumns) {
      SolveDense(Factor(ShiftedRows(rows, start)), n, &result);
    } else {
      SolveIteratively(rows, &result);
      result.rank = -1;
    }
  }
  result.unique = result.rank == n;
  if (result.method.empty() || !result.control_points.allFinite()) {
    result.control_points = start;
    result.rank = -1;
    result.unique = false;
    result.method = "none, numbers are not finite";
  }
  return result;
}

}  // namespace batten
