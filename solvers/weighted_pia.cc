#include "solvers/weighted_pia.h"

#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>

#include "solvers/lanczos.h"
#include "splines/dense_eigenvalues.h"

namespace batten {

SolverInfo WeightedPiaSolver::ClassInfo() {
  SolverInfo info;
  info.name = "weighted_pia";
  info.summary = "geometric iteration with the weight that makes it fastest";
  info.source = "Lu, CAGD 27, 2010";
  info.needs = {"compiled rows", FurtherTerms::kNeeds, "as many control points as points"};
  info.limit = kPairedLimit;
  info.native_rule = NativeRule::kStep;
  info.options = {OptionInfo::Real("w", 0.0, 0.0, 2.0,
                                   "weight; 0: 2 / (1 + smallest eigenvalue of A), the best one")};
  return info;
}

WeightedPiaSolver::WeightedPiaSolver(const OptionValues& options) : chosen_(options.Real("w")) {}

std::optional<Outcome> WeightedPiaSolver::Prepare() {
  if (chosen_ > 0.0) {
    weight_ = chosen_;
    return std::nullopt;
  }
  const double smallest = SmallestEigenvalue();
  // At 2 an eigenvalue of 1, which A has without further terms (its rows sum to 1), would turn
  // about for ever.
  constexpr double kLargestWeight = 1.999;
  weight_ = std::min(2.0 / (1.0 + smallest), kLargestWeight);
  context()->Note("smallest eigenvalue of A", NumberText(smallest));
  context()->Note("w", NumberText(weight_));
  return std::nullopt;
}

/// In size. A has positive eigenvalues where the basis is totally positive and points are paired in
/// order; 0 if A is singular to working precision.
double WeightedPiaSolver::SmallestEigenvalue() const {
  const Eigen::SparseMatrix<double> a = Matrix();
  constexpr int kLargestDense = 100;
  if (a.rows() <= kLargestDense) return EigenvalueSizes(Eigen::MatrixXd(a)).minCoeff();
  // Inverse iteration. Close eigenvalues leave its vector undecided but hardly its growth.
  Eigen::SparseLU<Eigen::SparseMatrix<double>> factor(a);
  if (factor.info() != Eigen::Success) return 0.0;
  Eigen::VectorXd v = RandomStart(a.rows(), context()->seed()).normalized();
  constexpr int kMaxIterations = 200;
  constexpr double kRelativeChange = 1e-6;
  double growth = 0.0;
  for (int k = 0; k < kMaxIterations; ++k) {
    v = factor.solve(v);
    const double norm = v.norm();
    if (!std::isfinite(norm)) return 0.0;
    v /= norm;
    const bool settled = std::abs(norm - growth) <= kRelativeChange * norm;
    growth = norm;
    if (settled) break;
  }
  return std::min(1.0, 1.0 / growth);
}

}  // namespace batten
