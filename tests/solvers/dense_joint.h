#ifndef BATTEN_TESTS_SOLVERS_DENSE_JOINT_H_
#define BATTEN_TESTS_SOLVERS_DENSE_JOINT_H_

#include <Eigen/Core>

#include "problems/objective.h"
#include "solvers/foot_model.h"

namespace batten {

/// Half gradient and half Hessian of a free fit in its control points and those parameters that
/// move, dense and from the objective's own derivatives, that is from the functors.
class DenseJoint {
 public:
  /// At the free variables x. Parameters that are held, past an end, or pressed against one are no
  /// variables.
  DenseJoint(const Problem& problem, const Eigen::VectorXd& x);

  /// What a FootModel with this kind and damping of the parameters should hold: reduced to the
  /// control points.
  struct Reduced {
    Eigen::MatrixXd half_hessian;
    Eigen::VectorXd half_gradient;
  };
  Reduced Reduce(FootModelKind kind, double damping) const;
  /// The joint step -(H + D)^-1 g of the same model, control points, then all free parameters (zero
  /// where they stay); D is `damping` times the diagonal of J'J, for control points at least 1e-3
  /// of its mean, for parameters at least 1e-3 of the mean of |C'|^2 in the middles of the spans.
  Eigen::VectorXd Step(FootModelKind kind, double damping) const;
  /// What the quadratic model, not damped, says that E falls by.
  double Fall(FootModelKind kind, const Eigen::VectorXd& step) const;

  int num_moving() const { return static_cast<int>(moving_.size()); }
  int num_pressed() const { return num_pressed_; }
  /// Moving parameters at an end of the domain.
  int num_leaving() const { return num_leaving_; }
  /// Least (|C'|^2 + r . C'') / |C'|^2 of those that move.
  double least_curvature() const;
  const Eigen::MatrixXd& gauss_newton() const { return gauss_newton_; }

 private:
  const Eigen::MatrixXd& HalfHessian(FootModelKind kind) const {
    return kind == FootModelKind::kNewton ? newton_ : gauss_newton_;
  }
  /// Diagonal entry of a parameter by which it is eliminated; `k` counts moving ones.
  double Denominator(FootModelKind kind, double damping, Eigen::Index k) const;

  Eigen::Index points_ = 0;           // numbers of control points
  Eigen::Index free_ = 0;             // free variables
  std::vector<Eigen::Index> moving_;  // places among the free variables
  int num_pressed_ = 0;
  int num_leaving_ = 0;
  // In control points and moving parameters.
  Eigen::MatrixXd gauss_newton_;  // J'J
  Eigen::MatrixXd newton_;        // exact
  Eigen::VectorXd gradient_;      // J'r
  Eigen::VectorXd slow_;          // of moving parameters: what damping takes over |C'|^2, 1 or more
};

}  // namespace batten

#endif  // BATTEN_TESTS_SOLVERS_DENSE_JOINT_H_
