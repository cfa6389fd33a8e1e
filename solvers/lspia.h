#ifndef BATTEN_SOLVERS_LSPIA_H_
#define BATTEN_SOLVERS_LSPIA_H_

#include <optional>
#include <string>
#include <vector>

#include "solvers/fairing_weights.h"
#include "solvers/own_limit.h"
#include "solvers/solver_registry.h"
#include "solvers/stall_guard.h"
#include "solvers/stepper.h"

namespace batten {

/// Least-squares progressive-iterative approximation: P += mu A'(Q - A P), mu a number or a
/// diagonal that depends on P alone. With fairing terms that is fairing-PIA, whose weights per
/// control point are FairingWeights. docs/solvers/lspia.md.
class LspiaSolver final : public FixedPoint {
 public:
  static SolverInfo ClassInfo();
  explicit LspiaSolver(const OptionValues& options);
  /// lspia/step=diagonal with any factor of the fairing terms at each control point, 0 or more; as
  /// many as there are.
  explicit LspiaSolver(std::vector<double> fairing_factors);
  SolverInfo Info() const override;
  std::string WhyUnsupported(const Objective& objective) const override;
  Status Map(const Eigen::VectorXd& x, Eigen::VectorXd* g_of_x) override;
  std::vector<double> State() const override;
  void Restore(const std::vector<double>& state) override;

 private:
  std::optional<Outcome> DoStart(Eigen::VectorXd* x) override;
  std::optional<Outcome> Inspect(const Eigen::VectorXd& x, const Eigen::VectorXd& g_of_x) override;
  std::optional<Outcome> ChooseStep(const Eigen::VectorXd& x);
  bool weighs_fairing() const { return fairing_factor_ != 1.0 || !fairing_factors_.empty(); }
  void WeighFairing();

  std::string step_rule_;
  double relaxation_;
  double fairing_factor_ = 1.0;  // at control points fairing_first_..fairing_last_
  int fairing_first_ = 0;
  int fairing_last_ = 0;
  std::vector<double> fairing_factors_;     // instead of these
  std::optional<FairingWeights> weighted_;  // none: all factors are 1
  OwnLimit own_limit_;                      // of weighted_
  Eigen::VectorXd step_;                    // mu per variable; empty for cauchy
  Eigen::VectorXd residual_;                // A'(Q - A P) at the last point mapped
  Eigen::VectorXd product_;
  Eigen::VectorXd move_;
  Eigen::VectorXd last_move_;
  double last_length_ = 0.0;
  int alternations_ = 0;
  StallGuard guard_;
};

/// lspia/step=barzilai_borwein: mu_k = s's / s'N s with the last move s, which makes it no map.
class BarzilaiBorweinLspiaSolver final : public Stepper {
 public:
  explicit BarzilaiBorweinLspiaSolver(const OptionValues& options);
  SolverInfo Info() const override { return LspiaSolver::ClassInfo(); }
  std::string WhyUnsupported(const Objective& objective) const override;
  std::vector<double> State() const override;
  void Restore(const std::vector<double>& state) override;

 private:
  std::optional<Outcome> DoStart(Eigen::VectorXd* x) override;
  std::optional<Outcome> DoStep(Eigen::VectorXd* x) override;

  double relaxation_;
  bool weighs_fairing_;
  double first_step_ = 0.0;   // 1 / largest row sum of |N|
  Eigen::VectorXd residual_;  // A'(Q - A P) at the last point
  Eigen::VectorXd previous_x_;
  Eigen::VectorXd previous_residual_;
  StallGuard guard_;
};

/// The registry's row: one of both classes, as the option `step` says.
SolverEntry LspiaEntry();

}  // namespace batten

#endif  // BATTEN_SOLVERS_LSPIA_H_
