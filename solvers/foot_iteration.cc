#include "solvers/foot_iteration.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solvers/foot_projection.h"
#include "solvers/joint_descent.h"

namespace batten {
namespace {

SolverInfo BaseInfo(const std::string& name, const std::string& summary,
                    const std::string& source) {
  SolverInfo info;
  info.name = name;
  info.summary = summary;
  info.source = source;
  info.needs = {"free parameters"};
  info.supports = {"linear constraints", "held parameters", "weights", "losses",
                   "terms in control points"};
  info.native_rule = NativeRule::kStep;
  return info;
}

std::vector<OptionInfo> ModelOptions(double damping) {
  return {OptionInfo::Real("damping", damping, 0.0, 1e6,
                           "added to the model's Hessian, in parts of its diagonal for PDM"),
          OptionInfo::Word("search", "halving", {"halving", "none"},
                           "whether a step is halved while E at the new feet rises")};
}

}  // namespace

std::string FootIteration::WhyUnsupported(const Objective& objective) const {
  return WhyNoFreeView(objective, Info().name);
}

std::optional<Outcome> FootIteration::DoStart(Eigen::VectorXd* x) {
  guard_.Reset();
  found_no_part_ = false;
  // Models for points lie above E and touch it, but for terms that are not affine.
  const bool is_bound = kind_ == FootModelKind::kPoint;
  searches_ = search_ || (is_bound && !objective()->free_view()->curved_terms().empty());
  model_ = std::make_unique<FootModel>(*objective()->free_view(), context()->threads());
  const Status status = Complete(x);
  if (status != Status::kOk) return Ended(status);
  return std::nullopt;
}

Eigen::Index FootIteration::num_mapped(const Eigen::VectorXd& /*x*/) const {
  return objective()->free_view()->num_free_coordinates();
}

Status FootIteration::Complete(Eigen::VectorXd* x) {
  // Projected parameters are no variables: the next step searches them.
  if (objective()->free_view()->projected()) return Status::kOk;
  Eigen::VectorXd all = objective()->Expand(*x);
  const Status status = ProjectParameters(objective(), context()->threads(), *x, &all);
  if (status == Status::kOk) *x = FreeVariablesOf(*objective(), all);
  return status;
}

bool FootIteration::MakeStep(const Eigen::VectorXd& all, Eigen::VectorXd* step) {
  if (!model_->Sum(all, kind_, 0.0)) return false;
  if (!model_->FactorSingular(damping_)) return false;
  model_->Solve(step);
  return step->allFinite();
}

Status FootIteration::Try(const Eigen::VectorXd& all, const Eigen::VectorXd& step, double part,
                          Eigen::VectorXd* g_of_x, double* energy) {
  *g_of_x = MovedBy(all, step, part);
  const Status status = Complete(g_of_x);
  return status == Status::kOk ? objective()->Energy(*g_of_x, energy) : status;
}

/// All variables at x, and the control points' step there.
Status FootIteration::FindStep(const Eigen::VectorXd& x, Eigen::VectorXd* all,
                               Eigen::VectorXd* step) {
  if (!objective()->Allow(Evaluation::kJacobian, &x)) return Status::kStop;
  *all = AllWithParameters(*objective(), x);
  if (objective()->free_view()->projected()) {
    const Status status = ProjectParameters(objective(), context()->threads(), x, all);
    if (status != Status::kOk) return status;
  }
  return MakeStep(*all, step) ? Status::kOk : Status::kNonFinite;
}

/// The free variables with the control points moved by a part of the step, parameters as they were.
Eigen::VectorXd FootIteration::MovedBy(const Eigen::VectorXd& all, const Eigen::VectorXd& step,
                                       double part) const {
  Eigen::VectorXd next = all;
  next.segment(objective()->free_view()->sites().control_point_offset, step.size()) += part * step;
  return FreeVariablesOf(*objective(), next);
}

Status FootIteration::MapLeading(const Eigen::VectorXd& x, Eigen::VectorXd* g_of_x) {
  if (searches_) return Map(x, g_of_x);
  Eigen::VectorXd all, step;
  const Status status = FindStep(x, &all, &step);
  if (status == Status::kOk) *g_of_x = MovedBy(all, step, 1.0);
  return status;
}

Status FootIteration::Map(const Eigen::VectorXd& x, Eigen::VectorXd* g_of_x) {
  if (!searches_) {
    const Status status = MapLeading(x, g_of_x);
    return status == Status::kOk ? Complete(g_of_x) : status;
  }
  Eigen::VectorXd all, step;
  Status status = FindStep(x, &all, &step);
  if (status != Status::kOk) return status;
  double energy = 0.0;
  status = Try(all, step, 1.0, g_of_x, &energy);
  const double before = model_->energy();
  const double noise = Objective::EnergyRoundingFloor(before, 2.0 * std::sqrt(model_->scale()));
  constexpr int kMostHalvings = 20;
  double part = 1.0;
  for (int k = 0; k < kMostHalvings; ++k) {
    if (status == Status::kStop || (status == Status::kOk && energy <= before + noise)) break;
    part *= 0.5;
    status = Try(all, step, part, g_of_x, &energy);
  }
  // As at corners and where the curve is a point, whose tangents are rounding.
  found_no_part_ = status == Status::kOk && !(energy <= before + noise);
  if (found_no_part_) *g_of_x = x;
  return status;
}

std::optional<Outcome> FootIteration::Inspect(const Eigen::VectorXd& /*x*/,
                                              const Eigen::VectorXd& /*g_of_x*/) {
  if (found_no_part_) {
    return Outcome{StopReason::kLineSearchEnded, "no part of the step lowers E measurably"};
  }
  // Not by the move, which can grow for thousands of iterations while points slide and E falls.
  return guard_.Check(model_->energy());
}

std::vector<double> FootIteration::State() const {
  std::vector<double> state;
  guard_.AppendTo(&state);
  return state;
}

void FootIteration::Restore(const std::vector<double>& state) { guard_.Restore(state.data()); }

SolverInfo GiSolver::ClassInfo() {
  return BaseInfo("gi", "foot points, then a step of the geometric iteration",
                  "Maekawa, Matsumoto & Namiki, CAD 39, 2007; Deng & Lin, CAD 47, 2014");
}

bool GiSolver::MakeStep(const Eigen::VectorXd& all, Eigen::VectorXd* step) {
  if (!model()->Sum(all, FootModelKind::kPoint, 0.0)) return false;
  const Eigen::VectorXd& gradient = model()->free_half_gradient();
  const std::vector<double> sums = model()->RowSums();
  Eigen::VectorXd free_step(gradient.size());
  for (Eigen::Index k = 0; k < free_step.size(); ++k) {
    // Control points without data stay.
    const double sum = sums[static_cast<std::size_t>(k)];
    free_step[k] = sum > 0.0 ? -gradient[k] / sum : 0.0;
  }
  model()->Expand(free_step, step);
  return true;
}

SolverInfo PdmSolver::ClassInfo() {
  return BaseInfo("pdm", "point distance minimisation: foot points, then linear least squares",
                  "Wang, Pottmann & Liu, ACM TOG 25, 2006; Hoschek, CAGD 5, 1988");
}

SolverInfo TdmSolver::ClassInfo() {
  SolverInfo info = BaseInfo("tdm", "tangent distance minimisation: distances from the tangents",
                             "Blake & Isard, Active Contours, 1998; Wang, Pottmann & Liu, 2006");
  info.options = ModelOptions(0.01);
  return info;
}

SolverInfo SdmSolver::ClassInfo() {
  SolverInfo info = BaseInfo("sdm", "squared distance minimisation: distances seen with curvature",
                             "Wang, Pottmann & Liu, ACM TOG 25, 2006");
  info.options = ModelOptions(1e-4);
  return info;
}

}  // namespace batten
