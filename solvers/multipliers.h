#ifndef BATTEN_SOLVERS_MULTIPLIERS_H_
#define BATTEN_SOLVERS_MULTIPLIERS_H_

#include <Eigen/Core>
#include <memory>

#include "problems/objective.h"

namespace batten {

/// The multipliers of the augmented Lagrangian
///   E + weight * sum over k of (s_k h_k + mu_k)^2,
/// of inequalities h_k >= 0 where that is negative only; lambda_k = 2 weight s_k mu_k. Hestenes,
/// J. Optim. Theory Appl. 4, 1969; Powell 1969; Rockafellar 1973 for inequalities. Nocedal &
/// Wright, Numerical Optimization, ch. 17.
class Multipliers {
 public:
  /// All 0. With s_k = sqrt(q_k), q_k what E costs per squared unit of h_k along the shortest move
  /// that changes h_k (half of E's second derivative): the error of lambda then falls by
  /// 1 / (1 + weight) or more per update on quadratics with one constraint. Asks for one Hessian
  /// product per constraint. kOk unless the monitor stops or a constraint has no value at x.
  static Status Make(Objective* objective, const Eigen::VectorXd& x, double weight,
                     Multipliers* made);

  std::unique_ptr<BlockFamily> MakePenalty(const ConstraintFamily& constraints) const {
    return constraints.MakePenalty(weight_, scales_, shifts_);
  }
  /// mu_k += s_k h_k at the minimum of the augmented Lagrangian.
  void Update(const ConstraintFamily& constraints, const Eigen::VectorXd& h);
  /// Raises the weight, at equal multipliers.
  void Raise(double factor);
  double weight() const { return weight_; }
  Eigen::VectorXd values() const;  ///< lambda

 private:
  double weight_ = 1.0;
  Eigen::VectorXd scales_;
  Eigen::VectorXd shifts_;
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_MULTIPLIERS_H_
