#ifndef BATTEN_PROBLEMS_LINEAR_ELIMINATION_H_
#define BATTEN_PROBLEMS_LINEAR_ELIMINATION_H_

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <string>
#include <utility>
#include <vector>

#include "splines/points.h"

namespace batten {

/// sum_k coefficient_k x_(index_k) = value.
struct LinearConstraint {
  std::string name;
  std::vector<std::pair<int, double>> coefficients;
  double value = 0.0;
};

/// x = offset + Z y: the points x that meet all linear constraints, in fewer unknowns y. Each
/// independent constraint gives up the variable with its largest coefficient after the ones before
/// it are put in (Gauss-Jordan), so Z has the identity in the rows of the variables that stay.
class LinearElimination {
 public:
  /// Nothing to eliminate.
  LinearElimination() = default;
  /// False if two constraints contradict each other or one has no variable; `error` names them.
  /// Repeated ones are allowed.
  static bool Make(int num_variables, const std::vector<LinearConstraint>& constraints,
                   LinearElimination* elimination, std::string* error);

  bool trivial() const { return z_.rows() == 0; }
  int num_free(int num_variables) const {
    return trivial() ? num_variables : static_cast<int>(z_.cols());
  }
  Eigen::VectorXd Expand(const Eigen::VectorXd& y) const;  ///< offset + Z y.
  /// Expand in place, with the same bits: variables of x that others determine get what these say.
  void Determine(Eigen::VectorXd* x) const;
  Eigen::VectorXd ExpandDirection(const Eigen::VectorXd& v) const;  ///< Z v.
  Eigen::VectorXd Restrict(const Eigen::VectorXd& gradient) const;  ///< Z' g.
  /// The y whose free variables are those of x: meets the constraints whether x does or not.
  Eigen::VectorXd FreeVariables(const Eigen::VectorXd& x) const;
  const Eigen::SparseMatrix<double, Eigen::RowMajor>& z() const { return z_; }
  const std::vector<int>& free() const { return free_; }  ///< Variable behind each y.
  /// Whether all of the variables begin..end-1 stay.
  bool LeavesAll(int begin, int end) const;

  /// If Z acts on the points x[begin + j * dimension + c] alike for all coordinates c, and on
  /// nothing else: Z for points (n x n') and the offset (n x dimension). False otherwise.
  bool ForPoints(int begin, int num_points, int dimension,
                 Eigen::SparseMatrix<double, Eigen::RowMajor>* z, Points* offset) const;

 private:
  Eigen::SparseMatrix<double, Eigen::RowMajor> z_;
  Eigen::VectorXd offset_;
  std::vector<int> free_;
};

}  // namespace batten

#endif  // BATTEN_PROBLEMS_LINEAR_ELIMINATION_H_
