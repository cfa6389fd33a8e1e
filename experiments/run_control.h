#ifndef BATTEN_EXPERIMENTS_RUN_CONTROL_H_
#define BATTEN_EXPERIMENTS_RUN_CONTROL_H_

#include <unordered_set>

#include "experiments/run.h"
#include "problems/evaluation_monitor.h"
#include "solvers/run_context.h"

namespace batten {

/// Wall and CPU time (of the whole process, so that a solver's own threads count), while it runs.
class Stopwatch {
 public:
  void Resume();
  void Pause();
  bool running() const { return running_; }
  double seconds() const { return seconds_; }  ///< Up to the last Pause.
  double cpu_seconds() const { return cpu_seconds_; }
  double SecondsNow() const;  ///< Also while running.

 private:
  bool running_ = false;
  double seconds_ = 0.0;
  double cpu_seconds_ = 0.0;
  double started_ = 0.0;
  double cpu_started_ = 0.0;
};

/// Stands between one solver and its objective: counts what is evaluated, keeps the clocks, which
/// stand still while it books or evaluates for the trace, and applies the stop rule.
class RunControl final : public EvaluationMonitor, public RunContext {
 public:
  /// `problem` and `result` must outlive this; `rule` is the solver's native one.
  RunControl(const Problem& problem, const RunSpec& spec, NativeRule rule, RunResult* result);

  /// Of the iterates, whatever `spec` says; >= 2.
  void KeepAtMost(std::size_t most) { most_iterates_ = most; }
  void Begin() { watch_.Resume(); }
  /// Stops the clocks and writes, beside the outcome that is in the result already, counts, times
  /// and the end's energy and gradient to the result.
  void Finish(const Eigen::VectorXd& x);

  bool Allow(Evaluation kind, const Eigen::VectorXd* x) override;
  Status Iterate(const Eigen::VectorXd& x) override;
  Status IterateOnTheWay(const Eigen::VectorXd& x) override;
  StopReason stop_reason() const override { return stop_reason_; }
  void Note(const std::string& name, const std::string& value) override;
  void OffTheClock(const std::function<void()>& work) override;
  std::uint64_t seed() const override { return spec_.seed; }
  int threads() const override { return spec_.threads; }

 private:
  Status BookAndCheck(const Eigen::VectorXd& x, bool may_be_the_end);
  void Book(const Eigen::VectorXd& x);
  void KeepIterate(const Eigen::VectorXd& x);
  StopReason CheckStop(const TraceRow& row);
  StopReason CheckConverged(const TraceRow& row, const Eigen::VectorXd& x);
  StopReason ConvergedReason(const TraceRow& row, const Eigen::VectorXd& x);
  bool IsDrawnBack(const TraceRow& row, const Eigen::VectorXd& x);
  StopReason CheckLimit() const;
  /// E, its gradient or, under nonlinear constraints, the Lagrangian's, whose norm is returned, and
  /// by how much these constraints are missed; not a number where one of them has no value.
  double Evaluate(const Eigen::VectorXd& x, double* energy, Eigen::VectorXd* gradient,
                  double* violation);
  void BookStart();
  void AddToStream(std::uint64_t point);
  double LineSearchFloor(const Eigen::VectorXd& x, double energy, const Eigen::VectorXd& gradient);
  double StepNorm(const Eigen::VectorXd& x) const;

  const Problem& problem_;
  const RunSpec& spec_;
  NativeRule rule_;
  RunResult* result_;
  Objective reporter_;  // its own, with no monitor: what it evaluates is not counted
  Stopwatch watch_;
  StopReason stop_reason_ = StopReason::kNotRun;
  std::unordered_set<std::uint64_t> points_;
  std::uint64_t last_point_ = 0;  // of the stream
  Eigen::VectorXd last_x_;
  TraceRow row_;
  bool is_held_ = true;  // nonlinear constraints, at the last iterate
  int iteration_ = -1;
  std::size_t most_iterates_ = 0;  // 0: all or none, as `spec_` says
};

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_RUN_CONTROL_H_
