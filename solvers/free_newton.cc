#include "solvers/free_newton.h"

namespace batten {

SolverInfo FreeNewtonSolver::ClassInfo() {
  SolverInfo info;
  info.name = "free_newton";
  info.summary = "Full Newton steps, damped; parameters eliminated, the rest factored in its band";
  info.source = "Nocedal & Wright, Numerical Optimization, ch. 3 and 10";
  info.needs = {"free parameters"};
  info.supports = {"held parameters", "weights", "affine terms"};
  info.native_rule = NativeRule::kGradient;
  return info;
}

}  // namespace batten
