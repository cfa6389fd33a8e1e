#ifndef BATTEN_SOLVERS_JOINT_DESCENT_H_
#define BATTEN_SOLVERS_JOINT_DESCENT_H_

#include <memory>

#include "solvers/foot_model.h"
#include "solvers/stepper.h"

namespace batten {

/// Damped steps in control points and parameters together, the parameters eliminated (FootModel):
/// a step is taken if it lowers E, and the damping follows how well the model foretold by how much
/// (Nielsen, Damping parameter in Marquardt's method, 1999).
class JointDescent : public Stepper {
 public:
  std::string WhyUnsupported(const Objective& objective) const override;
  std::vector<double> State() const override;
  void Restore(const std::vector<double>& state) override;

 protected:
  explicit JointDescent(FootModelKind kind) : kind_(kind) {}
  /// Called with control points and parameters after each move, which it may go on with, unless
  /// parameters are projected: they are searched then. kNonFinite: no finite number. It counts the
  /// passes over the data that it makes.
  virtual Status Complete(Eigen::VectorXd* /*all*/) { return Status::kOk; }
  /// Called instead at the start, which has the free variables x.
  virtual Status CompleteStart(const Eigen::VectorXd& /*x*/, Eigen::VectorXd* all) {
    return Complete(all);
  }
  std::optional<Outcome> DoStart(Eigen::VectorXd* x) override;
  std::optional<Outcome> DoStep(Eigen::VectorXd* x) override;
  FootModel* trial() { return there_.get(); }  ///< Free to be used in Complete.
  double energy() const { return here_->energy(); }
  /// Goes on from other control points and parameters, of which *x are the free variables.
  Status GoTo(const Eigen::VectorXd& all, Eigen::VectorXd* x);

 private:
  /// Counts a pass over the data that sums a model, and the products that go with it.
  bool AllowSum(FootModelKind kind, const Eigen::VectorXd& free);
  /// Sums the model at all_, a counted pass over the data.
  Status SumHere(FootModelKind kind);
  double ParameterDamping() const;
  double Noise(double energy) const;
  /// Leaves the point to be tried in next_; kNonFinite where the model has no step.
  Status Propose();
  bool Factor();
  void LeaveSaddle();
  /// Goes to next_, where there_ has been summed.
  void Take(Eigen::VectorXd* x);
  /// Before it is said that no step lowers E: steps of many lengths along -g. kOk: one does, and is
  /// taken.
  Status GoAlongGradient(Eigen::VectorXd* x);
  /// Searches projected parameters anew.
  Status Project(Eigen::VectorXd* all);

  FootModelKind kind_;
  double damping_ = 0.0;
  double growth_ = 2.0;
  double decrease_ = 0.0;  // foretold
  double fall_ = 1.0;      // of E by the last step, as a part of E
  bool at_saddle_ = false;
  Eigen::VectorXd all_;    // control points and parameters at x
  Eigen::VectorXd given_;  // those that the start was given, before it moved them
  Eigen::VectorXd next_;
  Eigen::VectorXd free_;  // variables at all_ or next_
  Eigen::VectorXd step_;
  Eigen::VectorXd away_;
  std::unique_ptr<FootModel> here_;
  std::unique_ptr<FootModel> there_;
};

/// What a free problem's view is missing, as one sentence; empty: nothing.
std::string WhyNoFreeView(const Objective& objective, const std::string& name);
/// As WhyNoFreeView for methods that move parameters by themselves: these must not be projected.
std::string WhyNoFreeParameters(const Objective& objective, const std::string& name);

}  // namespace batten

#endif  // BATTEN_SOLVERS_JOINT_DESCENT_H_
