#include "solvers/local_pia.h"

#include "problems/fit_problem.h"

namespace batten {

SolverInfo LocalPiaSolver::ClassInfo() {
  SolverInfo info;
  info.name = "local_pia";
  info.summary = "geometric iteration of the points that are not met yet";
  info.source = "Lin, CAGD 27, 2010; Lin, CAGD 29, 2012";
  info.needs = {"compiled rows", FurtherTerms::kNeeds, "as many control points as points"};
  info.limit = kPairedLimit;
  info.native_rule = NativeRule::kStep;
  info.options = {OptionInfo::Real(
      "tolerance", 1e-12, 0.0, 1.0,
      "distance, in longest sides of the data's box, from which on a point counts as met, or with "
      "further terms a move as none")};
  return info;
}

LocalPiaSolver::LocalPiaSolver(const OptionValues& options)
    : relative_tolerance_(options.Real("tolerance")) {}

std::optional<Outcome> LocalPiaSolver::Prepare() {
  const CurveFit& fit = *objective()->problem().curve_fit();
  tolerance_ = relative_tolerance_ * fit.size() * fit.setting().scale;
  return std::nullopt;
}

void LocalPiaSolver::TurnIntoMoves(Points* residuals) const {
  for (Eigen::Index j = 0; j < residuals->rows(); ++j) {
    if (residuals->row(j).norm() <= tolerance_) residuals->row(j).setZero();
  }
}

std::optional<Outcome> LocalPiaSolver::Inspect(const Eigen::VectorXd& x,
                                               const Eigen::VectorXd& g_of_x) {
  if (x == g_of_x) {
    return Outcome{StopReason::kNativeStop,
                   has_further_terms() ? "no control point moves by more than the tolerance: it "
                                         "goes to its own limit, which is not the minimum of E"
                                       : "every point is met to the tolerance"};
  }
  return PairedIteration::Inspect(x, g_of_x);
}

}  // namespace batten
