#ifndef BATTEN_SOLVERS_LBFGS_H_
#define BATTEN_SOLVERS_LBFGS_H_

#include "solvers/lbfgs_memory.h"
#include "solvers/line_search.h"
#include "solvers/stepper.h"

namespace batten {

/// Limited-memory BFGS for any objective. On a quadratic the line is known exactly from one
/// product, and differences of E come from it. docs/solvers/lbfgs.md.
class LbfgsSolver final : public Stepper {
 public:
  static SolverInfo ClassInfo();
  explicit LbfgsSolver(const OptionValues& options);
  SolverInfo Info() const override { return ClassInfo(); }
  std::string WhyUnsupported(const Objective& objective) const override;
  std::vector<double> State() const override;
  void Restore(const std::vector<double>& state) override;

 private:
  std::optional<Outcome> DoStart(Eigen::VectorXd* x) override;
  std::optional<Outcome> DoStep(Eigen::VectorXd* x) override;
  double FirstStep() const;
  double AimAlong(const Eigen::VectorXd& x);
  double AimDownhill(const Eigen::VectorXd& x, double part = 1.0);
  LineSearchEnd Search(const Eigen::VectorXd& x, double slope, LinePoint* found, Status* status);

  WolfeOptions wolfe_;
  LbfgsMemory memory_;
  double energy_ = 0.0;  // not used on quadratics
  double residual_size_ = 0.0;
  Eigen::VectorXd gradient_;
  Eigen::VectorXd direction_;
  Eigen::VectorXd product_;  // Hessian times direction, on quadratics
  Eigen::VectorXd next_x_;
  Eigen::VectorXd next_gradient_;
  double next_energy_ = 0.0;
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_LBFGS_H_
