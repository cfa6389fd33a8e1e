#ifndef BATTEN_SOLVERS_WEIGHTED_PIA_H_
#define BATTEN_SOLVERS_WEIGHTED_PIA_H_

#include "solvers/paired_iteration.h"

namespace batten {

/// Geometric iteration with one weight: P += w (Q - A P). docs/solvers/weighted_pia.md.
class WeightedPiaSolver final : public PairedIteration {
 public:
  static SolverInfo ClassInfo();
  explicit WeightedPiaSolver(const OptionValues& options);
  SolverInfo Info() const override { return ClassInfo(); }

 private:
  std::optional<Outcome> Prepare() override;
  void TurnIntoMoves(Points* residuals) const override { *residuals *= weight_; }
  std::string MatrixName() const override { return "I - w A"; }
  double SmallestEigenvalue() const;

  double chosen_;        // by the user; 0: the best one
  double weight_ = 0.0;  // w
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_WEIGHTED_PIA_H_
