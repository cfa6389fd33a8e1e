#ifndef BATTEN_SOLVERS_NESTEROV_LSPIA_H_
#define BATTEN_SOLVERS_NESTEROV_LSPIA_H_

#include "solvers/spectral_stepper.h"

namespace batten {

/// LSPIA from points ahead: Y = P + e (P - P-); P+ = Y + A'(Q - A Y) / l1.
/// docs/solvers/nesterov_lspia.md.
class NesterovLspiaSolver final : public SpectralStepper {
 public:
  static SolverInfo ClassInfo();
  explicit NesterovLspiaSolver(const OptionValues& /*options*/) {}
  SolverInfo Info() const override { return ClassInfo(); }

 private:
  double ChooseWeights(const NormalSpectrum& spectrum) override;
  Status Begin(const Eigen::VectorXd& x) override;
  Status Advance(Eigen::VectorXd* x) override;

  double step_ = 0.0;      // 1 / l1
  double momentum_ = 0.0;  // e
  Eigen::VectorXd ahead_;  // Y
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_NESTEROV_LSPIA_H_
