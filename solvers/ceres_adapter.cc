#include "solvers/ceres_adapter.h"

#include <algorithm>
#include <thread>

namespace batten {

void IterateBooker::Book() {
  booked_ = *state_;
  known_ = booked_;
  has_booked_ = true;
  status_ = context_->Iterate(booked_);
}

void IterateBooker::GoOnFrom(const Eigen::VectorXd* state) {
  state_ = state;
  known_ = *state;
}

ceres::CallbackReturnType IterateBooker::operator()(const ceres::IterationSummary& summary) {
  if (summary.iteration > 0 || !has_booked_) Book();
  return status_ == Status::kOk ? ceres::SOLVER_CONTINUE : ceres::SOLVER_ABORT;
}

Status IterateBooker::Finish(bool state_is_usable, Eigen::VectorXd* x) {
  if (status_ == Status::kOk && (!has_booked_ || (state_is_usable && *state_ != known_))) Book();
  *x = booked_;
  return status_;
}

std::string ShortReason(const std::string& message) {
  std::size_t length = message.size();
  for (const char* end : {". ", ", ", ": ", "\n"}) length = std::min(length, message.find(end));
  std::string clause = message.substr(0, length);
  if (!clause.empty() && clause.back() == '.') clause.pop_back();
  return "Ceres: " + clause;
}

std::optional<Outcome> RunWithoutVariables(const Objective& objective, RunContext* context,
                                           const Eigen::VectorXd& x) {
  if (objective.num_variables() > 0) return std::nullopt;
  if (context->Iterate(x) != Status::kOk) return Outcome{context->stop_reason(), ""};
  return Outcome{StopReason::kSolved, "no variable is free"};
}

int CeresThreads(const RunContext& context) {
  const auto available = static_cast<int>(std::thread::hardware_concurrency());
  return std::max(1, available > 0 ? std::min(context.threads(), available) : context.threads());
}

}  // namespace batten
