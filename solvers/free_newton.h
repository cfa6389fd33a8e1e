#ifndef BATTEN_SOLVERS_FREE_NEWTON_H_
#define BATTEN_SOLVERS_FREE_NEWTON_H_

#include "solvers/joint_descent.h"

namespace batten {

/// Newton method in control points and parameters, parameters eliminated exactly and the
/// reduced system factored in its band. docs/solvers/free_newton.md.
class FreeNewtonSolver final : public JointDescent {
 public:
  static SolverInfo ClassInfo();
  explicit FreeNewtonSolver(const OptionValues& /*options*/)
      : JointDescent(FootModelKind::kNewton) {}
  SolverInfo Info() const override { return ClassInfo(); }
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_FREE_NEWTON_H_
