#include "solvers/fairing_weights.h"

#include <cmath>
#include <utility>

#include "solvers/further_terms.h"

namespace batten {
namespace {

bool IsFairing(const Problem::TermInstance& term) { return IsNamed(term, "fairing"); }

NormalBand FairingBand(const Problem& problem, const NormalBand& all) {
  RowShape shape;
  shape.num_columns = all.size();
  shape.width = all.width();
  shape.dimension = all.dimension();
  shape.cyclic = all.cyclic();
  return BandOfTerms(problem, shape, IsFairing);
}

}  // namespace

std::string FairingWeights::WhyNot(const Objective& objective, const std::string& solver_name) {
  if (!objective.problem().elimination().trivial()) {
    return solver_name +
           " weighs fairing by control point without constraints; use fairing_factor=1";
  }
  for (const Problem::TermInstance& term : objective.problem().terms()) {
    if (IsFairing(term)) return "";
  }
  return solver_name +
         " weighs the term fairing by control point, and there is none; use fairing_factor=1";
}

FairingWeights::FairingWeights(const Objective& objective, const NormalBand& all,
                               std::vector<double> factors)
    : all_(all), factors_(std::move(factors)), fairing_(FairingBand(objective.problem(), all)) {}

std::vector<double> FairingWeights::RowSums() const {
  const int n = all_.size(), width = all_.width();
  std::vector<double> sums(static_cast<std::size_t>(n), 0.0);
  for (int j = 0; j < n; ++j) {
    for (int k = 0; k < width && (all_.cyclic() || j + k < n); ++k) {
      const auto place = static_cast<std::size_t>(j) * width + k;
      const double entry = all_.band()[place], fairing = fairing_.band()[place];
      const auto add = [&](int row) {
        const auto i = static_cast<std::size_t>(row);
        sums[i] += std::abs(entry + (factors_[i] - 1.0) * fairing);
      };
      add(j);
      if (k > 0) add((j + k) % n);
    }
  }
  return sums;
}

void FairingWeights::AddTo(const Eigen::VectorXd& control_points, Eigen::VectorXd* residual) {
  product_.resize(control_points.size());
  fairing_.Multiply(control_points.data(), product_.data());
  const int d = all_.dimension();
  for (Eigen::Index k = 0; k < residual->size(); ++k) {
    (*residual)[k] -= (factors_[static_cast<std::size_t>(k / d)] - 1.0) * product_[k];
  }
}

}  // namespace batten
