#ifndef BATTEN_COST_FUNCTIONS_FREE_FAMILY_H_
#define BATTEN_COST_FUNCTIONS_FREE_FAMILY_H_

#include <memory>
#include <utility>
#include <vector>

#include "cost_functions/block_family.h"
#include "cost_functions/free_ceres.h"
#include "cost_functions/free_kernel.h"
#include "cost_functions/loss.h"
#include "cost_functions/term.h"

namespace batten {

/// Spreads a residual functor (as FunctorFamily takes it) over data points whose parameters are
/// variables, x[parameter_offset + i]: block i belongs to data point i and is bound anew at every
/// evaluation to the span that t_i is in. t of periodic curves wraps; t of open ones is held at the
/// ends of the domain, where the energy does not change with it.
template <typename Functor>
class FreeFamily final : public BlockFamily {
 public:
  FreeFamily(const FitSetting& setting, Functor functor, double weight,
             std::shared_ptr<const ceres::LossFunction> loss)
      : BlockFamily(weight, std::move(loss)), setting_(setting), functor_(std::move(functor)) {
    const Sites& data = *setting.data;
    sites_.basis = setting.basis;
    sites_.dimension = setting.dimension;
    sites_.control_point_offset = setting.control_point_offset;
    sites_.parameter_offset = setting.parameter_offset;
    sites_.points.resize(data.size, setting.dimension);
    sites_.weights.resize(data.size);
    root_weights_.resize(data.size);
    for (int i = 0; i < data.size; ++i) {
      for (int c = 0; c < setting.dimension; ++c) {
        const double point = data.points[static_cast<std::ptrdiff_t>(i) * setting.dimension + c];
        sites_.points(i, c) = (point - setting.center[c]) * setting.scale;
      }
      const double site_weight = data.weights == nullptr ? 1.0 : data.weights[i];
      sites_.weights[i] = weight * site_weight;
      root_weights_[i] = std::sqrt(site_weight);
    }
    sites_.term_weight = weight;
    sites_.loss = weight > 0.0 ? this->loss() : nullptr;
    is_distance_ = IsDistance();
  }

  int size() const override { return static_cast<int>(root_weights_.size()); }
  int num_residuals() const override { return Functor::NumResiduals(setting_.dimension); }
  const FreeSites* free_sites() const override { return is_distance_ ? &sites_ : nullptr; }

  /// Control points of the window of spans around t, then t: what a Ceres cost function may touch
  /// before it is made anew.
  void Bind(const Eigen::VectorXd& x, int block, std::vector<int>* offsets,
            std::vector<int>* sizes) const override {
    const BsplineBasis& basis = *setting_.basis;
    const FreeWindow window(basis, Place(x, block).span);
    offsets->clear();
    for (int j = 0; j < window.num_blocks; ++j) {
      offsets->push_back(setting_.control_point_offset +
                         window.ControlPoint(basis, j) * setting_.dimension);
    }
    sizes->assign(offsets->size(), setting_.dimension);
    offsets->push_back(setting_.parameter_offset + block);
    sizes->push_back(1);
  }

  bool Window(const Eigen::VectorXd& x, int block, BindingWindow* window) const override {
    const BsplineBasis& basis = *setting_.basis;
    const CurvePlace place = Place(x, block);
    const FreeWindow spans(basis, place.span);
    window->variable = setting_.parameter_offset + block;
    window->place = place.t;
    window->low = spans.low(basis);
    window->high = spans.high(basis);
    window->low_is_end = !basis.periodic() && window->low <= basis.domain_begin();
    window->high_is_end = !basis.periodic() && window->high >= basis.domain_end();
    return true;
  }

  std::unique_ptr<ceres::CostFunction> MakeCeresCostFunction(const Eigen::VectorXd& x,
                                                             int block) const override {
    FreeFunctorAtSite<Functor> site = {functor_,
                                       setting_.basis,
                                       setting_.dimension,
                                       FreeWindow(*setting_.basis, Place(x, block).span),
                                       {},
                                       root_weights_[block]};
    std::copy_n(&sites_.points(block, 0), setting_.dimension, site.point);
    return MakeFreeCostFunction(site);
  }

  bool seats() const override { return !setting_.basis->periodic(); }
  void Seat(Eigen::VectorXd* x) const override {
    const BsplineBasis& basis = *setting_.basis;
    if (basis.periodic() || !x->allFinite()) return;
    WithKernel([&](const auto& kernel) {
      using Kernel = std::decay_t<decltype(kernel)>;
      double residuals[Kernel::kMaxResiduals];
      double jacobian[Kernel::kMaxResiduals * Kernel::kVariableStorage];
      for (int i = 0; i < size(); ++i) {
        double& t = (*x)[setting_.parameter_offset + i];
        const double end = basis.Wrap(t);
        if (t == end) continue;
        const double outside = PastTheEnd(basis, t);
        t = end;
        if (!kernel.ResidualsAndJacobian(BlockOf(kernel, *x, i), x->data(), residuals, jacobian)) {
          continue;
        }
        double slope = 0.0;
        for (int r = 0; r < num_residuals(); ++r) {
          slope += residuals[r] * jacobian[(r + 1) * kernel.num_variables() - 1];
        }
        const bool is_drawn_back = end == basis.domain_end() ? slope > 0.0 : slope < 0.0;
        if (!is_drawn_back) t = outside;
      }
    });
  }

  const Points& points() const { return sites_.points; }  ///< Q, scaled.
  /// Block `block` at x for a kernel's loops.
  template <typename Kernel>
  typename Kernel::Block BlockOf(const Kernel& kernel, const Eigen::VectorXd& x, int block) const {
    const int parameter = setting_.parameter_offset + block;
    return kernel.MakeBlock(x[parameter], &sites_.points(block, 0), root_weights_[block],
                            parameter);
  }

  /// Loss and its first two derivatives; the identity without one, and where there is no number.
  void Loss(double squared_norm, double* rho) const {
    rho[0] = squared_norm;
    rho[1] = 1.0;
    rho[2] = 0.0;
    if (loss() != nullptr && std::isfinite(squared_norm)) loss()->Evaluate(squared_norm, rho);
  }

 private:
  CurvePlace Place(const Eigen::VectorXd& x, int block) const {
    return PlaceOnCurve(*setting_.basis, x[setting_.parameter_offset + block]);
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

  bool DoEvaluate(const Eigen::VectorXd& x, int begin, int end, double* energy,
                  Eigen::VectorXd* gradient) const override {
    return WithKernel([&](const auto& kernel) {
      using Kernel = std::decay_t<decltype(kernel)>;
      double residuals[Kernel::kMaxResiduals];
      double jacobian[Kernel::kMaxResiduals * Kernel::kVariableStorage];
      const int k = num_residuals();
      for (int i = begin; i < end; ++i) {
        const auto block = BlockOf(kernel, x, i);
        const bool ok = gradient == nullptr
                            ? kernel.Residuals(block, x.data(), residuals)
                            : kernel.ResidualsAndJacobian(block, x.data(), residuals, jacobian);
        if (!ok) return false;
        double rho[3];
        Loss(Eigen::Map<const Eigen::VectorXd>(residuals, k).squaredNorm(), rho);
        *energy += weight() * rho[0];
        if (gradient == nullptr) continue;
        for (int v = 0; v < kernel.num_variables(); ++v) {
          double sum = 0.0;
          for (int r = 0; r < k; ++r)
            sum += jacobian[r * kernel.num_variables() + v] * residuals[r];
          (*gradient)[kernel.Offset(block, v)] += 2.0 * weight() * rho[1] * sum;
        }
      }
      return true;
    });
  }

  bool DoResiduals(const Eigen::VectorXd& x, Eigen::VectorXd* residuals) const override {
    residuals->resize(static_cast<Eigen::Index>(size()) * num_residuals());
    return WithKernel([&](const auto& kernel) {
      for (int i = 0; i < size(); ++i) {
        if (!kernel.Residuals(BlockOf(kernel, x, i), x.data(),
                              residuals->data() + i * num_residuals())) {
          return false;
        }
      }
      return true;
    });
  }

  bool DoJacobian(const Eigen::VectorXd& x, int first_row,
                  std::vector<Eigen::Triplet<double>>* entries) const override {
    return WithKernel([&](const auto& kernel) {
      using Kernel = std::decay_t<decltype(kernel)>;
      double residuals[Kernel::kMaxResiduals];
      double jacobian[Kernel::kMaxResiduals * Kernel::kVariableStorage];
      for (int i = 0; i < size(); ++i) {
        const auto block = BlockOf(kernel, x, i);
        if (!kernel.ResidualsAndJacobian(block, x.data(), residuals, jacobian)) return false;
        for (int r = 0; r < num_residuals(); ++r) {
          for (int v = 0; v < kernel.num_variables(); ++v) {
            entries->emplace_back(first_row + i * num_residuals() + r, kernel.Offset(block, v),
                                  jacobian[r * kernel.num_variables() + v]);
          }
        }
      }
      return true;
    });
  }

  bool DoAddHessianTimes(const Eigen::VectorXd& x, const Eigen::VectorXd& direction,
                         Eigen::VectorXd* product) const override {
    return WithKernel([&](const auto& kernel) {
      using Kernel = std::decay_t<decltype(kernel)>;
      typename Kernel::Second results[Kernel::kMaxResiduals];
      const int k = num_residuals();
      for (int i = 0; i < size(); ++i) {
        const auto block = BlockOf(kernel, x, i);
        for (int first = 0; first < kernel.num_variables(); first += Kernel::kChunk) {
          if (!kernel.SecondDerivatives(block, x.data(), direction.data(), first, results)) {
            return false;
          }
          double squared_norm = 0.0;
          double change = 0.0;
          for (int r = 0; r < k; ++r) {
            squared_norm += results[r].value.a * results[r].value.a;
            change += results[r].value.a * results[r].slope.a;
          }
          double rho[3];
          Loss(squared_norm, rho);
          const int count = std::min(Kernel::kChunk, kernel.num_variables() - first);
          for (int v = 0; v < count; ++v) {
            double sum = 0.0;
            for (int r = 0; r < k; ++r) {
              const double derivative = results[r].value.v[v];
              sum += 2.0 * rho[1] *
                         (derivative * results[r].slope.a +
                          results[r].value.a * results[r].slope.v[v]) +
                     4.0 * rho[2] * change * derivative * results[r].value.a;
            }
            (*product)[kernel.Offset(block, first + v)] += weight() * sum;
          }
        }
      }
      return true;
    });
  }

  /// Whether the residual really is root(w) (C(t) - Q), which FreeSites promises: tried against the
  /// functor's own residual and derivative at a few places.
  bool IsDistance() const {
    if (num_residuals() != setting_.dimension || size() == 0) return false;
    return WithKernel([&](const auto& kernel) {
      using Kernel = std::decay_t<decltype(kernel)>;
      const BsplineBasis& basis = *setting_.basis;
      const int d = setting_.dimension;
      Eigen::VectorXd x(setting_.control_point_offset + basis.num_control_points() * d);
      for (Eigen::Index k = 0; k < x.size(); ++k) x[k] = std::sin(1.0 + 0.7 * k);
      double residuals[Kernel::kMaxResiduals];
      double jacobian[Kernel::kMaxResiduals * Kernel::kVariableStorage];
      double values[2 * kMaxOrder];
      for (const double part : {0.1, 0.55, 0.93}) {
        const double t = basis.domain_begin() + part * basis.domain_length();
        const auto block = kernel.MakeBlock(t, &sites_.points(0, 0), 1.5, 0);
        if (!kernel.ResidualsAndJacobian(block, x.data(), residuals, jacobian)) return false;
        EvaluateBasisDerivatives(basis.degree(), basis.knots().data(), block.place.span, t, 1,
                                 values);
        constexpr double kRoundings = 1e-12;
        for (int c = 0; c < d; ++c) {
          double at = -sites_.points(0, c), slope = 0.0;
          for (int j = 0; j < kernel.order(); ++j) {
            at += values[j] * x[block.offset[j] + c];
            slope += values[kernel.order() + j] * x[block.offset[j] + c];
            const double entry = jacobian[c * kernel.num_variables() + j * d + c];
            if (std::abs(entry - 1.5 * values[j]) > kRoundings) return false;
          }
          const double by_t = jacobian[(c + 1) * kernel.num_variables() - 1];
          if (std::abs(residuals[c] - 1.5 * at) > kRoundings * (1.0 + std::abs(at))) return false;
          if (std::abs(by_t - 1.5 * slope) > kRoundings * (1.0 + std::abs(slope))) return false;
        }
      }
      return true;
    });
  }

  FitSetting setting_;
  Functor functor_;
  FreeSites sites_;
  Eigen::VectorXd root_weights_;  // of the sites, without the term's weight
  bool is_distance_ = false;
};

}  // namespace batten

#endif  // BATTEN_COST_FUNCTIONS_FREE_FAMILY_H_
