#ifndef BATTEN_SOLVERS_PRECONDITIONED_PIA_H_
#define BATTEN_SOLVERS_PRECONDITIONED_PIA_H_

#include "solvers/paired_iteration.h"

namespace batten {

/// Geometric iteration with a banded approximate inverse: P += M^-1 (Q - A P).
/// docs/solvers/preconditioned_pia.md.
class PreconditionedPiaSolver final : public PairedIteration {
 public:
  static SolverInfo ClassInfo();
  explicit PreconditionedPiaSolver(const OptionValues& options);
  SolverInfo Info() const override { return ClassInfo(); }

 private:
  std::optional<Outcome> Prepare() override;
  void TurnIntoMoves(Points* residuals) const override;
  std::string MatrixName() const override { return "I - M^-1 A"; }

  int half_width_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> inverse_;  // M^-1
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_PRECONDITIONED_PIA_H_
