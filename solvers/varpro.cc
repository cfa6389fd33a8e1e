#include "solvers/varpro.h"

namespace batten {

SolverInfo VarproSolver::ClassInfo() {
  SolverInfo info;
  info.name = "varpro";
  info.summary = "variable projection: control points always those that are best for t";
  info.source =
      "Golub & Pereyra, SINUM 10, 1973; Kaufman, BIT 15, 1975; Ruhe & Wedin, SIAM Rev. 22, 1980";
  info.needs = {"free parameters"};
  info.supports = {"linear constraints", "held parameters", "weights", "affine terms"};
  info.native_rule = NativeRule::kGradient;
  return info;
}

bool VarproSolver::Complete(Eigen::VectorXd* all) {
  const FreeView* view = objective()->free_view();
  if (view_ != view) linear_ = std::make_unique<FootModel>(*view, context()->threads());
  view_ = view;
  if (!linear_->Sum(*all, FootModelKind::kPoint, 0.0) || !linear_->FactorSingular(0.0)) {
    return false;
  }
  linear_->Solve(&step_);
  if (!step_.allFinite()) return false;
  all->segment(view->sites().control_point_offset, step_.size()) += step_;
  return true;
}

}  // namespace batten
