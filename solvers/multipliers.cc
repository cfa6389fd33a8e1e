#include "solvers/multipliers.h"

#include <algorithm>
#include <cmath>

namespace batten {

Status Multipliers::Make(Objective* objective, const Eigen::VectorXd& x, double weight,
                         Multipliers* made) {
  const Problem& problem = objective->problem();
  const ConstraintFamily& constraints = *problem.nonlinear_constraints();
  const Eigen::VectorXd all = objective->Expand(x);
  std::vector<Eigen::Triplet<double>> entries;
  if (constraints.Jacobian(all, 0, &entries) != Status::kOk) return Status::kNonFinite;
  SparseRows jacobian(constraints.size(), all.size());
  jacobian.setFromTriplets(entries.begin(), entries.end());
  made->weight_ = weight;
  made->shifts_.setZero(constraints.size());
  Eigen::VectorXd costs = Eigen::VectorXd::Zero(constraints.size());
  for (int k = 0; k < constraints.size(); ++k) {
    const Eigen::VectorXd normal =
        problem.elimination().Restrict(Eigen::VectorXd(jacobian.row(k).transpose()));
    const double squared = normal.squaredNorm();
    if (!(squared > 0.0)) continue;
    Eigen::VectorXd product;
    const Status status = objective->HessianTimes(x, normal, &product);
    if (status == Status::kStop) return status;
    if (status != Status::kOk) continue;
    costs[k] = 0.5 * normal.dot(product) / (squared * squared);
  }
  // Where E does not bend, or bends down, the others' measure has to do.
  constexpr double kLeast = 1e-6;
  const double largest = costs.maxCoeff();
  const double least = largest > 0.0 ? kLeast * largest : 1.0;
  made->scales_ = costs.cwiseMax(least).cwiseSqrt();
  return Status::kOk;
}

void Multipliers::Update(const ConstraintFamily& constraints, const Eigen::VectorXd& h) {
  for (int k = 0; k < constraints.size(); ++k) {
    shifts_[k] += scales_[k] * h[k];
    if (constraints.is_inequality(k)) shifts_[k] = std::min(shifts_[k], 0.0);
  }
}

void Multipliers::Raise(double factor) {
  weight_ *= factor;
  shifts_ /= factor;
}

Eigen::VectorXd Multipliers::values() const {
  return 2.0 * weight_ * scales_.cwiseProduct(shifts_);
}

}  // namespace batten
