#include "solvers/jacobi_pia.h"

#include <algorithm>
#include <cmath>

#include "solvers/normal_spectrum.h"

namespace batten {

SolverInfo JacobiPiaSolver::ClassInfo() {
  SolverInfo info;
  info.name = "jacobi_pia";
  info.summary = "Jacobi's iteration on the normal equations";
  info.source = "Liu & Deng, J. Inf. Comput. Sci. 12, 2015; Mathematics 10:3766, 2022";
  info.needs = {"compiled rows"};
  info.supports = {"linear constraints", "weights", "any rank"};
  info.native_rule = NativeRule::kStep;
  info.options = {
      OptionInfo::Real("w", 0.0, 0.0, 2.0,
                       "factor of the step D_j / N_jj; 0: 1 / the largest row sum of |N_jk| / "
                       "(N_jj N_kk)^(1/2), which always converges")};
  return info;
}

JacobiPiaSolver::JacobiPiaSolver(const OptionValues& options) : weight_(options.Real("w")) {}

std::string JacobiPiaSolver::WhyUnsupported(const Objective& objective) const {
  return WhyNoUnboundedCurveView(objective, "jacobi_pia");
}

std::optional<Outcome> JacobiPiaSolver::DoStart(Eigen::VectorXd* x) {
  guard_.Reset();
  const CurveView& view = *objective()->curve_view();
  const NormalBand& band = view.normal_band();
  std::vector<double> inverse = band.Diagonal();
  for (double& entry : inverse) entry = entry > 0.0 ? 1.0 / entry : 0.0;
  const NormalBand scaled = ScaledToUnitDiagonal(band);
  const std::vector<double> sums = scaled.AbsoluteRowSums();
  const double largest = *std::max_element(sums.begin(), sums.end());
  if (largest == 0.0) return Outcome{StopReason::kSolved, "no data point touches a control point"};
  const double weight = weight_ > 0.0 ? weight_ : 1.0 / largest;
  context()->OffTheClock([&] {
    const double l1 = ReportSpectrum(scaled, context()->seed()).largest;
    context()->Note("w", NumberText(weight));
    context()->Note("largest w that converges", NumberText(2.0 / l1));
    // The bound itself, as far as rounding can tell, turns about for ever.
    constexpr double kRounding = 1e-9;
    if (weight * l1 >= 2.0 * (1.0 - kRounding)) {
      WarnOfDivergence("w = " + NumberText(weight) + " is not below " + NumberText(2.0 / l1) +
                       ", 2 / the largest eigenvalue of diag(A'A)^-1 A'A; w=0 chooses a safe one");
    }
  });
  step_.resize(x->size());
  for (Eigen::Index k = 0; k < step_.size(); ++k) {
    step_[k] = weight * inverse[static_cast<std::size_t>(k / view.dimension())];
  }
  return std::nullopt;
}

Status JacobiPiaSolver::Map(const Eigen::VectorXd& x, Eigen::VectorXd* g_of_x) {
  const Status status = objective()->curve_view()->NormalResidual(x, &residual_);
  if (status == Status::kOk) *g_of_x = x + step_.cwiseProduct(residual_);
  return status;
}

std::optional<Outcome> JacobiPiaSolver::Inspect(const Eigen::VectorXd& /*x*/,
                                                const Eigen::VectorXd& /*g_of_x*/) {
  // The norm of diag(N)^(-1/2) D, which never grows while it converges; that of D can.
  return guard_.Check(std::sqrt(residual_.dot(step_.cwiseProduct(residual_))));
}

std::vector<double> JacobiPiaSolver::State() const {
  std::vector<double> state;
  guard_.AppendTo(&state);
  return state;
}

void JacobiPiaSolver::Restore(const std::vector<double>& state) { guard_.Restore(state.data()); }

}  // namespace batten
