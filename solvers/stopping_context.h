#ifndef BATTEN_SOLVERS_STOPPING_CONTEXT_H_
#define BATTEN_SOLVERS_STOPPING_CONTEXT_H_

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "problems/evaluation_monitor.h"
#include "solvers/run_context.h"

namespace batten {

/// A run that says stop at an iterate or at an evaluation, and keeps what is asked of it after
/// that: what solvers are judged by, in tests and by `batten check`.
class StoppingContext final : public RunContext, public EvaluationMonitor {
 public:
  static constexpr int kNever = std::numeric_limits<int>::max();

  /// Stops at the iterate number `last_iterate`, the start being 0, and at the evaluation that
  /// follows on `max_evaluations` of them.
  StoppingContext(int last_iterate, int max_evaluations, int threads = 1)
      : last_iterate_(last_iterate), max_evaluations_(max_evaluations), threads_(threads) {}

  bool Allow(Evaluation /*kind*/, const Eigen::VectorXd* /*x*/) override {
    if (stopped_) ++asked_after_stop_;
    if (num_evaluations_ >= max_evaluations_) stopped_ = true;
    if (!stopped_) ++num_evaluations_;
    return !stopped_;
  }
  Status Iterate(const Eigen::VectorXd& x) override {
    if (stopped_) ++booked_after_stop_;
    iterates_.push_back(x);
    if (static_cast<int>(iterates_.size()) > last_iterate_) stopped_ = true;
    return stopped_ ? Status::kStop : Status::kOk;
  }
  StopReason stop_reason() const override {
    return stopped_ ? StopReason::kInterrupted : StopReason::kNotRun;
  }
  void Note(const std::string& name, const std::string& value) override {
    notes_.emplace_back(name, value);
  }
  void OffTheClock(const std::function<void()>& work) override { work(); }
  std::uint64_t seed() const override { return 1; }
  int threads() const override { return threads_; }

  bool stopped() const { return stopped_; }
  int asked_after_stop() const { return asked_after_stop_; }
  int booked_after_stop() const { return booked_after_stop_; }
  int num_evaluations() const { return num_evaluations_; }
  const std::vector<Eigen::VectorXd>& iterates() const { return iterates_; }
  const std::vector<std::pair<std::string, std::string>>& notes() const { return notes_; }

 private:
  int last_iterate_;
  int max_evaluations_;
  int threads_;
  bool stopped_ = false;
  int num_evaluations_ = 0;
  int asked_after_stop_ = 0;
  int booked_after_stop_ = 0;
  std::vector<Eigen::VectorXd> iterates_;
  std::vector<std::pair<std::string, std::string>> notes_;
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_STOPPING_CONTEXT_H_
