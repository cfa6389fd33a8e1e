#include "solvers/solver.h"

#include <glog/logging.h>

#include <stdexcept>

#include "problems/fit_problem.h"

namespace batten {
namespace {

struct ReasonWord {
  StopReason reason;
  const char* word;
};

constexpr ReasonWord kReasonWords[] = {
    {StopReason::kNotRun, "not_run"},
    {StopReason::kSolved, "solved"},
    {StopReason::kGradientSmall, "gradient_small"},
    {StopReason::kStepSmall, "step_small"},
    {StopReason::kRoundingFloor, "rounding_floor"},
    {StopReason::kNativeStop, "native_stop"},
    {StopReason::kLineSearchEnded, "line_search_ended"},
    {StopReason::kStalled, "stalled"},
    {StopReason::kDiverged, "diverged"},
    {StopReason::kInfeasible, "infeasible"},
    {StopReason::kIterationLimit, "iteration_limit"},
    {StopReason::kTimeLimit, "time_limit"},
    {StopReason::kNumericalFailure, "numerical_failure"},
    {StopReason::kInterrupted, "interrupted"},
};

}  // namespace

const char* ToString(StopReason reason) {
  for (const ReasonWord& row : kReasonWords) {
    if (row.reason == reason) return row.word;
  }
  return "unknown";
}

bool FromString(const std::string& text, StopReason* reason) {
  for (const ReasonWord& row : kReasonWords) {
    if (text == row.word) {
      *reason = row.reason;
      return true;
    }
  }
  return false;
}

bool IsSuccess(StopReason reason) {
  return reason == StopReason::kSolved || reason == StopReason::kGradientSmall ||
         reason == StopReason::kStepSmall || reason == StopReason::kRoundingFloor;
}

Outcome Solver::Minimize(Objective* objective, RunContext* context, Eigen::VectorXd* x) {
  const std::string why = WhyUnsupported(*objective);
  CHECK(why.empty()) << why;
  CHECK_EQ(x->size(), objective->num_variables());
  if (!x->allFinite()) return {StopReason::kNumericalFailure, "the start is not finite"};
  if (x->size() == 0) {
    if (context->Iterate(*x) != Status::kOk) return {context->stop_reason(), ""};
    return {StopReason::kSolved, "the constraints leave nothing free"};
  }
  Outcome outcome = DoMinimize(objective, context, x);
  StopReason known = outcome.reason;
  if (!FromString(ToString(outcome.reason), &known)) {
    throw std::logic_error("returns the reason " +
                           std::to_string(static_cast<int>(outcome.reason)) + ", which is none");
  }
  if (x->size() == objective->num_variables()) return outcome;
  throw std::logic_error("leaves " + std::to_string(x->size()) + " variables where there are " +
                         std::to_string(objective->num_variables()));
}

std::string WhyNoOrder(const Problem& problem, const std::string& solver_name) {
  for (const Problem::TermInstance& term : problem.terms()) {
    if (term.family->keeps_order()) {
      return solver_name + " does not keep the points in their order; use lbfgs";
    }
  }
  return "";
}

std::string WhyNoNonlinearConstraints(const Problem& problem, const std::string& solver_name) {
  if (problem.nonlinear_constraints() == nullptr) return "";
  return solver_name + " holds linear constraints only; use augmented_lagrangian:lbfgs";
}

std::string WhyNoCurveView(const Objective& objective, const std::string& solver_name) {
  if (objective.is_quadratic()) return "";
  std::string why = WhyNoNonlinearConstraints(objective.problem(), solver_name);
  if (!why.empty()) return why;
  if (!objective.options().compile) {
    return solver_name + " needs compiled rows, but compilation is off; use lbfgs";
  }
  for (const Problem::TermInstance& term : objective.problem().terms()) {
    if (term.family->rows() == nullptr) {
      return solver_name +
             " needs terms that are affine, alike for all coordinates and without loss; " +
             term.name + " is not; use lbfgs";
    }
  }
  return solver_name + " needs terms in control points alone; use lbfgs";
}

std::string WhyNoBounds(const Objective& objective, const std::string& solver_name) {
  if (objective.problem().has_bounds()) return solver_name + " ignores bounds; use ceres_lm";
  return WhyNoNonlinearConstraints(objective.problem(), solver_name);
}

std::string WhyNoUnboundedCurveView(const Objective& objective, const std::string& solver_name) {
  const std::string why = WhyNoCurveView(objective, solver_name);
  return why.empty() ? WhyNoBounds(objective, solver_name) : why;
}

}  // namespace batten
