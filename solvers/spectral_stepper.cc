#include "solvers/spectral_stepper.h"

#include <algorithm>
#include <cmath>

namespace batten {

std::string SpectralStepper::WhyUnsupported(const Objective& objective) const {
  return WhyNoUnboundedCurveView(objective, Info().name);
}

std::optional<Outcome> SpectralStepper::DoStart(Eigen::VectorXd* x) {
  guard_.Reset();
  iteration_ = 0;
  NormalSpectrum spectrum;
  Status status = EstimateNormalSpectrum(objective()->curve_view(), context()->seed(), &spectrum);
  if (status != Status::kOk) return Ended(status);
  if (spectrum.largest == 0.0) {
    return Outcome{StopReason::kSolved, "no data point touches a control point"};
  }
  // Momentum rises for about the root of the condition number before it falls.
  constexpr double kRoots = 20.0;
  constexpr double kMost = 1e6;
  const double root = std::sqrt(spectrum.largest / spectrum.smallest);
  guard_.Reset(std::max(StallGuard::kPatience, static_cast<int>(std::min(kRoots * root, kMost))));
  constexpr double kLong = 100.0;
  if (root > kLong) {
    context()->Note("ill-conditioned", "E may rise for some " + NumberText(std::round(root)) +
                                           " iterations before it falls");
  }
  const double rate = ChooseWeights(spectrum);
  context()->Note("eigenvalues of A'A",
                  NumberText(spectrum.smallest) + " to " + NumberText(spectrum.largest));
  context()->Note("predicted rate", NumberText(rate));
  status = Begin(*x);
  if (status != Status::kOk) return Ended(status);
  return std::nullopt;
}

std::optional<Outcome> SpectralStepper::DoStep(Eigen::VectorXd* x) {
  const Status status = Advance(x);
  if (status != Status::kOk) return Ended(status);
  ++iteration_;
  return guard_.Check(residual_.norm());
}

std::vector<double> SpectralStepper::State() const {
  std::vector<double> state(memory_.data(), memory_.data() + memory_.size());
  guard_.AppendTo(&state);
  state.push_back(iteration_);
  return state;
}

void SpectralStepper::Restore(const std::vector<double>& state) {
  memory_ = Eigen::Map<const Eigen::VectorXd>(state.data(), memory_.size());
  guard_.Restore(state.data() + memory_.size());
  iteration_ = static_cast<int>(state.back());
}

}  // namespace batten
