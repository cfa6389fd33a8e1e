#include "splines/dense_eigenvalues.h"

#include <Eigen/Eigenvalues>
#include <limits>

namespace batten {
namespace {

using SymmetricSolver = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>;

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

Eigen::VectorXd ValuesFound(const SymmetricSolver& solver) {
  if (solver.info() == Eigen::Success) return solver.eigenvalues();
  return Eigen::VectorXd::Constant(solver.eigenvalues().size(), kNoNumber);
}

SymmetricEigen Found(const SymmetricSolver& solver) {
  SymmetricEigen found = {ValuesFound(solver), {}};
  const Eigen::Index n = found.values.size();
  found.vectors = solver.info() == Eigen::Success
                      ? solver.eigenvectors()
                      : Eigen::MatrixXd(Eigen::MatrixXd::Constant(n, n, kNoNumber));
  return found;
}

}  // namespace

Eigen::VectorXd EigenvalueSizes(const Eigen::MatrixXd& matrix) {
  return Eigen::EigenSolver<Eigen::MatrixXd>(matrix, false).eigenvalues().cwiseAbs();
}

SymmetricEigen DecomposeSymmetric(const Eigen::MatrixXd& matrix) {
  return Found(SymmetricSolver(matrix));
}

Eigen::VectorXd SymmetricEigenvalues(const Eigen::MatrixXd& matrix) {
  return ValuesFound(SymmetricSolver(matrix, Eigen::EigenvaluesOnly));
}

SymmetricEigen DecomposeTridiagonal(const Eigen::VectorXd& diagonal,
                                    const Eigen::VectorXd& off_diagonal) {
  SymmetricSolver solver;
  solver.computeFromTridiagonal(diagonal, off_diagonal);
  return Found(solver);
}

}  // namespace batten
