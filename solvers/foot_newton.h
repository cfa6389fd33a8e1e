#ifndef BATTEN_SOLVERS_FOOT_NEWTON_H_
#define BATTEN_SOLVERS_FOOT_NEWTON_H_

#include "solvers/joint_descent.h"

namespace batten {

/// Newton's method on control points and parameters, the parameters eliminated, in which the points
/// look for their feet on the whole curve: after every step while that pays, seldom when it no
/// longer does. docs/solvers/foot_newton.md.
class FootNewtonSolver final : public JointDescent {
 public:
  static SolverInfo ClassInfo();
  explicit FootNewtonSolver(const OptionValues& options)
      : JointDescent(FootModelKind::kNewton), longest_wait_(options.Integer("longest_wait")) {}
  SolverInfo Info() const override { return ClassInfo(); }
  std::string WhyUnsupported(const Objective& objective) const override {
    return WhyNoFreeParameters(objective, Info().name);
  }
  std::vector<double> State() const override;
  void Restore(const std::vector<double>& state) override;

 private:
  Status Complete(Eigen::VectorXd* all) override;
  Status CompleteStart(const Eigen::VectorXd& x, Eigen::VectorXd* all) override;
  std::optional<Outcome> DoStart(Eigen::VectorXd* x) override;
  std::optional<Outcome> DoStep(Eigen::VectorXd* x) override;

  int longest_wait_;
  int wait_ = 1;  // steps from one projection to the next
  int waited_ = 0;
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_FOOT_NEWTON_H_
