#include "solvers/foot_newton.h"

#include "solvers/foot_projection.h"

namespace batten {

SolverInfo FootNewtonSolver::ClassInfo() {
  SolverInfo info;
  info.name = "foot_newton";
  info.summary = "Newton's method, parameters eliminated, points looking for their feet";
  info.source = "Batten's own: docs/solvers/foot_newton.md";
  info.needs = {"free parameters"};
  info.supports = {"linear constraints", "held parameters", "weights", "losses",
                   "terms in control points"};
  info.native_rule = NativeRule::kGradient;
  info.options = {OptionInfo::Integer("longest_wait", 8, 0, 1'000'000,
                                      "steps after which feet are searched for no more")};
  return info;
}

std::optional<Outcome> FootNewtonSolver::DoStart(Eigen::VectorXd* x) {
  wait_ = 1;
  waited_ = 0;
  return JointDescent::DoStart(x);
}

Status FootNewtonSolver::CompleteStart(const Eigen::VectorXd& x, Eigen::VectorXd* all) {
  return ProjectParameters(objective(), context()->threads(), x, all);
}

Status FootNewtonSolver::Complete(Eigen::VectorXd* all) {
  constexpr int kSteps = 2;
  trial()->ImproveFeet(kSteps, all);
  return Status::kOk;
}

std::optional<Outcome> FootNewtonSolver::DoStep(Eigen::VectorXd* x) {
  Eigen::VectorXd next = *x;
  if (std::optional<Outcome> outcome = JointDescent::DoStep(&next)) return outcome;
  if (wait_ > longest_wait_ || ++waited_ < wait_) {
    x->swap(next);
    return std::nullopt;
  }
  waited_ = 0;
  const double before = energy();
  Eigen::VectorXd all = objective()->Expand(next);
  Status status = ProjectParameters(objective(), context()->threads(), next, &all);
  // Refused, the run ends at the iterate that was booked last.
  if (status == Status::kOk) status = GoTo(all, x);
  if (status != Status::kOk) return Ended(status);
  // It brings points that sit at a wrong minimum of their distance to the right one. Later it would
  // go on bringing a little on noisy data, for ever, as the curve folds up among the points.
  constexpr double kWorth = 0.01;
  wait_ = before - energy() > kWorth * before ? 1 : 2 * wait_;
  return std::nullopt;
}

std::vector<double> FootNewtonSolver::State() const {
  std::vector<double> state = JointDescent::State();
  state.push_back(wait_);
  state.push_back(waited_);
  return state;
}

void FootNewtonSolver::Restore(const std::vector<double>& state) {
  JointDescent::Restore(state);
  wait_ = static_cast<int>(state[state.size() - 2]);
  waited_ = static_cast<int>(state[state.size() - 1]);
}

}  // namespace batten
