#ifndef BATTEN_COST_FUNCTIONS_FOOT_FAMILY_H_
#define BATTEN_COST_FUNCTIONS_FOOT_FAMILY_H_

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "cost_functions/foot_feet.h"
#include "cost_functions/free_family.h"

namespace batten {

/// Spreads a residual functor (as FreeFamily takes it) over data points whose parameters are their
/// foot points on the curve, so that E depends on the control points alone. Derivatives are total
/// ones: t follows the control points as the implicit function theorem says,
///   dt/dP = -(d^2 s / dt dP) / (d^2 s / dt^2),  s = |r|^2 / 2,
/// all of it from automatic differentiation; where t cannot follow (at the end of an open curve, at
/// a corner, near a centre of curvature) it stays.
template <typename Functor>
class FootFamily final : public BlockFamily {
 public:
  FootFamily(const FitSetting& setting, Functor functor, double weight,
             std::shared_ptr<const ceres::LossFunction> loss)
      : BlockFamily(weight, loss),
        setting_(WithParametersBehind(setting)),
        functor_(functor),
        inner_(setting_, std::move(functor), weight, std::move(loss)) {
    if (inner_.free_sites() != nullptr) {
      sites_ = std::make_unique<FreeSites>(*inner_.free_sites());
      sites_->projected = true;
    }
    along_t_.setZero(setting_.parameter_offset + size());
    along_t_.tail(size()).setOnes();
  }

  int size() const override { return inner_.size(); }
  int num_residuals() const override { return inner_.num_residuals(); }
  const FreeSites* free_sites() const override { return sites_.get(); }

  /// All control points: the foot may be anywhere.
  void Bind(const Eigen::VectorXd& /*x*/, int /*block*/, std::vector<int>* offsets,
            std::vector<int>* sizes) const override {
    const int n = setting_.basis->num_control_points();
    offsets->resize(static_cast<std::size_t>(n));
    for (int j = 0; j < n; ++j) {
      (*offsets)[static_cast<std::size_t>(j)] =
          setting_.control_point_offset + j * setting_.dimension;
    }
    sizes->assign(static_cast<std::size_t>(n), setting_.dimension);
  }

  std::unique_ptr<ceres::CostFunction> MakeCeresCostFunction(const Eigen::VectorXd& /*x*/,
                                                             int block) const override {
    return std::make_unique<Cost>(this, block);
  }

 private:
  static FitSetting WithParametersBehind(FitSetting setting) {
    setting.parameter_offset =
        setting.control_point_offset + setting.basis->num_control_points() * setting.dimension;
    return setting;
  }

  template <typename Body>
  auto WithKernel(Body body) const {
    const int p = setting_.basis->degree();
    const int d = setting_.dimension;
    if (setting_.use_static_sizes) {
      if (p == 3 && d == 2) return body(FreeKernel<Functor, 3, 2>(setting_, functor_));
      if (p == 3 && d == 3) return body(FreeKernel<Functor, 3, 3>(setting_, functor_));
    }
    return body(FreeKernel<Functor, -1, -1>(setting_, functor_));
  }

  /// Variables up to the last control point, then the feet on their curve. Kept for the next
  /// question at the same place; the answer does not depend on what was asked before.
  std::shared_ptr<const Eigen::VectorXd> WithFeet(const Eigen::VectorXd& x) const {
    const auto head = setting_.parameter_offset;
    const std::lock_guard<std::mutex> lock(mutex_);
    if (with_feet_ == nullptr || with_feet_->head(head) != x.head(head)) {
      auto made = std::make_shared<Eigen::VectorXd>(head + size());
      made->head(head) = x.head(head);
      FindFeet(*setting_.basis, setting_.dimension, setting_.control_point_offset, inner_.points(),
               made.get());
      with_feet_ = std::move(made);
    }
    return with_feet_;
  }

  /// One block with its foot: plain residuals; if `jacobian` is not null their total derivative,
  /// num_residuals x (p + 1) d row-major, and that of t, (p + 1) d.
  template <typename Kernel>
  bool EvaluateBlock(const Kernel& kernel, const typename Kernel::Block& block,
                     const Eigen::VectorXd& all, double* residuals, double* jacobian,
                     double* dt) const {
    if (jacobian == nullptr) return kernel.Residuals(block, all.data(), residuals);
    const int local = kernel.num_variables() - 1;  // t is behind them
    const int k = num_residuals();
    typename Kernel::Second results[Kernel::kMaxResiduals];
    double by_t[Kernel::kMaxResiduals];
    double squared_speed = 0.0, curvature = 0.0;
    for (int first = 0; first < kernel.num_variables(); first += Kernel::kChunk) {
      if (!kernel.SecondDerivatives(block, all.data(), along_t_.data(), first, results)) {
        return false;
      }
      const int count = std::min(Kernel::kChunk, local + 1 - first);
      for (int v = 0; v < count; ++v) {
        double mixed = 0.0;  // d^2 s / dt dv
        for (int r = 0; r < k; ++r) {
          mixed += results[r].slope.a * results[r].value.v[v] +
                   results[r].value.a * results[r].slope.v[v];
          if (first + v < local) jacobian[r * local + first + v] = results[r].value.v[v];
        }
        (first + v < local ? dt[first + v] : curvature) = mixed;
      }
    }
    for (int r = 0; r < k; ++r) {
      residuals[r] = results[r].value.a;
      by_t[r] = results[r].slope.a;
      squared_speed += by_t[r] * by_t[r];
    }
    double largest = 0.0;
    for (int v = 0; v < local; ++v) {
      largest = std::max(largest, std::abs(all[kernel.Offset(block, v)]));
    }
    const bool follows =
        FootFollows(*setting_.basis, block.place, squared_speed, curvature, largest);
    for (int v = 0; v < local; ++v) {
      dt[v] = follows ? -dt[v] / curvature : 0.0;
      for (int r = 0; r < k; ++r) jacobian[r * local + v] += by_t[r] * dt[v];
    }
    return true;
  }

  /// Calls body(kernel, i, residuals, jacobian, dt) for blocks begin..end-1 with their feet.
  template <typename Body>
  bool ForEachBlock(const Eigen::VectorXd& all, int begin, int end, bool derivatives,
                    Body body) const {
    return WithKernel([&](const auto& kernel) {
      using Kernel = std::decay_t<decltype(kernel)>;
      double residuals[Kernel::kMaxResiduals];
      double jacobian[Kernel::kMaxResiduals * Kernel::kVariableStorage];
      double dt[Kernel::kVariableStorage];
      for (int i = begin; i < end; ++i) {
        const auto block = inner_.BlockOf(kernel, all, i);
        if (!EvaluateBlock(kernel, block, all, residuals, derivatives ? jacobian : nullptr, dt)) {
          return false;
        }
        body([&](int v) { return kernel.Offset(block, v); }, i, residuals, jacobian, dt);
      }
      return true;
    });
  }

  int num_local() const { return setting_.basis->order() * setting_.dimension; }

  bool DoEvaluate(const Eigen::VectorXd& x, int begin, int end, double* energy,
                  Eigen::VectorXd* gradient) const override {
    const auto all = WithFeet(x);
    const int k = num_residuals();
    return ForEachBlock(*all, begin, end, gradient != nullptr,
                        [&](const auto& offset, int, const double* residuals,
                            const double* jacobian, const double*) {
                          double rho[3];
                          inner_.Loss(Eigen::Map<const Eigen::VectorXd>(residuals, k).squaredNorm(),
                                      rho);
                          *energy += weight() * rho[0];
                          if (gradient == nullptr) return;
                          for (int v = 0; v < num_local(); ++v) {
                            double sum = 0.0;
                            for (int r = 0; r < k; ++r)
                              sum += jacobian[r * num_local() + v] * residuals[r];
                            (*gradient)[offset(v)] += 2.0 * weight() * rho[1] * sum;
                          }
                        });
  }

  bool DoResiduals(const Eigen::VectorXd& x, Eigen::VectorXd* residuals) const override {
    const auto all = WithFeet(x);
    const int k = num_residuals();
    residuals->resize(static_cast<Eigen::Index>(size()) * k);
    return ForEachBlock(*all, 0, size(), false,
                        [&](const auto&, int i, const double* r, const double*, const double*) {
                          std::copy_n(r, k, residuals->data() + i * k);
                        });
  }

  bool DoJacobian(const Eigen::VectorXd& x, int first_row,
                  std::vector<Eigen::Triplet<double>>* entries) const override {
    const auto all = WithFeet(x);
    const int k = num_residuals();
    return ForEachBlock(
        *all, 0, size(), true,
        [&](const auto& offset, int i, const double*, const double* jacobian, const double*) {
          for (int r = 0; r < k; ++r) {
            for (int v = 0; v < num_local(); ++v) {
              entries->emplace_back(first_row + i * k + r, offset(v),
                                    jacobian[r * num_local() + v]);
            }
          }
        });
  }

  /// E_PP v + E_Pt (dt/dP v): t, which has come to d E / dt = 0, moves along.
  bool DoAddHessianTimes(const Eigen::VectorXd& x, const Eigen::VectorXd& direction,
                         Eigen::VectorXd* product) const override {
    const auto all = WithFeet(x);
    Eigen::VectorXd along = Eigen::VectorXd::Zero(all->size());
    along.head(setting_.parameter_offset) = direction.head(setting_.parameter_offset);
    const bool ok = ForEachBlock(
        *all, 0, size(), true,
        [&](const auto& offset, int i, const double*, const double*, const double* dt) {
          for (int v = 0; v < num_local(); ++v) {
            along[setting_.parameter_offset + i] += dt[v] * direction[offset(v)];
          }
        });
    if (!ok) return false;
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(all->size());
    if (inner_.AddHessianTimes(*all, along, &sum) != Status::kOk) return false;
    product->head(setting_.parameter_offset) += sum.head(setting_.parameter_offset);
    return true;
  }

  /// One block for Ceres. Feet are searched once for all blocks at one place.
  class Cost final : public ceres::CostFunction {
   public:
    Cost(const FootFamily* family, int block) : family_(family), block_(block) {
      set_num_residuals(family->num_residuals());
      mutable_parameter_block_sizes()->assign(
          static_cast<std::size_t>(family->setting_.basis->num_control_points()),
          family->setting_.dimension);
    }
    bool Evaluate(double const* const* parameters, double* residuals,
                  double** jacobians) const override {
      const FitSetting& setting = family_->setting_;
      const int d = setting.dimension;
      Eigen::VectorXd x = Eigen::VectorXd::Zero(setting.parameter_offset);
      for (std::size_t j = 0; j < parameter_block_sizes().size(); ++j) {
        std::copy_n(parameters[j], d, x.data() + setting.control_point_offset + j * d);
      }
      const auto all = family_->WithFeet(x);
      const int k = num_residuals();
      if (jacobians != nullptr) {
        for (std::size_t j = 0; j < parameter_block_sizes().size(); ++j) {
          if (jacobians[j] != nullptr) std::fill_n(jacobians[j], k * d, 0.0);
        }
      }
      return family_->ForEachBlock(*all, block_, block_ + 1, jacobians != nullptr,
                                   [&](const auto& offset, int, const double* values,
                                       const double* jacobian, const double*) {
                                     std::copy_n(values, k, residuals);
                                     if (jacobians == nullptr) return;
                                     const int local = family_->num_local();
                                     for (int v = 0; v < local; ++v) {
                                       const int place = offset(v) - setting.control_point_offset;
                                       double* const entry = jacobians[place / d];
                                       if (entry == nullptr) continue;
                                       for (int r = 0; r < k; ++r)
                                         entry[r * d + place % d] += jacobian[r * local + v];
                                     }
                                   });
    }

   private:
    const FootFamily* family_;
    int block_;
  };

  FitSetting setting_;  // t behind the control points, wherever the problem has them
  Functor functor_;
  FreeFamily<Functor> inner_;
  std::unique_ptr<FreeSites> sites_;
  Eigen::VectorXd along_t_;
  mutable std::mutex mutex_;
  mutable std::shared_ptr<const Eigen::VectorXd> with_feet_;
};

}  // namespace batten

#endif  // BATTEN_COST_FUNCTIONS_FOOT_FAMILY_H_
