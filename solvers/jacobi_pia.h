#ifndef BATTEN_SOLVERS_JACOBI_PIA_H_
#define BATTEN_SOLVERS_JACOBI_PIA_H_

#include "solvers/stall_guard.h"
#include "solvers/stepper.h"

namespace batten {

/// Jacobi's iteration on the normal equations: P_j += w (A'(Q - A P))_j / N_jj.
/// docs/solvers/jacobi_pia.md.
class JacobiPiaSolver final : public FixedPoint {
 public:
  static SolverInfo ClassInfo();
  explicit JacobiPiaSolver(const OptionValues& options);
  SolverInfo Info() const override { return ClassInfo(); }
  std::string WhyUnsupported(const Objective& objective) const override;
  Status Map(const Eigen::VectorXd& x, Eigen::VectorXd* g_of_x) override;
  std::vector<double> State() const override;
  void Restore(const std::vector<double>& state) override;

 private:
  std::optional<Outcome> DoStart(Eigen::VectorXd* x) override;
  std::optional<Outcome> Inspect(const Eigen::VectorXd& x, const Eigen::VectorXd& g_of_x) override;

  double weight_;             // w; 0: the certified one
  Eigen::VectorXd step_;      // w / N_jj per variable
  Eigen::VectorXd residual_;  // A'(Q - A P) at the last point mapped
  StallGuard guard_;
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_JACOBI_PIA_H_
