#include "solvers/newton.h"

#include <limits>

#include "problems/fit_problem.h"
#include "solvers/exact_newton.h"
#include "splines/nearest_solution.h"

namespace batten {

SolverInfo NewtonSolver::ClassInfo() {
  SolverInfo info;
  info.name = "newton";
  info.summary = "Newton's method with the banded Hessian, free parameters eliminated";
  info.source = "Nocedal & Wright, Numerical Optimization, sec. 3.3; de Boor, ch. XIV";
  info.needs = {"a curve"};
  info.supports = {"linear constraints", "weights",  "any rank (nearest to the start)",
                   "free parameters",    "any term", "losses"};
  info.native_rule = NativeRule::kGradient;
  return info;
}

SolverInfo FreeNewton::Info() const { return NewtonSolver::ClassInfo(); }

std::string NewtonSolver::WhyUnsupported(const Objective& objective) const {
  const CurveFit* fit = objective.problem().curve_fit();
  if (fit != nullptr && (fit->has_free_parameters() || fit->is_projected())) {
    return WhyNoFreeView(objective, "newton");
  }
  return objective.is_quadratic() ? WhyNoBounds(objective, "newton")
                                  : ExactNewton::WhyNot(objective, "newton");
}

std::optional<Outcome> NewtonSolver::DoStart(Eigen::VectorXd* x) {
  guard_.Reset();
  other_.reset();
  if (objective()->free_view() != nullptr) {
    other_ = std::make_unique<FreeNewton>();
  } else if (!objective()->is_quadratic()) {
    other_ = std::make_unique<ExactNewton>();
  }
  if (other_ != nullptr) return other_->Start(objective(), context(), x);
  // Beyond this condition a step has no sure digit, and steps need not come nearer.
  constexpr double kLargestCondition = 0.1 / std::numeric_limits<double>::epsilon();
  singular_ = !factor_.Factor(objective()->curve_view()->normal_band()) ||
              factor_.ConditionEstimate() > kLargestCondition;
  return std::nullopt;
}

/// The step of least length among those that minimise.
std::optional<Outcome> NewtonSolver::SolveSingular(Eigen::VectorXd* x) {
  const CurveView& view = *objective()->curve_view();
  const Points start = Eigen::Map<const Points>(x->data(), view.num_points(), view.dimension());
  const NearestSolution solution = SolveNearest(view.row_source(), start);
  if (!solution.found || !solution.control_points.allFinite()) {
    return Outcome{StopReason::kNumericalFailure, "the Hessian's factorization has no answer"};
  }
  *x = Eigen::Map<const Eigen::VectorXd>(solution.control_points.data(), x->size());
  context()->Iterate(*x);
  return Outcome{StopReason::kSolved,
                 "the Hessian is singular to working precision; the step of least length, by " +
                     solution.method};
}

std::optional<Outcome> NewtonSolver::DoStep(Eigen::VectorXd* x) {
  if (other_ != nullptr) return other_->Step(x);
  Status status = objective()->curve_view()->NormalResidual(*x, &step_);
  if (status != Status::kOk) return Ended(status);
  if (singular_) return SolveSingular(x);
  const double residual = step_.norm();
  factor_.Solve(step_.data(), objective()->curve_view()->dimension());
  if (!step_.allFinite()) return Ended(Status::kNonFinite);
  *x += step_;
  return guard_.Check(residual);
}

std::vector<double> NewtonSolver::State() const {
  if (other_ != nullptr) return other_->State();
  std::vector<double> state;
  guard_.AppendTo(&state);
  return state;
}

void NewtonSolver::Restore(const std::vector<double>& state) {
  if (other_ != nullptr) return other_->Restore(state);
  guard_.Restore(state.data());
}

}  // namespace batten
