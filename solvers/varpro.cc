#include "solvers/varpro.h"

#include <limits>

namespace batten {

SolverInfo VarproSolver::ClassInfo() {
  SolverInfo info;
  info.name = "varpro";
  info.summary = "variable projection: control points always those that are best for t";
  info.source =
      "Golub & Pereyra, SINUM 10, 1973; Kaufman, BIT 15, 1975; Ruhe & Wedin, SIAM Rev. 22, 1980";
  info.needs = {"free parameters"};
  info.supports = {"held parameters", "weights", "affine terms"};
  info.native_rule = NativeRule::kGradient;
  return info;
}

bool VarproSolver::Complete(Eigen::VectorXd* all) {
  const FreeView* view = objective()->free_view();
  if (view_ != view) linear_ = std::make_unique<FootModel>(*view, context()->threads());
  view_ = view;
  // Enough to make a singular system solvable: control points without data stay.
  constexpr double kDamping = 64.0 * std::numeric_limits<double>::epsilon();
  if (!linear_->Sum(*all, FootModelKind::kPoint, 0.0)) return false;
  for (double damping = kDamping; damping < 1.0; damping *= 100.0) {
    if (!linear_->Factor(damping)) continue;
    linear_->Solve(&step_);
    if (!step_.allFinite()) return false;
    all->segment(view->sites().control_point_offset, step_.size()) += step_;
    return true;
  }
  return false;
}

}  // namespace batten
