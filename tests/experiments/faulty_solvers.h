#ifndef BATTEN_TESTS_EXPERIMENTS_FAULTY_SOLVERS_H_
#define BATTEN_TESTS_EXPERIMENTS_FAULTY_SOLVERS_H_

#include <unistd.h>

#include <cmath>
#include <csignal>
#include <functional>
#include <string>
#include <vector>

#include "solvers/solver_registry.h"

namespace batten {

/// A solver that does what a function says.
class FaultySolver final : public Solver {
 public:
  using Method = std::function<Outcome(Objective*, RunContext*, Eigen::VectorXd*)>;
  FaultySolver(SolverInfo info, Method method)
      : info_(std::move(info)), method_(std::move(method)) {}
  SolverInfo Info() const override { return info_; }
  std::string WhyUnsupported(const Objective&) const override { return ""; }

 private:
  Outcome DoMinimize(Objective* objective, RunContext* context, Eigen::VectorXd* x) override {
    return method_(objective, context, x);
  }
  SolverInfo info_;
  Method method_;
};

/// Registered as long as it lives.
class RegisteredSolver {
 public:
  RegisteredSolver(const std::string& name, FaultySolver::Method method) : name_(name) {
    SolverInfo info;
    info.name = name;
    info.summary = "a fault on purpose";
    SolverRegistry::Global().Register(
        {info, [info, method](const OptionValues&, std::unique_ptr<Solver>) {
           return std::make_unique<FaultySolver>(info, method);
         }});
  }
  ~RegisteredSolver() { SolverRegistry::Global().Remove(name_); }
  RegisteredSolver(const RegisteredSolver&) = delete;
  RegisteredSolver& operator=(const RegisteredSolver&) = delete;

 private:
  std::string name_;
};

/// Steepest descent with a small step: something that works, told to stop or not.
inline Status DescendOnce(Objective* objective, Eigen::VectorXd* x) {
  constexpr double kStep = 1e-3;
  double energy = 0.0;
  Eigen::VectorXd gradient;
  const Status status = objective->EnergyAndGradient(*x, &energy, &gradient);
  if (status == Status::kOk) *x -= kStep * gradient;
  return status;
}

namespace faults {

inline Outcome Crash(Objective*, RunContext*, Eigen::VectorXd*) {
  std::signal(SIGSEGV, SIG_DFL);
  std::raise(SIGSEGV);
  return {};
}

inline Outcome Sleep(Objective*, RunContext*, Eigen::VectorXd*) {
  for (;;) pause();
}

inline Outcome HogMemory(Objective*, RunContext*, Eigen::VectorXd* x) {
  std::vector<char> hog(std::size_t{1} << 33, 'x');
  (*x)[0] = hog.back();
  return {};
}

inline Outcome Leave(Objective*, RunContext*, Eigen::VectorXd*) { _exit(0); }

/// Nothing but NaN after ten calls.
inline Outcome TurnNan(Objective* objective, RunContext* context, Eigen::VectorXd* x) {
  constexpr int kGoodCalls = 10;
  for (int call = 0; context->Iterate(*x) == Status::kOk; ++call) {
    DescendOnce(objective, x);
    if (call == kGoodCalls) x->setConstant(std::nan(""));
  }
  return {context->stop_reason(), ""};
}

/// Says that it is there when it has done one step.
inline Outcome Lie(Objective* objective, RunContext* context, Eigen::VectorXd* x) {
  context->Iterate(*x);
  DescendOnce(objective, x);
  context->Iterate(*x);
  return {StopReason::kGradientSmall, ""};
}

/// Asks for so many evaluations after it was told to stop.
template <int kMore>
Outcome GoOn(Objective* objective, RunContext* context, Eigen::VectorXd* x) {
  while (context->Iterate(*x) == Status::kOk) DescendOnce(objective, x);
  for (int call = 0; call < kMore; ++call) DescendOnce(objective, x);
  return {context->stop_reason(), ""};
}

inline Outcome Descend(Objective* objective, RunContext* context, Eigen::VectorXd* x) {
  while (context->Iterate(*x) == Status::kOk) DescendOnce(objective, x);
  return {context->stop_reason(), ""};
}

}  // namespace faults
}  // namespace batten

#endif  // BATTEN_TESTS_EXPERIMENTS_FAULTY_SOLVERS_H_
