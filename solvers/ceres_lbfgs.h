#ifndef BATTEN_SOLVERS_CERES_LBFGS_H_
#define BATTEN_SOLVERS_CERES_LBFGS_H_

#include <string>

#include "solvers/solver.h"

namespace batten {

/// Ceres' L-BFGS with its Wolfe line search, on E / 2. Its `form` says what Ceres gets: our
/// objective as one function, Ceres' own problem of residual blocks, or one block per span.
/// docs/solvers/ceres_lbfgs.md.
class CeresLbfgsSolver final : public Solver {
 public:
  static SolverInfo ClassInfo();
  explicit CeresLbfgsSolver(const OptionValues& options) : options_(options) {}
  SolverInfo Info() const override { return ClassInfo(); }
  std::string WhyUnsupported(const Objective& objective) const override;

 private:
  Outcome DoMinimize(Objective* objective, RunContext* context, Eigen::VectorXd* x) override;
  Outcome MinimizeObjective(Objective* objective, RunContext* context, Eigen::VectorXd* x) const;
  Outcome MinimizeCeresProblem(Objective* objective, RunContext* context, Eigen::VectorXd* x) const;
  /// Sets what ceres::Solver and ceres::GradientProblemSolver have in common.
  template <typename Options>
  void SetOptions(Options* ceres_options) const;

  OptionValues options_;
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_CERES_LBFGS_H_
