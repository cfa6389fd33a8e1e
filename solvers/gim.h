#ifndef BATTEN_SOLVERS_GIM_H_
#define BATTEN_SOLVERS_GIM_H_

#include "solvers/paired_iteration.h"

namespace batten {

/// Geometric iteration method (progressive-iterative approximation): P_j += Q - C at the parameter
/// paired with j, less what further terms pull, as many control points as points.
/// docs/solvers/gim.md.
class GimSolver final : public PairedIteration {
 public:
  static SolverInfo ClassInfo();
  explicit GimSolver(const OptionValues& /*options*/) {}
  SolverInfo Info() const override { return ClassInfo(); }

 private:
  void TurnIntoMoves(Points* /*residuals*/) const override {}
  std::string MatrixName() const override { return "I - A"; }
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_GIM_H_
