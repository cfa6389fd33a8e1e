#include "solvers/banded_cholesky.h"

#include <cmath>
#include <limits>
#include <utility>

#include "splines/banded_cholesky.h"
#include "splines/nearest_solution.h"

namespace batten {

SolverInfo BandedCholeskySolver::ClassInfo() {
  SolverInfo info;
  info.name = "banded_cholesky";
  info.summary = "direct: normal equations in their band, the fastest";
  info.source = "de Boor, A Practical Guide to Splines, ch. XIV; Golub & Van Loan, sec. 4.3";
  info.needs = {"compiled rows"};
  info.supports = {"linear constraints", "weights", "any rank (through banded_qr)"};
  info.native_rule = NativeRule::kDirect;
  return info;
}

Outcome BandedCholeskySolver::SolveRows(const CurveView& view, const Problem& /*problem*/,
                                        RunContext* context, Eigen::VectorXd* x) const {
  NormalBand band = view.TakeNormalBand(context->threads());
  // Forward error of normal equations: at most about the condition number of N times eps (Higham,
  // Accuracy and Stability, sec. 20.4). 1e-8 of the data's size is what the solvers are to agree
  // to; where no digit is sure, the normal equations are not the way.
  constexpr double kDigitsLost = 1e-8;
  constexpr double kNoDigit = 0.1;
  // For the difference from the start: what the start has right loses no digits.
  LargeArray step(static_cast<std::size_t>(x->size()));
  band.NormalResidual(x->data(), step.data());
  BandedCholesky factor;
  std::string message;
  double condition = std::numeric_limits<double>::infinity();
  if (factor.Factor(std::move(band))) {
    condition = factor.ConditionEstimate();
    context->Note("condition of the normal equations", NumberText(condition));
  }
  const double error = condition * std::numeric_limits<double>::epsilon();
  if (error < kNoDigit) {
    factor.Solve(step.data(), view.dimension());
    *x += Eigen::Map<const Eigen::VectorXd>(step.data(), x->size());
    if (error > kDigitsLost) {
      message = "the normal equations have condition " + NumberText(condition) + ": only " +
                std::to_string(static_cast<int>(-std::log10(error))) +
                " digits are sure; banded_qr keeps more";
    }
  } else {
    const Points start = Eigen::Map<const Points>(x->data(), view.num_points(), view.dimension());
    const NearestSolution solution = SolveNearest(view.row_source(), start);
    if (!solution.found) {
      return {StopReason::kNumericalFailure, "the factorization has no finite answer"};
    }
    *x = Eigen::Map<const Eigen::VectorXd>(solution.control_points.data(), x->size());
    message = "the normal equations are singular to working precision; solved by " +
              solution.method +
              (solution.unique ? ""
                               : ", rank " + std::to_string(solution.rank) + " of " +
                                     std::to_string(view.num_points()) +
                                     ", nearest to the start; banded_qr names what lacks data");
  }
  if (!x->allFinite()) {
    return {StopReason::kNumericalFailure, "the factorization has no finite answer"};
  }
  return {StopReason::kSolved, message};
}

}  // namespace batten
