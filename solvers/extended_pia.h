#ifndef BATTEN_SOLVERS_EXTENDED_PIA_H_
#define BATTEN_SOLVERS_EXTENDED_PIA_H_

#include "solvers/stall_guard.h"
#include "solvers/stepper.h"

namespace batten {

/// Extended PIA: each data point belongs to the control point whose basis function is largest
/// there, which moves by the weighted mean of its group's residuals. Its limit is not the
/// least-squares curve. docs/solvers/extended_pia.md.
class ExtendedPiaSolver final : public FixedPoint {
 public:
  static SolverInfo ClassInfo();
  explicit ExtendedPiaSolver(const OptionValues& /*options*/) {}
  SolverInfo Info() const override { return ClassInfo(); }
  std::string WhyUnsupported(const Objective& objective) const override;
  Status Map(const Eigen::VectorXd& x, Eigen::VectorXd* g_of_x) override;
  std::vector<double> State() const override;
  void Restore(const std::vector<double>& state) override;

 private:
  std::optional<Outcome> DoStart(Eigen::VectorXd* x) override;
  std::optional<Outcome> Inspect(const Eigen::VectorXd& x, const Eigen::VectorXd& g_of_x) override;
  void Group();
  double SpectralRadius() const;

  struct Member {
    int control_point = 0;
    double share = 0.0;  // of its group's weights; they sum to 1
  };
  std::vector<Member> member_of_row_;
  Points residuals_;
  double first_move_ = -1.0;
  StallGuard guard_;
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_EXTENDED_PIA_H_
