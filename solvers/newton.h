#ifndef BATTEN_SOLVERS_NEWTON_H_
#define BATTEN_SOLVERS_NEWTON_H_

#include "solvers/joint_descent.h"
#include "solvers/stall_guard.h"
#include "solvers/stepper.h"
#include "splines/banded_cholesky.h"

namespace batten {

/// Newton's method on a fit with free parameters, which are eliminated.
class FreeNewton final : public JointDescent {
 public:
  FreeNewton() : JointDescent(FootModelKind::kNewton) {}
  SolverInfo Info() const override;
};

/// Newton's method. Where E is compiled rows P += N^-1 A'(Q - A P): the Hessian 2 N is banded, its
/// factor too. With other terms ExactNewton, with free parameters FreeNewton.
/// docs/solvers/newton.md.
class NewtonSolver final : public Stepper {
 public:
  static SolverInfo ClassInfo();
  explicit NewtonSolver(const OptionValues& /*options*/) {}
  SolverInfo Info() const override { return ClassInfo(); }
  std::string WhyUnsupported(const Objective& objective) const override;
  std::vector<double> State() const override;
  void Restore(const std::vector<double>& state) override;

 private:
  std::optional<Outcome> DoStart(Eigen::VectorXd* x) override;
  std::optional<Outcome> DoStep(Eigen::VectorXd* x) override;
  std::optional<Outcome> SolveSingular(Eigen::VectorXd* x);

  BandedCholesky factor_;
  bool singular_ = false;
  Eigen::VectorXd step_;
  StallGuard guard_;
  std::unique_ptr<Stepper> other_;  // null: E is compiled rows
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_NEWTON_H_
