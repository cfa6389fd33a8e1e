#include "cost_functions/curve_condition.h"

#include <algorithm>
#include <utility>

#include "cost_functions/free_kernel.h"

namespace batten {
namespace {

using Kernel = FreeKernel<CurveConditionResidual, -1, -1>;

}  // namespace

CurveConditionFamily::CurveConditionFamily(const FitSetting& setting,
                                           std::vector<CurveCondition> conditions)
    : setting_(setting),
      conditions_(std::make_shared<const std::vector<CurveCondition>>(std::move(conditions))),
      scales_(Eigen::VectorXd::Ones(size())),
      shifts_(Eigen::VectorXd::Zero(size())) {}

CurveConditionFamily::CurveConditionFamily(const CurveConditionFamily& plain, double weight,
                                           const Eigen::VectorXd& scales,
                                           const Eigen::VectorXd& shifts)
    : ConstraintFamily(weight),
      setting_(plain.setting_),
      conditions_(plain.conditions_),
      scales_(scales),
      shifts_(shifts),
      is_penalty_(true) {}

std::unique_ptr<BlockFamily> CurveConditionFamily::MakePenalty(
    double weight, const Eigen::VectorXd& scales, const Eigen::VectorXd& shifts) const {
  // The constructor is private.
  return std::unique_ptr<BlockFamily>(new CurveConditionFamily(*this, weight, scales, shifts));
}

void CurveConditionFamily::Bind(const Eigen::VectorXd& /*x*/, int block, std::vector<int>* offsets,
                                std::vector<int>* sizes) const {
  const BsplineBasis& basis = *setting_.basis;
  const CurveCondition& bound = condition(block);
  const bool is_free = bound.parameter_variable >= 0;
  const int n = basis.num_control_points();
  const int first = is_free ? 0 : basis.FindSpan(bound.t) - basis.degree();
  const int count = is_free ? n : std::min(basis.order(), n);
  offsets->clear();
  for (int j = 0; j < count; ++j) {
    offsets->push_back(setting_.control_point_offset +
                       basis.ControlPointIndex(first + j) * setting_.dimension);
  }
  sizes->assign(offsets->size(), setting_.dimension);
  if (!is_free) return;
  offsets->push_back(bound.parameter_variable);
  sizes->push_back(1);
}

bool CurveConditionFamily::EvaluateBlock(const Eigen::VectorXd& x, int block, bool with_gradient,
                                         const Eigen::VectorXd* direction, Local* local) const {
  const CurveCondition& bound = condition(block);
  const bool is_free = bound.parameter_variable >= 0;
  const CurveConditionResidual functor = {&bound, scales_[block], shifts_[block],
                                          is_penalty_ && bound.is_inequality};
  const Kernel kernel(setting_, functor);
  const double no_point[kMaxDimension] = {};
  // A given t is one that does not move; its derivatives are 0, wherever they are said to stand.
  Kernel::Block site = kernel.MakeBlock(is_free ? x[bound.parameter_variable] : bound.t, no_point,
                                        1.0, std::max(bound.parameter_variable, 0));
  site.place.moves = site.place.moves && is_free;
  if (!with_gradient) return kernel.Residuals(site, x.data(), &local->residual);
  const int count = kernel.num_variables();
  local->places.resize(static_cast<std::size_t>(count));
  local->gradient.resize(local->places.size());
  local->product.resize(local->places.size());
  for (int v = 0; v < count; ++v) local->places[v] = kernel.Offset(site, v);
  if (direction == nullptr) {
    return kernel.ResidualsAndJacobian(site, x.data(), &local->residual, local->gradient.data());
  }
  Kernel::Second result;
  for (int first = 0; first < count; first += Kernel::kChunk) {
    if (!kernel.SecondDerivatives(site, x.data(), direction->data(), first, &result)) return false;
    local->residual = result.value.a;
    local->slope = result.slope.a;
    for (int k = 0; k < Kernel::kChunk && first + k < count; ++k) {
      local->gradient[first + k] = result.value.v[k];
      local->product[first + k] = result.slope.v[k];
    }
  }
  return true;
}

bool CurveConditionFamily::DoEvaluate(const Eigen::VectorXd& x, int begin, int end, double* energy,
                                      Eigen::VectorXd* gradient) const {
  Local local;
  for (int block = begin; block < end; ++block) {
    if (!EvaluateBlock(x, block, gradient != nullptr, nullptr, &local)) return false;
    *energy += weight() * local.residual * local.residual;
    if (gradient == nullptr) continue;
    const double factor = 2.0 * weight() * local.residual;
    for (std::size_t v = 0; v < local.places.size(); ++v) {
      (*gradient)[local.places[v]] += factor * local.gradient[v];
    }
  }
  return true;
}

bool CurveConditionFamily::DoResiduals(const Eigen::VectorXd& x, Eigen::VectorXd* residuals) const {
  residuals->resize(size());
  Local local;
  for (int block = 0; block < size(); ++block) {
    if (!EvaluateBlock(x, block, false, nullptr, &local)) return false;
    (*residuals)[block] = local.residual;
  }
  return true;
}

bool CurveConditionFamily::DoJacobian(const Eigen::VectorXd& x, int first_row,
                                      std::vector<Eigen::Triplet<double>>* entries) const {
  Local local;
  for (int block = 0; block < size(); ++block) {
    if (!EvaluateBlock(x, block, true, nullptr, &local)) return false;
    for (std::size_t v = 0; v < local.places.size(); ++v) {
      entries->emplace_back(first_row + block, local.places[v], local.gradient[v]);
    }
  }
  return true;
}

bool CurveConditionFamily::DoAddHessianTimes(const Eigen::VectorXd& x,
                                             const Eigen::VectorXd& direction,
                                             Eigen::VectorXd* product) const {
  Local local;
  for (int block = 0; block < size(); ++block) {
    if (!EvaluateBlock(x, block, true, &direction, &local)) return false;
    for (std::size_t v = 0; v < local.places.size(); ++v) {
      (*product)[local.places[v]] +=
          2.0 * weight() * (local.slope * local.gradient[v] + local.residual * local.product[v]);
    }
  }
  return true;
}

/// One block for Ceres, which hands over its parameter blocks in the order of Bind.
class CurveConditionFamily::Cost final : public ceres::CostFunction {
 public:
  Cost(const CurveConditionFamily* family, int block, int num_variables)
      : family_(family), block_(block), x_size_(num_variables) {
    std::vector<int> sizes;
    family->Bind(Eigen::VectorXd(), block, &offsets_, &sizes);
    set_num_residuals(1);
    mutable_parameter_block_sizes()->assign(sizes.begin(), sizes.end());
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const std::vector<int32_t>& sizes = parameter_block_sizes();
    Eigen::VectorXd x = Eigen::VectorXd::Zero(x_size_);
    for (std::size_t k = 0; k < sizes.size(); ++k) {
      std::copy_n(parameters[k], sizes[k], x.data() + offsets_[k]);
    }
    Local local;
    if (!family_->EvaluateBlock(x, block_, jacobians != nullptr, nullptr, &local)) return false;
    residuals[0] = local.residual;
    if (jacobians == nullptr) return true;
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(x_size_);
    for (std::size_t v = 0; v < local.places.size(); ++v) {
      gradient[local.places[v]] += local.gradient[v];
    }
    for (std::size_t k = 0; k < sizes.size(); ++k) {
      if (jacobians[k] != nullptr)
        std::copy_n(gradient.data() + offsets_[k], sizes[k], jacobians[k]);
    }
    return true;
  }

 private:
  const CurveConditionFamily* family_;
  int block_;
  Eigen::Index x_size_;
  std::vector<int> offsets_;
};

std::unique_ptr<ceres::CostFunction> CurveConditionFamily::MakeCeresCostFunction(
    const Eigen::VectorXd& x, int block) const {
  return std::make_unique<Cost>(this, block, static_cast<int>(x.size()));
}

}  // namespace batten
