#ifndef BATTEN_SOLVERS_BASIC_SOLUTION_H_
#define BATTEN_SOLVERS_BASIC_SOLUTION_H_

#include <Eigen/QR>

namespace batten {

/// x that minimises |A x - b| with entries in independent columns only: QR with column exchanges,
/// columns whose pivot is at most `dependent` times the largest get 0. (The solve() of Eigen's
/// ColPivHouseholderQR drops only pivots at the level of rounding, whatever its threshold.)
inline Eigen::VectorXd BasicSolution(const Eigen::MatrixXd& a, const Eigen::VectorXd& b,
                                     double dependent) {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(a.rows(), a.cols());
  qr.setThreshold(dependent);
  qr.compute(a);
  const Eigen::Index rank = qr.rank();
  Eigen::VectorXd rotated = qr.householderQ().adjoint() * b;
  Eigen::VectorXd x = Eigen::VectorXd::Zero(a.cols());
  x.head(rank) = qr.matrixR()
                     .topLeftCorner(rank, rank)
                     .triangularView<Eigen::Upper>()
                     .solve(rotated.head(rank));
  return qr.colsPermutation() * x;
}

}  // namespace batten

#endif  // BATTEN_SOLVERS_BASIC_SOLUTION_H_
