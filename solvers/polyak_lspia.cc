#include "solvers/polyak_lspia.h"

#include <cmath>

namespace batten {

SolverInfo PolyakLspiaSolver::ClassInfo() {
  SolverInfo info;
  info.name = "polyak_lspia";
  info.summary = "LSPIA with Polyak's momentum (heavy ball, PmLSPIA)";
  info.source = "Liu, Wu, Li & Hu, CAGD 2024; Polyak, USSR Comp. Math. 4, 1964";
  info.needs = {"compiled rows"};
  info.supports = {"linear constraints", "weights", "any rank (nearest to the start)"};
  info.native_rule = NativeRule::kStep;
  return info;
}

double PolyakLspiaSolver::ChooseWeights(const NormalSpectrum& spectrum) {
  const double s1 = std::sqrt(spectrum.largest);
  const double sn = std::sqrt(spectrum.smallest);
  // Converges where 0 <= b < 1 and a < 2 (1 + b) / l1, here 4 (l1 + ln) / (l1 (s1 + sn)^2): for any
  // ln, as long as l1 is not below the largest eigenvalue.
  step_ = 4.0 / ((s1 + sn) * (s1 + sn));
  const double root = (s1 - sn) / (s1 + sn);
  momentum_ = root * root;
  return root;
}

Status PolyakLspiaSolver::Begin(const Eigen::VectorXd& x) {
  memory_ = x;
  return Status::kOk;
}

Status PolyakLspiaSolver::Advance(Eigen::VectorXd* x) {
  const Status status = EvaluateResidual(*x);
  if (status != Status::kOk) return status;
  // The next point takes the place of the one before last.
  memory_ = *x + step_ * residual() + momentum_ * (*x - memory_);
  x->swap(memory_);
  return Status::kOk;
}

}  // namespace batten
