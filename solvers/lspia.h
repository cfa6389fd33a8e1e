#ifndef BATTEN_SOLVERS_LSPIA_H_
#define BATTEN_SOLVERS_LSPIA_H_

#include "solvers/stepper.h"

namespace batten {

/// Least-squares progressive-iterative approximation: P += mu A'(Q - A P), mu a number or a
/// diagonal. docs/solvers/lspia.md.
class LspiaSolver final : public FixedPoint {
 public:
  static SolverInfo ClassInfo();
  explicit LspiaSolver(const OptionValues& options);
  SolverInfo Info() const override { return ClassInfo(); }
  std::string WhyUnsupported(const Objective& objective) const override;
  Status Map(const Eigen::VectorXd& x, Eigen::VectorXd* g_of_x) override;
  std::vector<double> State() const override;
  void Restore(const std::vector<double>& state) override;

 private:
  std::optional<Outcome> DoStart(Eigen::VectorXd* x) override;
  std::optional<Outcome> Inspect(const Eigen::VectorXd& x, const Eigen::VectorXd& g_of_x) override;
  std::optional<Outcome> ChooseStep(const Eigen::VectorXd& x);

  std::string step_rule_;
  double relaxation_;
  Eigen::VectorXd step_;      // mu per variable
  Eigen::VectorXd residual_;  // A'(Q - A P) at the last point mapped
  Eigen::VectorXd last_move_;
  int alternations_ = 0;
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_LSPIA_H_
