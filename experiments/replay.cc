#include "experiments/replay.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "experiments/run_control.h"
#include "solvers/solver_registry.h"

namespace batten {
namespace {

bool SameBits(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return a.size() == b.size() &&
         std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<std::size_t>(a.size())) == 0;
}

/// Stands before run control and writes down what it lets through.
class Recorder final : public EvaluationMonitor {
 public:
  Recorder(EvaluationMonitor* control, Tape* tape) : control_(control), tape_(tape) {}

  bool Allow(Evaluation kind, const Eigen::VectorXd* x) override {
    if (!control_->Allow(kind, x)) return false;
    if (kind != Evaluation::kEnergy && kind != Evaluation::kGradient) {
      if (kind == Evaluation::kJacobian) not_held_ = "Jacobians";
      if (kind == Evaluation::kProduct) not_held_ = "Hessian products";
      if (kind == Evaluation::kProjection) not_held_ = "projections of parameters";
    } else if (x == nullptr) {
      not_held_ = "evaluations at no known point";
    } else if (tape_->points.empty() || !SameBits(tape_->points.back(), *x)) {
      tape_->points.push_back(*x);
    }
    // What a tape cannot hold ends in a refusal: the rest of the run would be work for nothing.
    return not_held_.empty();
  }
  const std::string& not_held() const { return not_held_; }

 private:
  EvaluationMonitor* control_;
  Tape* tape_;
  std::string not_held_;
};

}  // namespace

bool RecordTape(const Problem& problem, const NameSpec& solver_name, const RunSpec& spec,
                Tape* tape, std::string* error) {
  *tape = Tape();
  RunResult& result = tape->run;
  result.solver = solver_name;
  OptionValues options;
  const std::unique_ptr<Solver> solver =
      SolverRegistry::Global().Make(solver_name, &options, error);
  if (solver == nullptr) return false;
  result.options = options.ToText();
  RunControl control(problem, spec, solver->Info().native_rule, &result);
  Recorder recorder(&control, tape);
  Objective objective(&problem, &recorder, Objective::Options{spec.compile});
  result.skipped = solver->WhyUnsupported(objective);
  if (!result.skipped.empty()) {
    *error = solver_name.ToString() + " does not apply: " + result.skipped;
    return false;
  }
  Eigen::VectorXd x =
      spec.start.size() > 0 ? problem.elimination().FreeVariables(spec.start) : objective.start();
  control.Begin();
  result.outcome = solver->Minimize(&objective, &control, &x);
  control.Finish(x);
  std::string what = recorder.not_held();
  if (what.empty() && tape->points.empty()) what = "no evaluation of E or its gradient";
  if (what.empty()) return true;
  *error = solver_name.ToString() + " makes " + what +
           "; a tape holds evaluations of E and its gradient, as of ceres_lbfgs, and of lbfgs "
           "where nothing is "
           "compiled (--nocompile)";
  return false;
}

Parting FindParting(const Tape& first, const Tape& second, double tolerance) {
  Parting parting;
  parting.tolerance = tolerance;
  double size = 0.0;
  for (const Eigen::VectorXd& x : first.points) size = std::max(size, x.cwiseAbs().maxCoeff());
  if (!(size > 0.0)) size = 1.0;
  const std::size_t count = std::min(first.points.size(), second.points.size());
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::VectorXd& x = first.points[i];
    const Eigen::VectorXd& y = second.points[i];
    const Eigen::VectorXd step = x - y;
    const double difference = step.cwiseAbs().maxCoeff() / size;
    const bool part =
        tolerance == 0.0 ? !SameBits(x, y) : !step.allFinite() || difference > tolerance;
    if (!part) continue;
    parting.index = i;
    parting.difference = difference;
    return parting;
  }
  return parting;
}

ValueAtPoint EvaluateAt(const Problem& problem, const RunSpec& spec, const Eigen::VectorXd& x) {
  Objective objective(&problem, nullptr, Objective::Options{spec.compile});
  ValueAtPoint value;
  Eigen::VectorXd gradient;
  if (objective.EnergyAndGradient(x, &value.energy, &gradient) == Status::kOk) {
    value.gradient_norm = gradient.norm();
  }
  return value;
}

}  // namespace batten
