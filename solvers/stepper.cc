#include "solvers/stepper.h"

namespace batten {

std::optional<Outcome> Stepper::Start(Objective* objective, RunContext* context,
                                      Eigen::VectorXd* x) {
  objective_ = objective;
  context_ = context;
  warning_.clear();
  return DoStart(x);
}

std::optional<Outcome> Stepper::Step(Eigen::VectorXd* x) {
  std::optional<Outcome> outcome = DoStep(x);
  if (outcome && outcome->reason == StopReason::kStalled && !warning_.empty()) {
    outcome->message += "; " + warning_;
  }
  return outcome;
}

Outcome Stepper::Ended(Status status) const {
  if (status == Status::kStop) {
    const StopReason reason = context_->stop_reason();
    return {reason, reason == StopReason::kDiverged ? warning_ : ""};
  }
  return {StopReason::kNumericalFailure, "the objective has no finite value there"};
}

void Stepper::WarnOfDivergence(const std::string& why) {
  warning_ = why;
  context_->Note("may not converge", why);
}

Outcome Stepper::DoMinimize(Objective* objective, RunContext* context, Eigen::VectorXd* x) {
  if (std::optional<Outcome> outcome = Start(objective, context, x)) return *outcome;
  Outcome outcome = Loop(x);
  AtEnd();
  return outcome;
}

Outcome Stepper::Loop(Eigen::VectorXd* x) {
  while (true) {
    const Status status = context_->Iterate(*x);
    if (status != Status::kOk) return Ended(status);
    if (std::optional<Outcome> outcome = Step(x)) return *outcome;
  }
}

std::optional<Outcome> FixedPoint::DoStep(Eigen::VectorXd* x) {
  const Status status = Map(*x, &next_);
  if (status != Status::kOk) return Ended(status);
  if (std::optional<Outcome> outcome = Inspect(*x, next_)) return outcome;
  x->swap(next_);
  return std::nullopt;
}

}  // namespace batten
