#ifndef BATTEN_SOLVERS_CERES_LM_H_
#define BATTEN_SOLVERS_CERES_LM_H_

#include <ceres/solver.h>

#include <optional>
#include <string>

#include "solvers/ceres_adapter.h"
#include "solvers/solver.h"

namespace batten {

/// Ceres' trust-region methods, Levenberg-Marquardt or dogleg, on Ceres' own problem of residual
/// blocks. Where parameters are free it is a sequence of Ceres solves, each on blocks that are
/// bound where the one before ended. docs/solvers/ceres_lm.md.
class CeresLmSolver final : public Solver {
 public:
  static SolverInfo ClassInfo();
  explicit CeresLmSolver(const OptionValues& options) : options_(options) {}
  SolverInfo Info() const override { return ClassInfo(); }
  std::string WhyUnsupported(const Objective& objective) const override;

 private:
  Outcome DoMinimize(Objective* objective, RunContext* context, Eigen::VectorXd* x) override;
  ceres::Solver::Options CeresOptions(const Objective& objective, const RunContext& context) const;
  /// One Ceres solve from *x; nothing where the run goes on from the new *x with blocks bound
  /// there, and then with the trust region left in *ceres_options.
  std::optional<Outcome> SolveBoundAt(Objective* objective, RunContext* context,
                                      ceres::Solver::Options* ceres_options, IterateBooker* booker,
                                      Eigen::VectorXd* x, std::string* ran) const;

  OptionValues options_;
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_CERES_LM_H_
