#include "cost_functions/cost_function_family.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace batten {
namespace {

using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Hands the family's cost function to a ceres::Problem, which owns what it is given.
class SharedCostFunction final : public ceres::CostFunction {
 public:
  explicit SharedCostFunction(std::shared_ptr<const ceres::CostFunction> cost)
      : cost_(std::move(cost)) {
    set_num_residuals(cost_->num_residuals());
    *mutable_parameter_block_sizes() = cost_->parameter_block_sizes();
  }
  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override {
    return cost_->Evaluate(parameters, residuals, jacobians);
  }

 private:
  std::shared_ptr<const ceres::CostFunction> cost_;
};

}  // namespace

/// What one block evaluates to: jacobians[k] is row-major, num_residuals x size of parameter block
/// k.
struct CostFunctionFamily::Workspace {
  Eigen::VectorXd residuals;
  std::vector<RowMajorMatrix> jacobians;
  std::vector<const double*> parameters;
  std::vector<double*> jacobian_pointers;
};

void CostFunctionFamily::AddBlock(std::unique_ptr<ceres::CostFunction> cost,
                                  std::vector<int> offsets) {
  const std::vector<int>& sizes = cost->parameter_block_sizes();
  CHECK_GT(cost->num_residuals(), 0);
  CHECK_EQ(offsets.size(), sizes.size());
  if (!blocks_.empty()) CHECK_EQ(cost->num_residuals(), num_residuals());
  for (std::size_t k = 0; k < offsets.size(); ++k) {
    CHECK_GE(offsets[k], 0);
    for (std::size_t other = 0; other < k; ++other) {
      CHECK(offsets[k] + sizes[k] <= offsets[other] || offsets[other] + sizes[other] <= offsets[k])
          << "parameter blocks " << other << " and " << k << " overlap";
    }
  }
  blocks_.push_back({std::move(cost), std::move(offsets)});
}

int CostFunctionFamily::num_residuals() const {
  return blocks_.empty() ? 0 : blocks_.front().cost->num_residuals();
}

void CostFunctionFamily::Bind(const Eigen::VectorXd& /*x*/, int block, std::vector<int>* offsets,
                              std::vector<int>* sizes) const {
  const Block& bound = blocks_[static_cast<std::size_t>(block)];
  *offsets = bound.offsets;
  *sizes = bound.cost->parameter_block_sizes();
}

std::unique_ptr<ceres::CostFunction> CostFunctionFamily::MakeCeresCostFunction(
    const Eigen::VectorXd& /*x*/, int block) const {
  return std::make_unique<SharedCostFunction>(blocks_[static_cast<std::size_t>(block)].cost);
}

bool CostFunctionFamily::EvaluateBlock(const Eigen::VectorXd& x, int block, bool with_jacobian,
                                       Workspace* workspace) const {
  const auto& [cost, offsets] = blocks_[static_cast<std::size_t>(block)];
  const std::vector<int>& sizes = cost->parameter_block_sizes();
  workspace->residuals.resize(num_residuals());
  workspace->parameters.resize(sizes.size());
  workspace->jacobians.resize(sizes.size());
  workspace->jacobian_pointers.resize(sizes.size());
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    workspace->parameters[k] = x.data() + offsets[k];
    if (!with_jacobian) continue;
    workspace->jacobians[k].resize(num_residuals(), sizes[k]);
    workspace->jacobian_pointers[k] = workspace->jacobians[k].data();
  }
  return cost->Evaluate(workspace->parameters.data(), workspace->residuals.data(),
                        with_jacobian ? workspace->jacobian_pointers.data() : nullptr);
}

bool CostFunctionFamily::DoEvaluate(const Eigen::VectorXd& x, int begin, int end, double* energy,
                                    Eigen::VectorXd* gradient) const {
  Workspace workspace;
  for (int block = begin; block < end; ++block) {
    if (!EvaluateBlock(x, block, gradient != nullptr, &workspace)) return false;
    const double squared_norm = workspace.residuals.squaredNorm();
    // A loss with a bound, such as Tukey's, would make a number of it.
    if (!std::isfinite(squared_norm)) return false;
    double rho[3] = {squared_norm, 1.0, 0.0};
    if (loss() != nullptr) loss()->Evaluate(squared_norm, rho);
    *energy += weight() * rho[0];
    if (gradient == nullptr) continue;
    const std::vector<int>& offsets = blocks_[static_cast<std::size_t>(block)].offsets;
    for (std::size_t k = 0; k < offsets.size(); ++k) {
      const RowMajorMatrix& jacobian = workspace.jacobians[k];
      gradient->segment(offsets[k], jacobian.cols()) +=
          (2.0 * weight() * rho[1]) * (jacobian.transpose() * workspace.residuals);
    }
  }
  return true;
}

bool CostFunctionFamily::DoResiduals(const Eigen::VectorXd& x, Eigen::VectorXd* residuals) const {
  Workspace workspace;
  residuals->resize(static_cast<Eigen::Index>(size()) * num_residuals());
  for (int block = 0; block < size(); ++block) {
    if (!EvaluateBlock(x, block, false, &workspace)) return false;
    residuals->segment(static_cast<Eigen::Index>(block) * num_residuals(), num_residuals()) =
        workspace.residuals;
  }
  return true;
}

bool CostFunctionFamily::DoJacobian(const Eigen::VectorXd& x, int first_row,
                                    std::vector<Eigen::Triplet<double>>* entries) const {
  Workspace workspace;
  for (int block = 0; block < size(); ++block) {
    if (!EvaluateBlock(x, block, true, &workspace)) return false;
    const std::vector<int>& offsets = blocks_[static_cast<std::size_t>(block)].offsets;
    for (int row = 0; row < num_residuals(); ++row) {
      for (std::size_t k = 0; k < offsets.size(); ++k) {
        for (int c = 0; c < workspace.jacobians[k].cols(); ++c) {
          entries->emplace_back(first_row + block * num_residuals() + row, offsets[k] + c,
                                workspace.jacobians[k](row, c));
        }
      }
    }
  }
  return true;
}

double CostFunctionFamily::LargestOfBlocks(const Eigen::VectorXd& v) const {
  double largest = 0.0;
  for (const Block& block : blocks_) {
    const std::vector<int>& sizes = block.cost->parameter_block_sizes();
    for (std::size_t k = 0; k < sizes.size(); ++k) {
      const auto part = v.segment(block.offsets[k], sizes[k]);
      largest = std::max(largest, part.lpNorm<Eigen::Infinity>());
    }
  }
  return largest;
}

bool CostFunctionFamily::DoAddHessianTimes(const Eigen::VectorXd& x,
                                           const Eigen::VectorXd& direction,
                                           Eigen::VectorXd* product) const {
  const double length = LargestOfBlocks(direction);
  if (length == 0.0) return true;
  // The difference errs by h^2 / 6 times a third derivative of the gradient, by truncation, and by
  // eps / h times the gradient, by rounding: in balance at h = cbrt(eps) where all is of size 1.
  // Larger variables take a longer step in proportion; smaller ones do not, since they may have
  // come from zero.
  const double step =
      std::cbrt(std::numeric_limits<double>::epsilon()) * std::max(1.0, LargestOfBlocks(x));
  const Eigen::VectorXd unit_direction = direction / length;
  const Eigen::VectorXd after = x + step * unit_direction;
  const Eigen::VectorXd before = x - step * unit_direction;
  Eigen::VectorXd change = Eigen::VectorXd::Zero(x.size());
  Eigen::VectorXd gradient_before = Eigen::VectorXd::Zero(x.size());
  double energy = 0.0;
  if (!DoEvaluate(after, 0, size(), &energy, &change) ||
      !DoEvaluate(before, 0, size(), &energy, &gradient_before)) {
    return false;
  }
  *product += (change - gradient_before) * (length / (2.0 * step));
  return true;
}

}  // namespace batten
