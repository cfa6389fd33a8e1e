#ifndef BATTEN_SOLVERS_RUN_CONTEXT_H_
#define BATTEN_SOLVERS_RUN_CONTEXT_H_

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <string>

#include "cost_functions/block_family.h"

namespace batten {

enum class StopReason {
  kNotRun,
  kSolved,           // a direct method has given its answer
  kGradientSmall,    // |g| fell below its tolerance
  kStepSmall,        // the largest control-point step fell below its tolerance (native rule)
  kRoundingFloor,    // |g| is rounding noise
  kNativeStop,       // the method's library ended the run by a rule of its own
  kLineSearchEnded,  // no step along the last direction lowers E measurably
  kStalled,          // it goes on, but no longer comes nearer
  kDiverged,
  kInfeasible,  // constraints are missed, and no way is found to meet them
  kIterationLimit,
  kTimeLimit,
  kNumericalFailure,  // no finite number where one is needed
  kInterrupted,
};

/// "gradient_small", ...: the words used in files and tables.
const char* ToString(StopReason reason);
bool FromString(const std::string& text, StopReason* reason);
/// The run reached what was asked: kSolved, kGradientSmall, kStepSmall, kRoundingFloor.
bool IsSuccess(StopReason reason);

/// What a solver knows of the run around it.
class RunContext {
 public:
  virtual ~RunContext() = default;
  /// Books iteration 0 (the start, set-up done), then one after each iteration. Anything but kOk:
  /// return at once, with stop_reason().
  virtual Status Iterate(const Eigen::VectorXd& x) = 0;
  /// As Iterate, of a point that the solver goes on from whatever |g| is there, such as the best
  /// end so far of several starts: limits end the run, the rule that says it has converged does
  /// not.
  virtual Status IterateOnTheWay(const Eigen::VectorXd& x) { return Iterate(x); }
  /// Why Iterate, IterateOnTheWay or an evaluation said kStop.
  virtual StopReason stop_reason() const = 0;
  /// Something about the run that belongs beside its result: "spectral radius of I - A", "0.667".
  /// Of one name the last value is kept (of `options that ran`, all).
  virtual void Note(const std::string& name, const std::string& value) = 0;
  /// Runs `work`, which only a report wants, with the clocks stopped.
  virtual void OffTheClock(const std::function<void()>& work) = 0;
  virtual std::uint64_t seed() const = 0;
  virtual int threads() const = 0;
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_RUN_CONTEXT_H_
