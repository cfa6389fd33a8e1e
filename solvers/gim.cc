#include "solvers/gim.h"

namespace batten {

SolverInfo GimSolver::ClassInfo() {
  SolverInfo info;
  info.name = "gim";
  info.summary =
      "geometric iteration (PIA): each control point moves by the residual paired with it";
  info.source = "Qi et al. 1975; de Boor 1979; Lin, Wang & Dong 2004; Lin, Bao & Wang 2005";
  info.needs = {"compiled rows", FurtherTerms::kNeeds, "as many control points as points"};
  info.limit = kPairedLimit;
  info.native_rule = NativeRule::kStep;
  return info;
}

}  // namespace batten
