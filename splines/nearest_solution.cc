#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "splines/banded_qr.h"
#include "splines/row_pack.h"

namespace batten {
namespace {

/// Up to here a rank-deficient triangle is decomposed densely: n^3 operations, a fraction of a
/// second.
constexpr int kMaxDenseColumns = 500;

/// Rows A (P - start) = Q - A start, and, with damping > 0, damping (P - start) = 0, one row per
/// column, in the band.
class ShiftedRows : public RowSource {
 public:
  ShiftedRows(const RowSource& rows, const Points& start, double damping)
      : rows_(rows), start_(start), damping_(damping) {}
  RowShape shape() const override { return rows_.shape(); }
  void Stream(RowConsumer* consumer) const override {
    Shifter shifter(rows_.shape(), start_, damping_, consumer);
    rows_.Stream(&shifter);
    shifter.AddDampingBefore(rows_.shape().num_columns);
  }

 private:
  class Shifter : public RowConsumer {
   public:
    Shifter(const RowShape& shape, const Points& start, double damping, RowConsumer* consumer)
        : shape_(shape),
          start_(start),
          damping_(damping),
          consumer_(consumer),
          right_(static_cast<std::size_t>(shape.dimension) * kMaxRowsPerBlock),
          damping_row_(static_cast<std::size_t>(shape.width + shape.dimension) * kRowPack) {}
    void Consume(const RowBlock& block) override;
    /// Damping rows of all columns that rows of the window at `first_column` may follow.
    void AddDampingBefore(int first_column);

   private:
    RowShape shape_;
    const Points& start_;
    double damping_;
    RowConsumer* consumer_;
    int next_damped_ = 0;
    RowStorage right_;
    RowStorage damping_row_;
  };

  const RowSource& rows_;
  const Points& start_;
  double damping_;
};

void ShiftedRows::Shifter::Consume(const RowBlock& block) {
  AddDampingBefore(block.first_column);
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

void ShiftedRows::Shifter::AddDampingBefore(int first_column) {
  if (damping_ == 0.0) return;
  double* const row = damping_row_.data();
  for (; next_damped_ < first_column; ++next_damped_) {
    // Open matrices have no window that starts in the last columns.
    const int last_window =
        shape_.cyclic ? next_damped_ : std::max(shape_.num_columns - shape_.width, 0);
    RowBlock block;
    block.first_column = std::min(next_damped_, last_window);
    block.num_rows = 1;
    block.stride = kRowPack;
    block.coefficients = row;
    block.right_hand_sides = row + shape_.width * kRowPack;
    double* const entry = row + (next_damped_ - block.first_column) * kRowPack;
    *entry = damping_;
    consumer_->Consume(block);
    *entry = 0.0;
  }
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

/// min ||R x - right|| for one coordinate by LSQR (Paige & Saunders 1982) in y = R_d x, R_d the
/// triangle of the damped rows. R_d'R_d = R'R + damping^2 I is a function of R'R, so x stays in the
/// row space of A, where the solution of least norm is; singular values of R R_d^-1 lie near 0 or
/// 1 but for those of A about as small as the damping, so that few steps suffice. Returns the
/// number of steps; -1 if the limit came first.
int SolveByLsqr(const BandedQr& qr, const BandedQr& damped, const Eigen::VectorXd& right,
                int max_steps, Eigen::VectorXd* x) {
  constexpr double kTolerance = 1e-16;  // of the normal residual against ||right||
  const Eigen::Index n = right.size();
  Eigen::VectorXd u = right;
  double beta = u.norm();
  *x = Eigen::VectorXd::Zero(n);
  if (beta == 0.0) return 0;
  u /= beta;
  Eigen::VectorXd v = u;
  qr.MultiplyTransposedTriangle(1, v.data());
  damped.SolveTransposedTriangle(1, v.data());
  double alpha = v.norm();
  const double stop = kTolerance * beta;
  if (alpha * beta <= stop) return 0;
  v /= alpha;
  Eigen::VectorXd w = v;
  Eigen::VectorXd y = Eigen::VectorXd::Zero(n);
  Eigen::VectorXd product(n);
  double phi_bar = beta;
  double rho_bar = alpha;
  int step = 0;
  bool settled = false;
  while (!settled && step < max_steps) {
    ++step;
    product = v;
    damped.SolveTriangle(1, product.data());
    qr.MultiplyTriangle(1, product.data());
    u = product - alpha * u;
    beta = u.norm();
    if (beta > 0.0) u /= beta;
    product = u;
    qr.MultiplyTransposedTriangle(1, product.data());
    damped.SolveTransposedTriangle(1, product.data());
    v = product - beta * v;
    alpha = v.norm();
    if (alpha > 0.0) v /= alpha;
    const double rho = std::hypot(rho_bar, beta);
    const double c = rho_bar / rho;
    const double s = beta / rho;
    y += (c * phi_bar / rho) * w;
    w = v - (s * alpha / rho) * w;
    rho_bar = -c * alpha;
    phi_bar *= s;
    settled = !(phi_bar * alpha * std::abs(c) > stop);
  }
  *x = y;
  damped.SolveTriangle(1, x->data());
  return settled ? step : -1;
}

/// y = R'R (R_d'R_d)^-1 y: nothing of it is outside the row space of A, where LSQR leaves errors of
/// eps / damping^2; inside, parts with singular value s lose damping^2 / (s^2 + damping^2).
void ProjectOnRowSpace(const BandedQr& qr, const BandedQr& damped, Eigen::VectorXd* y) {
  damped.SolveTransposedTriangle(1, y->data());
  damped.SolveTriangle(1, y->data());
  qr.MultiplyTriangle(1, y->data());
  qr.MultiplyTransposedTriangle(1, y->data());
}

void SolveIteratively(const RowSource& rows, const BandedQr& qr, const Points& start,
                      NearestSolution* result) {
  constexpr double kDamping = 1e-5;  // of the largest singular value, about
  constexpr int kRounds = 3;
  const BandedQr damped =
      Factor(ShiftedRows(rows, start, std::max(kDamping * qr.LargestDiagonal(), 1e-140)));
  const Points right = qr.TriangleRightHandSide();
  const int max_steps = 10 * static_cast<int>(start.rows());
  int num_steps = 0;
  bool settled = true;
  for (Eigen::Index c = 0; c < right.cols(); ++c) {
    Eigen::VectorXd difference = Eigen::VectorXd::Zero(start.rows());
    for (int round = 1; round <= kRounds; ++round) {
      Eigen::VectorXd rest = difference;
      qr.MultiplyTriangle(1, rest.data());
      rest = right.col(c) - rest;
      Eigen::VectorXd correction;
      const int steps = SolveByLsqr(qr, damped, rest, max_steps, &correction);
      settled = settled && steps >= 0;
      num_steps += steps >= 0 ? steps : max_steps;
      // The last one, which gives back what the projections took, is small enough as it is.
      if (round < kRounds) ProjectOnRowSpace(qr, damped, &correction);
      difference += correction;
    }
    result->control_points.col(c) += difference;
  }
  result->method = "LSQR, " + std::to_string(num_steps) + " steps";
  if (!settled) result->method += ", not settled";
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
    const BandedQr shifted = Factor(ShiftedRows(rows, start, 0.0));
    if (n <= kMaxDenseColumns) {
      SolveDense(shifted, n, &result);
    } else {
      SolveIteratively(rows, shifted, start, &result);
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
