#ifndef BATTEN_SOLVERS_GAUSS_SEIDEL_PIA_H_
#define BATTEN_SOLVERS_GAUSS_SEIDEL_PIA_H_

#include "solvers/sweeping_pia.h"

namespace batten {

/// Gauss-Seidel iteration on the normal equations: P_j += D_j / N_jj, D with the newest P.
/// docs/solvers/gauss_seidel_pia.md.
class GaussSeidelPiaSolver final : public SweepingPia {
 public:
  static SolverInfo ClassInfo();
  explicit GaussSeidelPiaSolver(const OptionValues& /*options*/) : SweepingPia(1.0) {}
  SolverInfo Info() const override { return ClassInfo(); }
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_GAUSS_SEIDEL_PIA_H_
