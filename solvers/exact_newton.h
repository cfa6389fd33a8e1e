#ifndef BATTEN_SOLVERS_EXACT_NEWTON_H_
#define BATTEN_SOLVERS_EXACT_NEWTON_H_

#include <optional>
#include <vector>

#include "problems/fit_problem.h"
#include "solvers/hessian_band.h"
#include "solvers/stepper.h"
#include "splines/banded_cholesky.h"
#include "splines/substituted_band.h"

namespace batten {

/// Newton's method on a fit with fixed parameters whose energy is not quadratic: (H + damping
/// diag|H|) s = -g, the damping 0 where such steps lower E as foretold, so that the end is
/// quadratic.
class ExactNewton final : public Stepper {
 public:
  SolverInfo Info() const override;
  /// Empty where second derivatives stand in a band of the control points.
  static std::string WhyNot(const Objective& objective, const std::string& name);
  std::string WhyUnsupported(const Objective& objective) const override {
    return WhyNot(objective, Info().name);
  }
  std::vector<double> State() const override { return {damping_}; }
  void Restore(const std::vector<double>& state) override { damping_ = state[0]; }

 private:
  std::optional<Outcome> DoStart(Eigen::VectorXd* x) override;
  std::optional<Outcome> DoStep(Eigen::VectorXd* x) override;
  /// The step with the present damping; false where H + damping diag|H| is not positive definite.
  bool FindStep(Eigen::VectorXd* step);
  void RaiseDamping();

  std::optional<HessianBand> hessian_;
  std::optional<SubstitutedBand> free_band_;  // none: no constraints
  NormalBand damped_{RowShape()};
  BandedCholesky factor_;
  Eigen::VectorXd gradient_;
  double energy_ = 0.0;
  double damping_ = 0.0;
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_EXACT_NEWTON_H_
