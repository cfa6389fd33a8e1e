#include "solvers/gauss_seidel_pia.h"

namespace batten {

SolverInfo GaussSeidelPiaSolver::ClassInfo() {
  SolverInfo info;
  info.name = "gauss_seidel_pia";
  info.summary = "Gauss-Seidel iteration on the normal equations";
  info.source = "Mathematics 10:3766, 2022; Golub & Van Loan, sec. 11.2";
  info.needs = {"compiled rows"};
  info.supports = {"linear constraints", "weights", "any rank"};
  info.native_rule = NativeRule::kStep;
  return info;
}

}  // namespace batten
