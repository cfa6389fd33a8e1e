#include "solvers/mlspia.h"

#include <cmath>

namespace batten {

SolverInfo MlspiaSolver::ClassInfo() {
  SolverInfo info;
  info.name = "mlspia";
  info.summary = "LSPIA with memory: weighted sums of all residuals move the control points";
  info.source = "Huang & Wang, CAGD 2020, arXiv:1908.06417";
  info.needs = {"compiled rows"};
  info.supports = {"linear constraints", "weights", "any rank (nearest to the start)"};
  info.native_rule = NativeRule::kStep;
  return info;
}

double MlspiaSolver::ChooseWeights(const NormalSpectrum& spectrum) {
  const double s1 = std::sqrt(spectrum.largest);
  // 1 / sn must be finite: ln is 0 only where the recursion saw nothing of the spectrum's low end.
  constexpr double kLeastRatio = 1e-8;
  const double sn = std::max(std::sqrt(spectrum.smallest), kLeastRatio * s1);
  weight_ = 4.0 * s1 * sn / ((s1 + sn) * (s1 + sn));
  step_ = 1.0 / (s1 * sn);
  return (s1 - sn) / (s1 + sn);
}

/// The weighted sums L have one row per data point, yet only M = A'L moves anything. With the
/// weights g = w the recursion of M needs the residual at the new point alone:
/// M+ = (1 - w) M - g v N M + w A'(Q - A P) = (1 - w) M + w A'(Q - A P+), P+ = P + v M.
Status MlspiaSolver::Begin(const Eigen::VectorXd& x) {
  const Status status = EvaluateResidual(x);
  if (status == Status::kOk) memory_ = weight_ * residual();
  return status;
}

Status MlspiaSolver::Advance(Eigen::VectorXd* x) {
  next_ = *x + step_ * memory_;
  const Status status = EvaluateResidual(next_);
  if (status != Status::kOk) return status;
  memory_ = (1.0 - weight_) * memory_ + weight_ * residual();
  x->swap(next_);
  return Status::kOk;
}

}  // namespace batten
