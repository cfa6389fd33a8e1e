#ifndef BATTEN_COST_FUNCTIONS_FUNCTOR_KERNEL_H_
#define BATTEN_COST_FUNCTIONS_FUNCTOR_KERNEL_H_

#include <ceres/jet.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "cost_functions/block_family.h"
#include "cost_functions/directional_dual.h"
#include "cost_functions/fit_setting.h"
#include "cost_functions/functor_rows.h"
#include "cost_functions/site.h"
#include "splines/basis_functions.h"

namespace batten {

/// The loops over the sites of one residual functor, for one pair of sizes; P and D are -1 where
/// degree and dimension are known at run time only.
template <typename Functor, int P, int D>
class FunctorKernel {
 public:
  static constexpr bool kStatic = P >= 0;
  static constexpr int kOrderStorage = kStatic ? P + 1 : kMaxOrder;
  static constexpr int kDimensionStorage = kStatic ? D : kMaxDimension;
  static constexpr int kVariableStorage = kOrderStorage * kDimensionStorage;
  /// Variables differentiated in one call of the functor.
  static constexpr int kChunk = kStatic ? kVariableStorage : 8;
  static constexpr int kMaxResiduals = 16;
  using NumberSite = Site<double, P, D, Functor::kDerivatives>;
  using Jet = ceres::Jet<double, kChunk>;

  FunctorKernel(const FitSetting& setting, const Sites& sites, const Functor& functor)
      : setting_(setting), sites_(sites), basis_(*setting.basis), functor_(functor) {}

  int order() const { return kStatic ? P + 1 : basis_.order(); }
  int dimension() const { return kStatic ? D : setting_.dimension; }
  int num_variables() const { return order() * dimension(); }
  int num_residuals() const { return Functor::NumResiduals(dimension()); }

  /// Where the span's control points stand in x.
  struct Window {
    int offset[kOrderStorage];
  };
  Window MakeWindow(int span) const {
    Window window;
    for (int j = 0; j < order(); ++j) {
      window.offset[j] = setting_.control_point_offset +
                         basis_.ControlPointIndex(span - basis_.degree() + j) * dimension();
    }
    return window;
  }

  NumberSite MakeSite(int site_index, int span) const {
    NumberSite site(basis_.degree(), dimension());
    const int item = sites_.item(site_index);
    EvaluateBasisDerivatives<P>(basis_.degree(), basis_.knots().data(), span,
                                sites_.parameters[item], Functor::kDerivatives,
                                site.mutable_basis());
    for (int c = 0; c < dimension(); ++c) {
      site.mutable_point()[c] =
          sites_.points == nullptr
              ? 0.0
              : (sites_.points[static_cast<std::ptrdiff_t>(item) * dimension() + c] -
                 setting_.Origin(sites_, c)) *
                    setting_.scale;
    }
    site.set_root_weight(sites_.weights == nullptr ? 1.0 : std::sqrt(sites_.weights[item]));
    return site;
  }

  /// Calls body(site, site_index, window) for sites begin..end-1, enter(window) and leave(window)
  /// around the sites of each span.
  template <typename Enter, typename Body, typename Leave>
  bool ForEachSite(int begin, int end, Enter enter, Body body, Leave leave) const {
    auto group = std::upper_bound(sites_.groups.begin(), sites_.groups.end(), begin,
                                  [](int site, const Sites::Group& g) { return site < g.end; });
    for (; group != sites_.groups.end() && group->begin < end; ++group) {
      const Window window = MakeWindow(group->span);
      enter(window);
      const int last = std::min(end, group->end);
      for (int s = std::max(begin, group->begin); s < last; ++s) {
        if (!body(MakeSite(s, group->span), s, window)) return false;
      }
      leave(window);
    }
    return true;
  }

  bool PlainResiduals(const NumberSite& site, const Window& window, const double* x,
                      double* residuals) const {
    const double* points[kOrderStorage] = {};
    for (int j = 0; j < order(); ++j) points[j] = x + window.offset[j];
    return functor_(site, points, residuals);
  }

  /// jacobian: num_residuals x num_variables, row-major; variables j * dimension + c of the window.
  bool ResidualsAndJacobian(const NumberSite& site, const Window& window, const double* x,
                            double* residuals, double* jacobian) const {
    Jet variables[kVariableStorage];
    const Jet* points[kOrderStorage];
    Jet results[kMaxResiduals];
    for (int j = 0; j < order(); ++j) points[j] = variables + j * dimension();
    for (int first = 0; first < num_variables(); first += kChunk) {
      for (int j = 0; j < order(); ++j) {
        for (int c = 0; c < dimension(); ++c) {
          const int v = j * dimension() + c;
          variables[v] = Jet(x[window.offset[j] + c]);
          if (v >= first && v < first + kChunk) variables[v].v[v - first] = 1.0;
        }
      }
      if (!functor_(site, points, results)) return false;
      const int count = std::min(kChunk, num_variables() - first);
      for (int r = 0; r < num_residuals(); ++r) {
        residuals[r] = results[r].a;
        for (int k = 0; k < count; ++k) jacobian[r * num_variables() + first + k] = results[r].v[k];
      }
    }
    return true;
  }

  bool Energy(const double* x, int begin, int end, double weight, const ceres::LossFunction* loss,
              double* energy) const {
    double residuals[kMaxResiduals];
    return ForEachSite(
        begin, end, [](const Window&) {},
        [&](const NumberSite& site, int, const Window& window) {
          if (!PlainResiduals(site, window, x, residuals)) return false;
          double slope = 0.0;
          *energy += weight * Loss(loss, SquaredNorm(residuals), &slope);
          return true;
        },
        [](const Window&) {});
  }

  bool EnergyAndGradient(const double* x, int begin, int end, double weight,
                         const ceres::LossFunction* loss, double* energy, double* gradient) const {
    double residuals[kMaxResiduals];
    double jacobian[kMaxResiduals * kVariableStorage];
    double local[kVariableStorage];
    // With fewer control points than the order a window meets one twice: sums start at zero then.
    // Otherwise they go on from the gradient's entries, so that every entry is summed block by
    // block, in the order in which ceres::Problem does it.
    const bool repeated = basis_.num_control_points() < order();
    return ForEachSite(
        begin, end,
        [&](const Window& window) {
          for (int j = 0; j < order(); ++j) {
            for (int c = 0; c < dimension(); ++c) {
              local[j * dimension() + c] = repeated ? 0.0 : gradient[window.offset[j] + c];
            }
          }
        },
        [&](const NumberSite& site, int, const Window& window) {
          if (!ResidualsAndJacobian(site, window, x, residuals, jacobian)) return false;
          double slope = 1.0;
          *energy += weight * Loss(loss, SquaredNorm(residuals), &slope);
          // Ceres gives the root of weight * rho' to each of the two factors; so do we: equal bits.
          const double root = std::sqrt(std::abs(weight * slope));
          const double twice_root = std::copysign(2.0 * root, weight * slope);
          for (int v = 0; v < num_variables(); ++v) {
            double sum = 0.0;
            for (int r = 0; r < num_residuals(); ++r) {
              sum += (root * jacobian[r * num_variables() + v]) * (twice_root * residuals[r]);
            }
            local[v] += sum;
          }
          return true;
        },
        [&](const Window& window) {
          for (int j = 0; j < order(); ++j) {
            for (int c = 0; c < dimension(); ++c) {
              double& entry = gradient[window.offset[j] + c];
              entry = (repeated ? entry : 0.0) + local[j * dimension() + c];
            }
          }
        });
  }

  /// Adds the Hessian of the energy times `direction`: with s = ||r||^2,
  /// 2 rho' (J'J v + sum_r r_r H_r v) + 4 rho'' (r . J v) J'r, times weight.
  bool AddHessianTimes(const double* x, const double* direction, double weight,
                       const ceres::LossFunction* loss, double* product) const {
    using Second = DirectionalDual<Jet>;
    Second variables[kVariableStorage];
    const Second* points[kOrderStorage];
    Second results[kMaxResiduals];
    for (int j = 0; j < order(); ++j) points[j] = variables + j * dimension();
    const auto body = [&](const NumberSite& site, int, const Window& window) {
      for (int first = 0; first < num_variables(); first += kChunk) {
        for (int j = 0; j < order(); ++j) {
          for (int c = 0; c < dimension(); ++c) {
            const int v = j * dimension() + c;
            variables[v] =
                Second(Jet(x[window.offset[j] + c]), Jet(direction[window.offset[j] + c]));
            if (v >= first && v < first + kChunk) variables[v].value.v[v - first] = 1.0;
          }
        }
        if (!functor_(site, points, results)) return false;
        double squared_norm = 0.0;
        double change = 0.0;
        for (int r = 0; r < num_residuals(); ++r) {
          squared_norm += results[r].value.a * results[r].value.a;
          change += results[r].value.a * results[r].slope.a;
        }
        double rho[3] = {squared_norm, 1.0, 0.0};
        if (loss != nullptr) loss->Evaluate(squared_norm, rho);
        const int count = std::min(kChunk, num_variables() - first);
        for (int k = 0; k < count; ++k) {
          double sum = 0.0;
          for (int r = 0; r < num_residuals(); ++r) {
            const double derivative = results[r].value.v[k];
            sum +=
                2.0 * rho[1] *
                    (derivative * results[r].slope.a + results[r].value.a * results[r].slope.v[k]) +
                4.0 * rho[2] * change * derivative * results[r].value.a;
          }
          const int v = first + k;
          product[window.offset[v / dimension()] + v % dimension()] += weight * sum;
        }
      }
      return true;
    };
    return ForEachSite(
        0, sites_.size, [](const Window&) {}, body, [](const Window&) {});
  }

  /// Hands out the rows root_factor * (A, Q) of an affine residual whose rows are alike for all
  /// coordinates, in the spans of groups first_group..end_group-1.
  void StreamRows(double root_factor, int first_group, int end_group, RowConsumer* consumer) const {
    FunctorRows<Functor, P, D>(setting_, sites_, functor_)
        .Stream(root_factor, first_group, end_group, consumer);
  }

 private:
  double SquaredNorm(const double* residuals) const {
    // Eigen's own order of summation, as in Ceres: equal bits.
    return Eigen::Map<const Eigen::VectorXd>(residuals, num_residuals()).squaredNorm();
  }
  static double Loss(const ceres::LossFunction* loss, double squared_norm, double* slope) {
    *slope = 1.0;
    // A loss that is flat far out would give a finite value for no number at all.
    if (loss == nullptr || !std::isfinite(squared_norm)) return squared_norm;
    double rho[3];
    loss->Evaluate(squared_norm, rho);
    *slope = rho[1];
    return rho[0];
  }

  const FitSetting& setting_;
  const Sites& sites_;
  const BsplineBasis& basis_;
  const Functor& functor_;
};

}  // namespace batten

#endif  // BATTEN_COST_FUNCTIONS_FUNCTOR_KERNEL_H_
