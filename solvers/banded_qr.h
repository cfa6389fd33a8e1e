#ifndef BATTEN_SOLVERS_BANDED_QR_H_
#define BATTEN_SOLVERS_BANDED_QR_H_

#include "solvers/direct_solver.h"

namespace batten {

/// QR of the rows in their band: the direct answer that others are held against. Under-determined
/// and rank-deficient problems get the minimiser nearest to the start. docs/solvers/banded_qr.md.
class BandedQrSolver final : public DirectSolver {
 public:
  static SolverInfo ClassInfo();
  explicit BandedQrSolver(const OptionValues& /*options*/) {}
  SolverInfo Info() const override { return ClassInfo(); }
  Outcome SolveRows(const CurveView& view, const Problem& problem, RunContext* context,
                    Eigen::VectorXd* x) const override;
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_BANDED_QR_H_
