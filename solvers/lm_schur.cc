#include "solvers/lm_schur.h"

namespace batten {

SolverInfo LmSchurSolver::ClassInfo() {
  SolverInfo info;
  info.name = "lm_schur";
  info.summary = "Levenberg-Marquardt, parameters eliminated, the rest factored in its band";
  info.source = "Marquardt, J. SIAM 11, 1963; Triggs et al., Bundle adjustment, 2000, sec. 6";
  info.needs = {"free parameters"};
  info.supports = {"linear constraints", "held parameters", "weights", "losses",
                   "terms in control points"};
  info.native_rule = NativeRule::kGradient;
  return info;
}

}  // namespace batten
