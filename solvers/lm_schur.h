#ifndef BATTEN_SOLVERS_LM_SCHUR_H_
#define BATTEN_SOLVERS_LM_SCHUR_H_

#include "solvers/joint_descent.h"

namespace batten {

/// Levenberg-Marquardt in control points and parameters, parameters eliminated exactly and the
/// reduced system factored in its band. docs/solvers/lm_schur.md.
class LmSchurSolver final : public JointDescent {
 public:
  static SolverInfo ClassInfo();
  explicit LmSchurSolver(const OptionValues& /*options*/) : JointDescent(FootModelKind::kTangent) {}
  SolverInfo Info() const override { return ClassInfo(); }
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_LM_SCHUR_H_
