#ifndef BATTEN_SOLVERS_MLSPIA_H_
#define BATTEN_SOLVERS_MLSPIA_H_

#include "solvers/spectral_stepper.h"

namespace batten {

/// LSPIA with memory: P+ = P + v A'L, L a weighted sum of the residuals so far.
/// docs/solvers/mlspia.md.
class MlspiaSolver final : public SpectralStepper {
 public:
  static SolverInfo ClassInfo();
  explicit MlspiaSolver(const OptionValues& /*options*/) {}
  SolverInfo Info() const override { return ClassInfo(); }

 private:
  double ChooseWeights(const NormalSpectrum& spectrum) override;
  Status Begin(const Eigen::VectorXd& x) override;
  Status Advance(Eigen::VectorXd* x) override;

  double weight_ = 0.0;  // w, and g, which is the same
  double step_ = 0.0;    // v
  Eigen::VectorXd next_;
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_MLSPIA_H_
