#ifndef BATTEN_SOLVERS_STEPPER_H_
#define BATTEN_SOLVERS_STEPPER_H_

#include <optional>

#include "solvers/solver.h"

namespace batten {

/// A solver that is a loop of like steps. Several can be stepped in turn (lockstep), and a run can
/// be left and taken up again from State().
class Stepper : public Solver {
 public:
  /// Set-up at *x, which it may move. An outcome ends the run here.
  std::optional<Outcome> Start(Objective* objective, RunContext* context, Eigen::VectorXd* x);
  /// One iteration from *x.
  std::optional<Outcome> Step(Eigen::VectorXd* x);
  /// What the next Step needs beside x, as numbers; set back by Restore after a Start at the same
  /// x, from which the next Step goes on, not from where Start has moved its copy.
  virtual std::vector<double> State() const { return {}; }
  virtual void Restore(const std::vector<double>& /*state*/) {}

 protected:
  /// Called once when the run is over: for notes that are known then.
  virtual void AtEnd() {}
  Objective* objective() const { return objective_; }
  RunContext* context() const { return context_; }
  /// The outcome that goes with an evaluation's status other than kOk.
  Outcome Ended(Status status) const;
  /// The condition for convergence does not hold: a note beside the result, and the reason given if
  /// it diverges or stalls.
  void WarnOfDivergence(const std::string& why);

 private:
  Outcome DoMinimize(Objective* objective, RunContext* context, Eigen::VectorXd* x) final;
  Outcome Loop(Eigen::VectorXd* x);
  virtual std::optional<Outcome> DoStart(Eigen::VectorXd* x) = 0;
  virtual std::optional<Outcome> DoStep(Eigen::VectorXd* x) = 0;

  Objective* objective_ = nullptr;
  RunContext* context_ = nullptr;
  std::string warning_;
};

/// A stepper that is a map x -> G(x), which an acceleration can call.
class FixedPoint : public Stepper {
 public:
  /// Writes G(x); x stays.
  virtual Status Map(const Eigen::VectorXd& x, Eigen::VectorXd* g_of_x) = 0;
  /// How many leading variables the map is one of; the others follow from them by Complete.
  virtual Eigen::Index num_mapped(const Eigen::VectorXd& x) const { return x.size(); }
  virtual Status Complete(Eigen::VectorXd* /*x*/) { return Status::kOk; }
  /// The leading variables of G(x), the others as they may be: for those that do not need them, or
  /// complete them later.
  virtual Status MapLeading(const Eigen::VectorXd& x, Eigen::VectorXd* g_of_x) {
    return Map(x, g_of_x);
  }

 protected:
  /// Called with x and G(x) after each plain step; an outcome ends the run (a stall guard).
  virtual std::optional<Outcome> Inspect(const Eigen::VectorXd& /*x*/,
                                         const Eigen::VectorXd& /*g_of_x*/) {
    return std::nullopt;
  }

 private:
  std::optional<Outcome> DoStep(Eigen::VectorXd* x) final;

  Eigen::VectorXd next_;
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_STEPPER_H_
