#ifndef BATTEN_SOLVERS_CERES_ADAPTER_H_
#define BATTEN_SOLVERS_CERES_ADAPTER_H_

#include <ceres/iteration_callback.h>
#include <ceres/solver.h>

#include <limits>
#include <optional>
#include <string>

#include "solvers/solver.h"

namespace batten {

/// Shows run control each iterate of a Ceres minimiser: `state` is the vector that Ceres updates
/// before it calls back, in the free variables. A run may be several solves, one after the other.
class IterateBooker final : public ceres::IterationCallback {
 public:
  IterateBooker(RunContext* context, const Eigen::VectorXd* state)
      : context_(context), state_(state) {}

  /// Another solve goes on from `state`, the last booked point in other coordinates (a parameter in
  /// another period, or at an end instead of past it), whose iteration 0 is none of the run's.
  void GoOnFrom(const Eigen::VectorXd* state);

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override;

  /// After the solve: leaves in *x the point where Ceres ended, and books it where no callback has
  /// shown it (Ceres' line search hides its last point, a zero gradient at the start even the
  /// first). After a failure Ceres resets its state to the start; *x is the last booked point then.
  /// kOk: run control has no objection yet, so Ceres ended by itself.
  Status Finish(bool state_is_usable, Eigen::VectorXd* x);

 private:
  void Book();

  RunContext* context_;
  const Eigen::VectorXd* state_;
  Eigen::VectorXd booked_;
  Eigen::VectorXd known_;  ///< The same in the coordinates of the present solve.
  bool has_booked_ = false;
  Status status_ = Status::kOk;
};

/// Options common to ceres::Solver and ceres::GradientProblemSolver: no stop rule of Ceres' own but
/// the ones that cannot be switched off (a zero step, an equal cost, a zero gradient), no log.
template <typename Options>
void LeaveStoppingToRunControl(IterateBooker* booker, Options* options) {
  options->function_tolerance = 0.0;
  options->gradient_tolerance = 0.0;
  options->parameter_tolerance = 0.0;
  options->max_num_iterations = std::numeric_limits<int>::max() / 2;
  options->max_solver_time_in_seconds = 1e9;
  options->logging_type = ceres::SILENT;
  options->minimizer_progress_to_stdout = false;
  options->update_state_every_iteration = true;
  options->callbacks = {booker};
}

/// "Ceres: Parameter tolerance reached": the first clause of Ceres' own message.
std::string ShortReason(const std::string& message);

/// The whole run where no variable is free, which Ceres does not take; otherwise nothing.
std::optional<Outcome> RunWithoutVariables(const Objective& objective, RunContext* context,
                                           const Eigen::VectorXd& x);

/// Threads that Ceres takes without a warning: context->threads(), at most what the machine has.
int CeresThreads(const RunContext& context);

}  // namespace batten

#endif  // BATTEN_SOLVERS_CERES_ADAPTER_H_
