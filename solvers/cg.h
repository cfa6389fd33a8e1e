#ifndef BATTEN_SOLVERS_CG_H_
#define BATTEN_SOLVERS_CG_H_

#include "solvers/stepper.h"

namespace batten {

/// Conjugate gradients on the normal equations N P = A'Q, in the normal band. docs/solvers/cg.md.
class CgSolver final : public Stepper {
 public:
  static SolverInfo ClassInfo();
  explicit CgSolver(const OptionValues& /*options*/) {}
  SolverInfo Info() const override { return ClassInfo(); }
  std::string WhyUnsupported(const Objective& objective) const override;
  std::vector<double> State() const override;
  void Restore(const std::vector<double>& state) override;

 private:
  std::optional<Outcome> DoStart(Eigen::VectorXd* x) override;
  std::optional<Outcome> DoStep(Eigen::VectorXd* x) override;
  Status Refresh(const Eigen::VectorXd& x);

  Eigen::VectorXd residual_;  // A'(Q - A P), by recursion
  Eigen::VectorXd direction_;
  Eigen::VectorXd product_;
  double squared_norm_ = 0.0;       // of residual_
  double refreshed_squared_ = 0.0;  // of residual_ when it was last computed afresh
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_CG_H_
