#include "solvers/dense_qr.h"

#include <Eigen/QR>

#include "problems/fit_problem.h"

namespace batten {

SolverInfo DenseQrSolver::ClassInfo() {
  SolverInfo info;
  info.name = "dense_qr";
  info.summary = "direct: the normal equations as a full matrix, by column-pivoted QR";
  info.source = "Luo 2003; Lan 2008; Golub & Van Loan, Matrix Computations, sec. 5.4.2";
  info.needs = {"compiled rows", "at most 10000 control points"};
  info.supports = {"linear constraints", "weights"};
  info.native_rule = NativeRule::kDirect;
  return info;
}

std::string DenseQrSolver::WhyUnsupported(const Objective& objective) const {
  std::string why = DirectSolver::WhyUnsupported(objective);
  if (!why.empty()) return why;
  // Also of the constraints' free points: those are fewer.
  const int dimension =
      objective.problem().curve_fit() == nullptr ? 1 : objective.problem().curve_fit()->dimension();
  if (objective.num_variables() / dimension <= kMostPoints) return "";
  return "dense_qr holds a full matrix, for at most " + std::to_string(kMostPoints) +
         " control points; use banded_qr";
}

Outcome DenseQrSolver::SolveRows(const CurveView& view, const Problem& /*problem*/,
                                 RunContext* context, Eigen::VectorXd* x) const {
  const NormalBand& band = view.normal_band();
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(band.ToDense());
  context->Note("rank of the normal equations", std::to_string(qr.rank()));
  Eigen::Map<Points> control_points(x->data(), view.num_points(), view.dimension());
  const Points solution = qr.solve(band.right_hand_side());
  if (!solution.allFinite()) {
    return {StopReason::kNumericalFailure, "the factorization has no finite answer"};
  }
  control_points = solution;
  if (qr.rank() == view.num_points()) return {StopReason::kSolved, ""};
  return {StopReason::kSolved,
          "the normal equations have rank " + std::to_string(qr.rank()) + " of " +
              std::to_string(view.num_points()) +
              " in working precision: a basic solution of them; banded_qr keeps more digits"};
}

}  // namespace batten
