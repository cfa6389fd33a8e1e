#ifndef BATTEN_SOLVERS_SOR_PIA_H_
#define BATTEN_SOLVERS_SOR_PIA_H_

#include "solvers/sweeping_pia.h"

namespace batten {

/// Successive over-relaxation on the normal equations: P_j += w D_j / N_jj, D with the newest P.
/// docs/solvers/sor_pia.md.
class SorPiaSolver final : public SweepingPia {
 public:
  static SolverInfo ClassInfo();
  explicit SorPiaSolver(const OptionValues& options) : SweepingPia(options.Real("w")) {}
  SolverInfo Info() const override { return ClassInfo(); }
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_SOR_PIA_H_
