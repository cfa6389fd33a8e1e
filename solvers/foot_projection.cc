#include "solvers/foot_projection.h"

#include "splines/closest_point.h"

namespace batten {

Eigen::VectorXd AllWithParameters(const Objective& objective, const Eigen::VectorXd& x) {
  return objective.free_view()->WithParameters(objective.Expand(x));
}

Eigen::VectorXd FreeVariablesOf(const Objective& objective, const Eigen::VectorXd& all) {
  return objective.problem().elimination().FreeVariables(
      objective.free_view()->WithoutParameters(all));
}

void FreeVariablesOf(const Objective& objective, const Eigen::VectorXd& all,
                     Eigen::VectorXd* free) {
  const FreeView& view = *objective.free_view();
  const LinearElimination& elimination = objective.problem().elimination();
  if (elimination.trivial()) {
    *free = all.head(view.projected() ? view.sites().parameter_offset : all.size());
    return;
  }
  free->resize(static_cast<Eigen::Index>(elimination.free().size()));
  Eigen::Index k = 0;
  for (const int variable : elimination.free()) (*free)[k++] = all[variable];
}

Status ProjectParameters(Objective* objective, int threads, const Eigen::VectorXd& free,
                         Eigen::VectorXd* all) {
  if (!objective->Allow(Evaluation::kProjection, &free)) return Status::kStop;
  if (!all->allFinite()) return Status::kNonFinite;
  const FreeView& view = *objective->free_view();
  const FreeSites& sites = view.sites();
  const Points control_points = Eigen::Map<const Points>(
      all->data() + sites.control_point_offset, view.num_control_points(), view.dimension());
  const BsplineCurve curve(*sites.basis, control_points);
  Eigen::VectorXd feet = all->segment(sites.parameter_offset, view.num_points());
  ClosestPoint(curve).FindAll(sites.points, threads, &feet, nullptr);
  for (int i = 0; i < view.num_points(); ++i) {
    if (!view.is_held(i)) (*all)[sites.parameter_offset + i] = PastTheEnd(*sites.basis, feet[i]);
  }
  return Status::kOk;
}

}  // namespace batten
