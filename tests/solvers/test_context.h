#ifndef BATTEN_TESTS_SOLVERS_TEST_CONTEXT_H_
#define BATTEN_TESTS_SOLVERS_TEST_CONTEXT_H_

#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "problems/objective.h"
#include "solvers/run_context.h"

namespace batten {

struct TestContextOptions {
  int max_iterations = 1000;
  double gradient_tolerance = 1e-10;  ///< Stops at |g| <= this * |g| of iteration 0; < 0: never.
  bool stop_at_rounding_floor = true;
  /// Energies after which the monitor says no.
  int max_energies = std::numeric_limits<int>::max();
  int threads = 1;
  std::uint64_t seed = 20240501;
  /// Diverged at |g| > this * |g| of iteration 0.
  double divergence = std::numeric_limits<double>::infinity();
};

/// Run control reduced to what a solver's test needs: the monitor of the solver's objective and its
/// context in one. Records every point that is evaluated and every iterate; judges by an objective
/// of its own, which nobody counts.
///
///   TestContext context(problem);
///   Objective objective(&problem, &context);
///   Eigen::VectorXd x = objective.start();
///   const Outcome outcome = solver.Minimize(&objective, &context, &x);
class TestContext final : public RunContext, public EvaluationMonitor {
 public:
  struct Evaluated {
    Evaluation kind;
    Eigen::VectorXd x;  ///< Empty where the evaluation belongs to no point.
  };

  explicit TestContext(const Problem& problem, TestContextOptions options = {})
      : options_(options), objective_(&problem, nullptr) {}

  bool Allow(Evaluation kind, const Eigen::VectorXd* x) override {
    if (kind == Evaluation::kEnergy && count(kind) >= options_.max_energies) {
      if (!stopped()) stop_reason_ = StopReason::kTimeLimit;
      ++refused_;
      return false;
    }
    ++counts_[kind];
    evaluations_.push_back({kind, x == nullptr ? Eigen::VectorXd() : *x});
    return true;
  }

  Status Iterate(const Eigen::VectorXd& x) override {
    iterates_.push_back(x);
    gradient_norms_.push_back(GradientNorm(x));
    if (!stopped()) stop_reason_ = Judge(x);
    return stopped() ? Status::kStop : Status::kOk;
  }

  /// Ends the run at limits only.
  Status IterateOnTheWay(const Eigen::VectorXd& x) override {
    iterates_.push_back(x);
    gradient_norms_.push_back(GradientNorm(x));
    const bool is_last = static_cast<int>(iterates_.size()) > options_.max_iterations;
    if (!stopped() && is_last) stop_reason_ = StopReason::kIterationLimit;
    return stopped() ? Status::kStop : Status::kOk;
  }

  StopReason stop_reason() const override { return stop_reason_; }
  void Note(const std::string& name, const std::string& value) override { notes_[name] = value; }
  void OffTheClock(const std::function<void()>& work) override { work(); }
  std::uint64_t seed() const override { return options_.seed; }
  int threads() const override { return options_.threads; }

  bool stopped() const { return stop_reason_ != StopReason::kNotRun; }
  const std::vector<Evaluated>& evaluations() const { return evaluations_; }
  const std::vector<Eigen::VectorXd>& iterates() const { return iterates_; }
  const std::vector<double>& gradient_norms() const { return gradient_norms_; }  ///< Of iterates().
  const std::map<std::string, std::string>& notes() const { return notes_; }
  int refused() const { return refused_; }  ///< Evaluations asked for after the monitor's no.
  int count(Evaluation kind) const {
    const auto found = counts_.find(kind);
    return found == counts_.end() ? 0 : found->second;
  }

  double Energy(const Eigen::VectorXd& x) {
    double energy = std::numeric_limits<double>::quiet_NaN();
    objective_.Energy(x, &energy);
    return energy;
  }
  double GradientNorm(const Eigen::VectorXd& x) {
    Eigen::VectorXd gradient;
    const Status status = objective_.Gradient(x, &gradient);
    return status == Status::kOk ? gradient.norm() : std::numeric_limits<double>::quiet_NaN();
  }

 private:
  StopReason Judge(const Eigen::VectorXd& x) const {
    const double norm = gradient_norms_.back();
    if (!std::isfinite(norm)) return StopReason::kNumericalFailure;
    if (norm > options_.divergence * gradient_norms_.front()) return StopReason::kDiverged;
    if (norm <= options_.gradient_tolerance * gradient_norms_.front()) {
      return StopReason::kGradientSmall;
    }
    if (options_.stop_at_rounding_floor && norm <= objective_.GradientRoundingFloor(x)) {
      return StopReason::kRoundingFloor;
    }
    const bool last = static_cast<int>(iterates_.size()) > options_.max_iterations;
    return last ? StopReason::kIterationLimit : StopReason::kNotRun;
  }

  TestContextOptions options_;
  Objective objective_;
  StopReason stop_reason_ = StopReason::kNotRun;
  std::map<Evaluation, int> counts_;
  int refused_ = 0;
  std::vector<Evaluated> evaluations_;
  std::vector<Eigen::VectorXd> iterates_;
  std::vector<double> gradient_norms_;
  std::map<std::string, std::string> notes_;
};

}  // namespace batten

#endif  // BATTEN_TESTS_SOLVERS_TEST_CONTEXT_H_
