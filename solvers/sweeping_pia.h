#ifndef BATTEN_SOLVERS_SWEEPING_PIA_H_
#define BATTEN_SOLVERS_SWEEPING_PIA_H_

#include <optional>

#include "solvers/stall_guard.h"
#include "solvers/stepper.h"
#include "splines/band_sweep.h"

namespace batten {

/// One control point after the other, each with the newest values of the others. N is symmetric and
/// positive semidefinite, so that every relaxation in (0, 2) converges (Ostrowski, Reich; Keller
/// for singular N).
class SweepingPia : public FixedPoint {
 public:
  explicit SweepingPia(double relaxation) : relaxation_(relaxation) {}
  std::string WhyUnsupported(const Objective& objective) const override;
  Status Map(const Eigen::VectorXd& x, Eigen::VectorXd* g_of_x) override;
  std::vector<double> State() const override;
  void Restore(const std::vector<double>& state) override;

 private:
  std::optional<Outcome> DoStart(Eigen::VectorXd* x) override;
  std::optional<Outcome> Inspect(const Eigen::VectorXd& x, const Eigen::VectorXd& g_of_x) override;

  double relaxation_;
  std::optional<BandSweep> sweep_;
  StallGuard guard_;
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_SWEEPING_PIA_H_
