#include "solvers/sor_pia.h"

namespace batten {

SolverInfo SorPiaSolver::ClassInfo() {
  SolverInfo info;
  info.name = "sor_pia";
  info.summary = "successive over-relaxation on the normal equations";
  info.source = "Mathematics 10:3766, 2022; Young, Trans. AMS 76, 1954";
  info.needs = {"compiled rows"};
  info.supports = {"linear constraints", "weights", "any rank"};
  info.native_rule = NativeRule::kStep;
  info.options = {
      OptionInfo::Real("w", 1.3, 0.001, 1.999, "over-relaxation; converges for every 0 < w < 2")};
  return info;
}

}  // namespace batten
