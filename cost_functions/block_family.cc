#include "cost_functions/block_family.h"

#include <cmath>

namespace batten {

Status BlockFamily::Evaluate(const Eigen::VectorXd& x, int begin, int end, double* energy,
                             Eigen::VectorXd* gradient) const {
  if (!DoEvaluate(x, begin, end, energy, gradient)) return Status::kNonFinite;
  const bool finite = std::isfinite(*energy) && (gradient == nullptr || gradient->allFinite());
  return finite ? Status::kOk : Status::kNonFinite;
}

Status BlockFamily::Residuals(const Eigen::VectorXd& x, Eigen::VectorXd* residuals) const {
  return DoResiduals(x, residuals) && residuals->allFinite() ? Status::kOk : Status::kNonFinite;
}

Status BlockFamily::Jacobian(const Eigen::VectorXd& x, int first_row,
                             std::vector<Eigen::Triplet<double>>* entries) const {
  return DoJacobian(x, first_row, entries) ? Status::kOk : Status::kNonFinite;
}

Status BlockFamily::AddHessianTimes(const Eigen::VectorXd& x, const Eigen::VectorXd& direction,
                                    Eigen::VectorXd* product) const {
  return DoAddHessianTimes(x, direction, product) && product->allFinite() ? Status::kOk
                                                                          : Status::kNonFinite;
}

std::unique_ptr<ceres::LossFunction> BlockFamily::MakeCeresLoss() const {
  if (loss_ == nullptr && weight_ == 1.0) return nullptr;
  // The family's loss stays its own: Ceres gets a wrapper that borrows it (null: identity).
  return std::make_unique<ceres::ScaledLoss>(loss_.get(), weight_, ceres::DO_NOT_TAKE_OWNERSHIP);
}

}  // namespace batten
