#include "splines/dense_eigenvalues.h"

#include <Eigen/Eigenvalues>
#include <limits>

namespace batten {
namespace {

using SymmetricSolver = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>;

SymmetricEigen Found(const SymmetricSolver& solver) {
  const Eigen::Index n = solver.eigenvalues().size();
  if (solver.info() != Eigen::Success) {
    constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
    return {Eigen::VectorXd::Constant(n, kNoNumber), Eigen::MatrixXd::Constant(n, n, kNoNumber)};
  }
  return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace

Eigen::VectorXd EigenvalueSizes(const Eigen::MatrixXd& matrix) {
  return Eigen::EigenSolver<Eigen::MatrixXd>(matrix, false).eigenvalues().cwiseAbs();
}

SymmetricEigen DecomposeSymmetric(const Eigen::MatrixXd& matrix) {
  return Found(SymmetricSolver(matrix));
}

SymmetricEigen DecomposeTridiagonal(const Eigen::VectorXd& diagonal,
                                    const Eigen::VectorXd& off_diagonal) {
  SymmetricSolver solver;
  solver.computeFromTridiagonal(diagonal, off_diagonal);
  return Found(solver);
}

}  // namespace batten
