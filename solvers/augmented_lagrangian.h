#ifndef BATTEN_SOLVERS_AUGMENTED_LAGRANGIAN_H_
#define BATTEN_SOLVERS_AUGMENTED_LAGRANGIAN_H_

#include <memory>

#include "solvers/multipliers.h"
#include "solvers/solver_registry.h"

namespace batten {

/// The method of multipliers: its base lowers E and a penalty of the constraints that are not
/// linear, whose shifts follow the multipliers; after each round the point is projected onto the
/// constraints by Newton's steps. Without such constraints it is its base.
/// docs/solvers/augmented_lagrangian.md.
class AugmentedLagrangianSolver final : public Solver {
 public:
  static SolverInfo ClassInfo();
  AugmentedLagrangianSolver(const OptionValues& options, std::unique_ptr<Solver> base);
  SolverInfo Info() const override { return ClassInfo(); }
  std::string WhyUnsupported(const Objective& objective) const override;

 private:
  /// What the rounds have come to.
  struct Progress {
    double violation = 0.0;       // where the base ended
    double least_gradient = 0.0;  // of the Lagrangian, at points that meet the constraints
    int raises = 0;
    int idle_rounds = 0;
  };

  Outcome DoMinimize(Objective* objective, RunContext* context, Eigen::VectorXd* x) override;
  std::optional<Outcome> Round(Objective* objective, RunContext* context, bool first,
                               Multipliers* multipliers, Progress* progress, Eigen::VectorXd* x);
  /// Projects *x and books it. False where no point near meets the constraints.
  bool BookProjected(Objective* objective, RunContext* context, const Multipliers& multipliers,
                     Progress* progress, Eigen::VectorXd* x) const;

  double penalty_;
  double reduction_;
  std::unique_ptr<Solver> base_;
};

/// The registry's row: takes the base.
SolverEntry AugmentedLagrangianEntry();

}  // namespace batten

#endif  // BATTEN_SOLVERS_AUGMENTED_LAGRANGIAN_H_
