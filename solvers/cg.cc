#include "solvers/cg.h"

#include <cmath>

namespace batten {

SolverInfo CgSolver::ClassInfo() {
  SolverInfo info;
  info.name = "cg";
  info.summary = "conjugate gradients on the normal equations in their band";
  info.source = "Hestenes & Stiefel, J. Res. NBS 49, 1952; Golub & Van Loan, sec. 11.3";
  info.needs = {"compiled rows"};
  info.supports = {"linear constraints", "weights", "any rank (nearest to the start)"};
  info.native_rule = NativeRule::kGradient;
  return info;
}

std::string CgSolver::WhyUnsupported(const Objective& objective) const {
  return WhyNoUnboundedCurveView(objective, "cg");
}

Status CgSolver::Refresh(const Eigen::VectorXd& x) {
  const Status status = objective()->curve_view()->NormalResidual(x, &residual_);
  direction_ = residual_;
  squared_norm_ = refreshed_squared_ = residual_.squaredNorm();
  return status;
}

std::optional<Outcome> CgSolver::DoStart(Eigen::VectorXd* x) {
  const Status status = Refresh(*x);
  if (status != Status::kOk) return Ended(status);
  return std::nullopt;
}

std::optional<Outcome> CgSolver::DoStep(Eigen::VectorXd* x) {
  // The recursive residual leaves the true one by rounding of its largest past size. After ten
  // digits it is computed afresh, and the directions start anew.
  constexpr double kRefreshAt = 1e-20;
  if (squared_norm_ <= kRefreshAt * refreshed_squared_) {
    const Status status = Refresh(*x);
    if (status != Status::kOk) return Ended(status);
  }
  if (squared_norm_ == 0.0) return Outcome{StopReason::kSolved, "the gradient is exactly zero"};
  const Status status = objective()->curve_view()->NormalProduct(direction_, &product_);
  if (status != Status::kOk) return Ended(status);
  const double curvature = direction_.dot(product_);
  if (!std::isfinite(curvature)) {
    return Outcome{StopReason::kNumericalFailure, "the normal equations show no curvature"};
  }
  // A direction that the data do not see: what is left of the residual is rounding.
  if (curvature <= 0.0) {
    return Outcome{StopReason::kStalled, "the direction is one that the data do not see"};
  }
  const double step = squared_norm_ / curvature;
  *x += step * direction_;
  residual_ -= step * product_;
  const double next = residual_.squaredNorm();
  direction_ = residual_ + (next / squared_norm_) * direction_;
  squared_norm_ = next;
  return std::nullopt;
}

std::vector<double> CgSolver::State() const {
  std::vector<double> state(residual_.data(), residual_.data() + residual_.size());
  state.insert(state.end(), direction_.data(), direction_.data() + direction_.size());
  state.push_back(refreshed_squared_);
  return state;
}

void CgSolver::Restore(const std::vector<double>& state) {
  const Eigen::Index size = residual_.size();
  residual_ = Eigen::Map<const Eigen::VectorXd>(state.data(), size);
  direction_ = Eigen::Map<const Eigen::VectorXd>(state.data() + size, size);
  refreshed_squared_ = state.back();
  squared_norm_ = residual_.squaredNorm();
}

}  // namespace batten
