#ifndef BATTEN_SOLVERS_BEST_OF_H_
#define BATTEN_SOLVERS_BEST_OF_H_

#include <memory>

#include "solvers/solver_registry.h"

namespace batten {

/// Runs its base from several starts and goes on from the best end: where parameters are free or
/// projected E has many minima. docs/solvers/best_of.md.
class BestOfSolver final : public Solver {
 public:
  static SolverInfo ClassInfo();
  BestOfSolver(const OptionValues& options, std::unique_ptr<Solver> base);
  SolverInfo Info() const override { return ClassInfo(); }
  std::string WhyUnsupported(const Objective& objective) const override;

 private:
  Outcome DoMinimize(Objective* objective, RunContext* context, Eigen::VectorXd* x) override;

  int starts_;
  int steps_;
  double disturbance_;
  std::unique_ptr<Solver> base_;
};

/// The registry's row: takes the base.
SolverEntry BestOfEntry();

}  // namespace batten

#endif  // BATTEN_SOLVERS_BEST_OF_H_
