#ifndef BATTEN_SOLVERS_BANDED_CHOLESKY_H_
#define BATTEN_SOLVERS_BANDED_CHOLESKY_H_

#include "solvers/solver.h"

namespace batten {

/// The normal equations in their band: the fastest direct answer, with half the digits of
/// banded_qr; a condition check says when they are lost. docs/solvers/banded_cholesky.md.
class BandedCholeskySolver final : public Solver {
 public:
  static SolverInfo ClassInfo();
  explicit BandedCholeskySolver(const OptionValues& /*options*/) {}
  SolverInfo Info() const override { return ClassInfo(); }
  std::string WhyUnsupported(const Objective& objective) const override;

 private:
  Outcome DoMinimize(Objective* objective, RunContext* context, Eigen::VectorXd* x) override;
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_BANDED_CHOLESKY_H_
