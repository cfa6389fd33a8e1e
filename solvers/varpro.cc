#include "solvers/varpro.h"

#include "solvers/foot_projection.h"

namespace batten {

SolverInfo VarproSolver::ClassInfo() {
  SolverInfo info;
  info.name = "varpro";
  info.summary = "variable projection: control points always those that are best for t";
  info.source =
      "Golub & Pereyra, SINUM 10, 1973; Kaufman, BIT 15, 1975; Ruhe & Wedin, SIAM Rev. 22, 1980";
  info.needs = {"free parameters"};
  info.supports = {"linear constraints", "held parameters", "weights", "losses", "affine terms"};
  info.native_rule = NativeRule::kGradient;
  return info;
}

std::string VarproSolver::WhyUnsupported(const Objective& objective) const {
  std::string why = WhyNoFreeParameters(objective, Info().name);
  if (!why.empty() || objective.free_view()->curved_terms().empty()) return why;
  return Info().name +
         " solves for the control points, for which terms beside free_parameter must be affine and "
         "without loss; use newton";
}

Status VarproSolver::Complete(Eigen::VectorXd* all) {
  const FreeView* view = objective()->free_view();
  if (view_ != view) linear_ = std::make_unique<FootModel>(*view, context()->threads());
  view_ = view;
  const Eigen::VectorXd free = FreeVariablesOf(*objective(), *all);
  if (!objective()->Allow(Evaluation::kJacobian, &free)) return Status::kStop;
  if (!linear_->Sum(*all, FootModelKind::kPoint, 0.0) || !linear_->FactorSingular(0.0)) {
    return Status::kNonFinite;
  }
  linear_->Solve(&step_);
  if (!step_.allFinite()) return Status::kNonFinite;
  all->segment(view->sites().control_point_offset, step_.size()) += step_;
  // A parameter past an end, where its share of |g| is 0, may be drawn back by the new curve.
  Eigen::VectorXd seated = FreeVariablesOf(*objective(), *all);
  if (objective()->Seat(&seated)) *all = objective()->Expand(seated);
  return Status::kOk;
}

}  // namespace batten
