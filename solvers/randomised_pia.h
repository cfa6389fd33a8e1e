#ifndef BATTEN_SOLVERS_RANDOMISED_PIA_H_
#define BATTEN_SOLVERS_RANDOMISED_PIA_H_

#include <optional>

#include "solvers/stepper.h"
#include "splines/band_sweep.h"

namespace batten {

/// Randomised block descent: P_U += A_U'(Q - A P) / mu_U for one block U of control points after
/// the other, drawn with a probability in proportion to ||A_U||^2. docs/solvers/randomised_pia.md.
class RandomisedPiaSolver final : public Stepper {
 public:
  static SolverInfo ClassInfo();
  explicit RandomisedPiaSolver(const OptionValues& options);
  SolverInfo Info() const override { return ClassInfo(); }
  std::string WhyUnsupported(const Objective& objective) const override;
  std::vector<double> State() const override;
  void Restore(const std::vector<double>& state) override;

 private:
  std::optional<Outcome> DoStart(Eigen::VectorXd* x) override;
  std::optional<Outcome> DoStep(Eigen::VectorXd* x) override;
  void MeasureBlocks(const NormalBand& band);
  int DrawBlock();
  void MoveBlock(int block, Eigen::VectorXd* x);
  std::optional<Outcome> CheckProgress(const Eigen::VectorXd& x);

  int block_size_;
  std::optional<BandSweep> sweep_;
  std::vector<double> cumulated_;  // of ||A_U||_F^2
  std::vector<double> steps_;      // 1 / mu_U
  std::vector<double> residual_;   // of the block being moved
  std::uint64_t draws_ = 0;
  // Stall guard: the point of some iterations ago, and A'(Q - A P) there.
  int since_ = 0;
  Eigen::VectorXd earlier_;
  Eigen::VectorXd earlier_residual_;
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_RANDOMISED_PIA_H_
