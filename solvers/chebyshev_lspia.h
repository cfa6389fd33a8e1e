#ifndef BATTEN_SOLVERS_CHEBYSHEV_LSPIA_H_
#define BATTEN_SOLVERS_CHEBYSHEV_LSPIA_H_

#include "solvers/spectral_stepper.h"

namespace batten {

/// LSPIA with the steps of the Chebyshev iteration, in cycles (ALSPIA).
/// docs/solvers/chebyshev_lspia.md.
class ChebyshevLspiaSolver final : public SpectralStepper {
 public:
  static SolverInfo ClassInfo();
  explicit ChebyshevLspiaSolver(const OptionValues& options);
  SolverInfo Info() const override { return ClassInfo(); }

 private:
  double ChooseWeights(const NormalSpectrum& spectrum) override;
  Status Begin(const Eigen::VectorXd& x) override;
  Status Advance(Eigen::VectorXd* x) override;

  int cycle_;
  NormalSpectrum spectrum_;
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_CHEBYSHEV_LSPIA_H_
