#ifndef BATTEN_SOLVERS_VARPRO_H_
#define BATTEN_SOLVERS_VARPRO_H_

#include "solvers/joint_descent.h"

namespace batten {

/// Variable projection: the parameters are the variables, the control points always the
/// least-squares ones for them, with losses those of one reweighted step. docs/solvers/varpro.md.
class VarproSolver final : public JointDescent {
 public:
  static SolverInfo ClassInfo();
  explicit VarproSolver(const OptionValues& /*options*/) : JointDescent(FootModelKind::kTangent) {}
  SolverInfo Info() const override { return ClassInfo(); }
  std::string WhyUnsupported(const Objective& objective) const override;

 private:
  Status Complete(Eigen::VectorXd* all) override;

  std::unique_ptr<FootModel> linear_;
  const FreeView* view_ = nullptr;  // that linear_ belongs to
  Eigen::VectorXd step_;
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_VARPRO_H_
