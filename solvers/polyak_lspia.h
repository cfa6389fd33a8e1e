#ifndef BATTEN_SOLVERS_POLYAK_LSPIA_H_
#define BATTEN_SOLVERS_POLYAK_LSPIA_H_

#include "solvers/spectral_stepper.h"

namespace batten {

/// LSPIA with the heavy ball: P+ = P + a A'(Q - A P) + b (P - P-). docs/solvers/polyak_lspia.md.
class PolyakLspiaSolver final : public SpectralStepper {
 public:
  static SolverInfo ClassInfo();
  explicit PolyakLspiaSolver(const OptionValues& /*options*/) {}
  SolverInfo Info() const override { return ClassInfo(); }

 private:
  double ChooseWeights(const NormalSpectrum& spectrum) override;
  Status Begin(const Eigen::VectorXd& x) override;
  Status Advance(Eigen::VectorXd* x) override;

  double step_ = 0.0;      // a
  double momentum_ = 0.0;  // b
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_POLYAK_LSPIA_H_
