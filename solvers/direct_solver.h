#ifndef BATTEN_SOLVERS_DIRECT_SOLVER_H_
#define BATTEN_SOLVERS_DIRECT_SOLVER_H_

#include "solvers/solver.h"

namespace batten {

/// A solver of one linear least-squares problem in one go. What it does to the problem's own rows
/// it can do to others, as a method that solves a sequence of such problems asks of it (irls).
class DirectSolver : public Solver {
 public:
  std::string WhyUnsupported(const Objective& objective) const override {
    return WhyNoUnboundedCurveView(objective, Info().name);
  }
  /// Puts the minimiser of ||A P - Q|| nearest to *x there, where the minimum is not unique.
  /// `problem` is what the rows are of, for messages; `context` hears notes only.
  virtual Outcome SolveRows(const CurveView& view, const Problem& problem, RunContext* context,
                            Eigen::VectorXd* x) const = 0;

 private:
  Outcome DoMinimize(Objective* objective, RunContext* context, Eigen::VectorXd* x) final {
    if (context->Iterate(*x) != Status::kOk) return {context->stop_reason(), ""};
    Outcome outcome = SolveRows(*objective->curve_view(), objective->problem(), context, x);
    if (outcome.reason == StopReason::kSolved) context->Iterate(*x);
    return outcome;
  }
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_DIRECT_SOLVER_H_
