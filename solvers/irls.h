#ifndef BATTEN_SOLVERS_IRLS_H_
#define BATTEN_SOLVERS_IRLS_H_

#include <memory>
#include <string>

#include "solvers/direct_solver.h"
#include "solvers/solver_registry.h"
#include "solvers/stepper.h"

namespace batten {

/// Iteratively reweighted least squares: each step solves, by a direct base, the least-squares
/// problem whose rows have the weights rho'(|r|^2) that the loss gives them at x. E never rises,
/// since rho is concave in the squared residual. A fixed point that can be accelerated:
/// `anderson:irls:banded_qr`. docs/solvers/irls.md.
class IrlsSolver final : public FixedPoint {
 public:
  static SolverInfo ClassInfo();
  explicit IrlsSolver(std::unique_ptr<Solver> base);
  SolverInfo Info() const override { return ClassInfo(); }
  std::string WhyUnsupported(const Objective& objective) const override;
  Status Map(const Eigen::VectorXd& x, Eigen::VectorXd* g_of_x) override;

 private:
  std::optional<Outcome> DoStart(Eigen::VectorXd* /*x*/) override {
    said_.clear();
    return std::nullopt;
  }
  void AtEnd() override;

  std::unique_ptr<Solver> base_;
  DirectSolver* direct_;  ///< base_, if it is one.
  std::string said_;      ///< By the base of its last solve.
};

/// The registry's row: takes the base.
SolverEntry IrlsEntry();

}  // namespace batten

#endif  // BATTEN_SOLVERS_IRLS_H_
