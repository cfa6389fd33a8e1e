#include "solvers/banded_qr.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "problems/data_shortage.h"
#include "splines/banded_qr.h"
#include "splines/nearest_solution.h"

namespace batten {

namespace {

/// Data are of size 1 inside: where control points lie far off, differences of them lose digits.
std::string DigitsWarning(const Points& control_points) {
  const double largest = control_points.cwiseAbs().maxCoeff();
  constexpr double kFarOff = 1e4;
  if (!(largest > kFarOff)) return "";
  const double digits = -std::log10(std::numeric_limits<double>::epsilon() * largest);
  return "control points lie up to " + NumberText(std::exp2(std::round(std::log2(largest)))) +
         " times the size of the data away, where they are hardly determined: only " +
         std::to_string(std::max(0, static_cast<int>(digits))) + " digits of the curve are sure";
}

/// Roundings of the heaviest rows pull like data of their own: on what these rows leave free, such
/// as the line that a heavy fairing leads to, by their square beside the square of the lightest
/// diagonal entry of R.
std::string HeavyRowsWarning(double diagonal_ratio) {
  constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
  constexpr double kOutweighed = 32.0 * kEpsilon;
  if (!(diagonal_ratio < kOutweighed)) return "";
  const double digits = 2.0 * std::log10(diagonal_ratio / kEpsilon);
  return "the heaviest rows outweigh the lightest so far that their roundings count like data: "
         "about " +
         std::to_string(std::max(0, static_cast<int>(digits))) +
         " digits of what the heavy ones leave free are sure; use a smaller weight";
}

/// Which control points lack data, where a fit of data points alone does.
std::string ShortageText(const Problem& problem) {
  const CurveFit* fit = problem.curve_fit();
  if (fit == nullptr) return "";
  const std::string shortage = DataShortageText(*fit);
  return shortage.empty() ? "" : "fail: " + shortage;
}

}  // namespace

SolverInfo BandedQrSolver::ClassInfo() {
  SolverInfo info;
  info.name = "banded_qr";
  info.summary = "direct: QR of the rows in their band, the most accurate";
  info.source = "Golub & Van Loan, Matrix Computations, sec. 5.2; Cox, IMA J. Appl. Math. 1981";
  info.needs = {"compiled rows"};
  info.supports = {"linear constraints", "weights", "any rank"};
  info.native_rule = NativeRule::kDirect;
  return info;
}

Outcome BandedQrSolver::SolveRows(const CurveView& view, const Problem& problem,
                                  RunContext* context, Eigen::VectorXd* x) const {
  const Points start = Eigen::Map<const Points>(x->data(), view.num_points(), view.dimension());
  const NearestSolution solution = SolveNearest(view.row_source(), start);
  if (!solution.found) {
    return {StopReason::kNumericalFailure, "the factorization has no finite answer"};
  }
  *x = Eigen::Map<const Eigen::VectorXd>(solution.control_points.data(), x->size());
  context->Note("smallest over largest diagonal entry of R", NumberText(solution.diagonal_ratio));
  const std::string far_off = DigitsWarning(solution.control_points);
  if (solution.unique) {
    const std::string outweighed = HeavyRowsWarning(solution.diagonal_ratio);
    return {StopReason::kSolved,
            outweighed + (outweighed.empty() || far_off.empty() ? "" : "; ") + far_off};
  }
  context->OffTheClock([&] {
    const std::string shortage = ShortageText(problem);
    if (!shortage.empty()) context->Note("Schoenberg-Whitney conditions", shortage);
  });
  return {StopReason::kSolved, "the minimum is not unique: rank " + std::to_string(solution.rank) +
                                   " of " + std::to_string(view.num_points()) +
                                   "; this is the solution nearest to the start (" +
                                   solution.method + ")" + (far_off.empty() ? "" : "; " + far_off)};
}

}  // namespace batten
