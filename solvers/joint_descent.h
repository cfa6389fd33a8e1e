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
  std::vector<double> State() const override { return {damping_, growth_}; }
  void Restore(const std::vector<double>& state) override;

 protected:
  explicit JointDescent(FootModelKind kind) : kind_(kind) {}

 private:
  std::optional<Outcome> DoStart(Eigen::VectorXd* x) override;
  std::optional<Outcome> DoStep(Eigen::VectorXd* x) override;
  bool SumHere(FootModelKind kind);
  /// Leaves the point to be tried in next_; false where the model has no step.
  bool Propose();

  FootModelKind kind_;
  double damping_ = 0.0;
  double growth_ = 2.0;
  double decrease_ = 0.0;  // foretold
  Eigen::VectorXd all_;    // all variables at x
  Eigen::VectorXd next_;
  Eigen::VectorXd step_;
  std::unique_ptr<FootModel> here_;
  std::unique_ptr<FootModel> there_;
};

/// What a free problem's view is missing, as one sentence; empty: nothing.
std::string WhyNoFreeView(const Objective& objective, const std::string& name);

}  // namespace batten

#endif  // BATTEN_SOLVERS_JOINT_DESCENT_H_
