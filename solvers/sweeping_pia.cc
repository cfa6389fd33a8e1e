#include "solvers/sweeping_pia.h"

namespace batten {

std::string SweepingPia::WhyUnsupported(const Objective& objective) const {
  const std::string name = Info().name;
  const std::string why = WhyNoCurveView(objective, name);
  return why.empty() ? WhyNoBounds(objective, name) : why;
}

std::optional<Outcome> SweepingPia::DoStart(Eigen::VectorXd* /*x*/) {
  guard_.Reset();
  sweep_.emplace(&objective()->curve_view()->normal_band());
  return std::nullopt;
}

Status SweepingPia::Map(const Eigen::VectorXd& x, Eigen::VectorXd* g_of_x) {
  return objective()->curve_view()->Sweep(*sweep_, relaxation_, x, g_of_x);
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
