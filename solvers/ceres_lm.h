#ifndef BATTEN_SOLVERS_CERES_LM_H_
#define BATTEN_SOLVERS_CERES_LM_H_

#include <string>

#include "solvers/solver.h"

namespace batten {

/// Ceres' trust-region methods, Levenberg-Marquardt or dogleg, on Ceres' own problem of residual
/// blocks. docs/solvers/ceres_lm.md.
class CeresLmSolver final : public Solver {
 public:
  static SolverInfo ClassInfo();
  explicit CeresLmSolver(const OptionValues& options) : options_(options) {}
  SolverInfo Info() const override { return ClassInfo(); }
  std::string WhyUnsupported(const Objective& objective) const override;

 private:
  Outcome DoMinimize(Objective* objective, RunContext* context, Eigen::VectorXd* x) override;

  OptionValues options_;
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_CERES_LM_H_
