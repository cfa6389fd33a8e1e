#ifndef BATTEN_SOLVERS_LOCAL_PIA_H_
#define BATTEN_SOLVERS_LOCAL_PIA_H_

#include "solvers/paired_iteration.h"

namespace batten {

/// Geometric iteration of the points that are not met yet: P_j += Q - C only where |Q - C| is above
/// a tolerance; with further terms where its move is. docs/solvers/local_pia.md.
class LocalPiaSolver final : public PairedIteration {
 public:
  static SolverInfo ClassInfo();
  explicit LocalPiaSolver(const OptionValues& options);
  SolverInfo Info() const override { return ClassInfo(); }

 private:
  std::optional<Outcome> Prepare() override;
  void TurnIntoMoves(Points* residuals) const override;
  void TurnIntoMovesLinearly(Points* /*residuals*/) const override {}
  std::string MatrixName() const override { return "I - A"; }
  std::optional<Outcome> Inspect(const Eigen::VectorXd& x, const Eigen::VectorXd& g_of_x) override;

  double relative_tolerance_;
  double tolerance_ = 0.0;  // as inside
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_LOCAL_PIA_H_
