#ifndef BATTEN_SOLVERS_SPECTRAL_STEPPER_H_
#define BATTEN_SOLVERS_SPECTRAL_STEPPER_H_

#include "solvers/normal_spectrum.h"
#include "solvers/stall_guard.h"
#include "solvers/stepper.h"

namespace batten {

/// What iterations on N P = A'Q share whose weights are made from both ends of N's spectrum: the
/// estimate on the clock, the notes beside the result, the stall guard, the state.
class SpectralStepper : public Stepper {
 public:
  std::string WhyUnsupported(const Objective& objective) const override;
  std::vector<double> State() const final;
  void Restore(const std::vector<double>& state) final;

 protected:
  /// Chooses the weights. Returns the predicted factor of the error per iteration.
  virtual double ChooseWeights(const NormalSpectrum& spectrum) = 0;
  /// Makes memory_ for a start at x.
  virtual Status Begin(const Eigen::VectorXd& x) = 0;
  /// Moves *x only if all evaluations were allowed; leaves D = A'(Q - A P) of the point it looked
  /// at in residual().
  virtual Status Advance(Eigen::VectorXd* x) = 0;
  Status EvaluateResidual(const Eigen::VectorXd& x) {
    return objective()->curve_view()->NormalResidual(x, &residual_);
  }
  const Eigen::VectorXd& residual() const { return residual_; }
  int iteration() const { return iteration_; }

  Eigen::VectorXd memory_;  ///< What Advance needs beside x; may be empty.

 private:
  std::optional<Outcome> DoStart(Eigen::VectorXd* x) final;
  std::optional<Outcome> DoStep(Eigen::VectorXd* x) final;

  Eigen::VectorXd residual_;
  StallGuard guard_;
  int iteration_ = 0;
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_SPECTRAL_STEPPER_H_
