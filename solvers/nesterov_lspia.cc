#include "solvers/nesterov_lspia.h"

#include <cmath>

namespace batten {

SolverInfo NesterovLspiaSolver::ClassInfo() {
  SolverInfo info;
  info.name = "nesterov_lspia";
  info.summary = "LSPIA with Nesterov's momentum (NmLSPIA)";
  info.source = "Liu, Wu, Li & Hu, CAGD 2024; Nesterov, Soviet Math. Dokl. 27, 1983";
  info.needs = {"compiled rows"};
  info.supports = {"linear constraints", "weights", "any rank (nearest to the start)"};
  info.native_rule = NativeRule::kStep;
  return info;
}

double NesterovLspiaSolver::ChooseWeights(const NormalSpectrum& spectrum) {
  const double s1 = std::sqrt(spectrum.largest);
  const double sn = std::sqrt(spectrum.smallest);
  // With a step of 1 / l1 every 0 <= e < 1 converges.
  step_ = 1.0 / spectrum.largest;
  momentum_ = (s1 - sn) / (s1 + sn);
  return std::sqrt(momentum_ * (1.0 - spectrum.smallest / spectrum.largest));
}

Status NesterovLspiaSolver::Begin(const Eigen::VectorXd& x) {
  memory_ = x;
  return Status::kOk;
}

Status NesterovLspiaSolver::Advance(Eigen::VectorXd* x) {
  ahead_ = *x + momentum_ * (*x - memory_);
  const Status status = EvaluateResidual(ahead_);
  if (status != Status::kOk) return status;
  memory_ = ahead_ + step_ * residual();
  x->swap(memory_);
  return Status::kOk;
}

}  // namespace batten
