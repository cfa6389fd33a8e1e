#ifndef BATTEN_SPLINES_DENSE_EIGENVALUES_H_
#define BATTEN_SPLINES_DENSE_EIGENVALUES_H_

#include <Eigen/Core>

namespace batten {

// Eigen's decompositions of small dense matrices, compiled once: each place that used them by
// itself took the compiler as long as a whole solver.

/// |l| of all n eigenvalues of a general n x n matrix, in no order.
Eigen::VectorXd EigenvalueSizes(const Eigen::MatrixXd& matrix);

/// values: ascending; vectors: column k is the unit eigenvector of values[k]. All are NaN where the
/// iteration did not converge, as can happen where entries differ by many powers of ten.
struct SymmetricEigen {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
/// Of a symmetric n x n matrix, of which the lower triangle is read.
SymmetricEigen DecomposeSymmetric(const Eigen::MatrixXd& matrix);
/// Its values alone, in a fraction of the time.
Eigen::VectorXd SymmetricEigenvalues(const Eigen::MatrixXd& matrix);
/// Of a symmetric tridiagonal n x n matrix; n entries, n - 1 beside them.
SymmetricEigen DecomposeTridiagonal(const Eigen::VectorXd& diagonal,
                                    const Eigen::VectorXd& off_diagonal);

}  // namespace batten

#endif  // BATTEN_SPLINES_DENSE_EIGENVALUES_H_
