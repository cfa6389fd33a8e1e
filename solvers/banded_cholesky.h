#ifndef BATTEN_SOLVERS_BANDED_CHOLESKY_H_
#define BATTEN_SOLVERS_BANDED_CHOLESKY_H_

#include "solvers/direct_solver.h"

namespace batten {

/// The normal equations in their band: the fastest direct answer, with half the digits of
/// banded_qr; a condition check says when they are lost. docs/solvers/banded_cholesky.md.
class BandedCholeskySolver final : public DirectSolver {
 public:
  static SolverInfo ClassInfo();
  explicit BandedCholeskySolver(const OptionValues& /*options*/) {}
  SolverInfo Info() const override { return ClassInfo(); }
  Outcome SolveRows(const CurveView& view, const Problem& problem, RunContext* context,
                    Eigen::VectorXd* x) const override;
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_BANDED_CHOLESKY_H_
