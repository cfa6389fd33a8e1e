#include "solvers/sweeping_pia.h"

namespace batten {

std::string SweepingPia::WhyUnsupported(const Objective& objective) const {
  return WhyNoUnboundedCurveView(objective, Info().name);
}

std::optional<Outcome> SweepingPia::DoStart(Eigen::VectorXd* /*x*/) {
  // Converges always, but of moves along tiny eigenvalues the longest can come late.
  constexpr int kPatience = 3 * StallGuard::kPatience;
  guard_.Reset(kPatience);
  sweep_.emplace(&objective()->curve_view()->normal_band());
  return std::nullopt;
}

Status SweepingPia::Map(const Eigen::VectorXd& x, Eigen::VectorXd* g_of_x) {
  if (!objective()->curve_view()->AllowProduct(x)) return Status::kStop;
  *g_of_x = x;
  sweep_->Sweep(relaxation_, g_of_x->data());
  return g_of_x->allFinite() ? Status::kOk : Status::kNonFinite;
}

std::optional<Outcome> SweepingPia::Inspect(const Eigen::VectorXd& x,
                                            const Eigen::VectorXd& g_of_x) {
  return guard_.Check((g_of_x - x).norm());
}

std::vector<double> SweepingPia::State() const {
  std::vector<double> state;
  guard_.AppendTo(&state);
  return state;
}

void SweepingPia::Restore(const std::vector<double>& state) { guard_.Restore(state.data()); }

}  // namespace batten
