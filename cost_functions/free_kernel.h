#ifndef BATTEN_COST_FUNCTIONS_FREE_KERNEL_H_
#define BATTEN_COST_FUNCTIONS_FREE_KERNEL_H_

#include <ceres/jet.h>

#include <algorithm>
#include <cmath>

#include "cost_functions/directional_dual.h"
#include "cost_functions/fit_setting.h"
#include "cost_functions/free_sites.h"
#include "cost_functions/site.h"
#include "splines/basis_functions.h"

namespace batten {

/// One residual functor at one site whose parameter t is a variable: its derivatives by the p + 1
/// control points of the span that t is in now (variables j * d + c) and by t (the last one), zero
/// where t does not move. P and D are -1 where degree and dimension are known at run time only.
/// Derivatives of basis functions by t come from the basis, those of the residual from automatic
/// differentiation.
template <typename Functor, int P, int D>
class FreeKernel {
 public:
  static constexpr bool kStatic = P >= 0;
  static constexpr int kOrderStorage = kStatic ? P + 1 : kMaxOrder;
  static constexpr int kDimensionStorage = kStatic ? D : kMaxDimension;
  static constexpr int kVariableStorage = kOrderStorage * kDimensionStorage + 1;
  /// Variables differentiated in one call of the functor.
  static constexpr int kChunk = kStatic ? kVariableStorage : 8;
  static constexpr int kMaxResiduals = 16;
  static constexpr int kDerivatives = Functor::kDerivatives;
  using Jet = ceres::Jet<double, kChunk>;
  using Second = DirectionalDual<Jet>;

  FreeKernel(const FitSetting& setting, const Functor& functor)
      : setting_(setting), basis_(*setting.basis), functor_(functor) {}

  int order() const { return kStatic ? P + 1 : basis_.order(); }
  int dimension() const { return kStatic ? D : setting_.dimension; }
  int num_variables() const { return order() * dimension() + 1; }
  int num_residuals() const { return Functor::NumResiduals(dimension()); }

  /// Data of one site, and where its control points and its parameter stand in x.
  struct Block {
    CurvePlace place;
    const double* point = nullptr;  // scaled
    double root_weight = 1.0;
    int offset[kOrderStorage];
    int parameter_offset = 0;
  };
  Block MakeBlock(double t, const double* point, double root_weight, int parameter_offset) const {
    Block block;
    block.place = PlaceOnCurve(basis_, t);
    block.point = point;
    block.root_weight = root_weight;
    block.parameter_offset = parameter_offset;
    for (int j = 0; j < order(); ++j) {
      block.offset[j] =
          setting_.control_point_offset +
          basis_.ControlPointIndex(block.place.span - basis_.degree() + j) * dimension();
    }
    return block;
  }
  int Offset(const Block& block, int variable) const {
    return variable + 1 == num_variables()
               ? block.parameter_offset
               : block.offset[variable / dimension()] + variable % dimension();
  }

  bool Residuals(const Block& block, const double* x, double* residuals) const {
    double values[(kDerivatives + 1) * kOrderStorage];
    Differentiate(block, kDerivatives, values);
    auto site = MakeSite<double>(block);
    std::copy_n(values, (kDerivatives + 1) * order(), site.mutable_basis());
    const double* points[kOrderStorage] = {};
    for (int j = 0; j < order(); ++j) points[j] = x + block.offset[j];
    return functor_(site, points, residuals);
  }

  /// jacobian: num_residuals x num_variables, row-major.
  bool ResidualsAndJacobian(const Block& block, const double* x, double* residuals,
                            double* jacobian) const {
    double values[(kDerivatives + 2) * kOrderStorage];
    Differentiate(block, kDerivatives + 1, values);
    const bool moves = block.place.moves;
    Jet variables[kVariableStorage];
    const Jet* points[kOrderStorage];
    Jet results[kMaxResiduals];
    for (int j = 0; j < order(); ++j) points[j] = variables + j * dimension();
    for (int first = 0; first < num_variables(); first += kChunk) {
      const int t = num_variables() - 1 - first;  // place of t in the chunk
      auto site = MakeSite<Jet>(block);
      for (int k = 0; k < (kDerivatives + 1) * order(); ++k) {
        site.mutable_basis()[k] = Jet(values[k]);
        if (moves && t < kChunk) site.mutable_basis()[k].v[t] = values[k + order()];
      }
      for (int v = 0; v + 1 < num_variables(); ++v) {
        variables[v] = Jet(x[Offset(block, v)]);
        if (v >= first && v < first + kChunk) variables[v].v[v - first] = 1.0;
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

  /// Residuals in .value, their derivative along `direction` in .slope, for the chunk that begins
  /// with variable `first`.
  bool SecondDerivatives(const Block& block, const double* x, const double* direction, int first,
                         Second* results) const {
    double values[(kDerivatives + 3) * kOrderStorage];
    Differentiate(block, kDerivatives + 2, values);
    const bool moves = block.place.moves;
    const double along = moves ? direction[block.parameter_offset] : 0.0;
    const int t = num_variables() - 1 - first;
    auto site = MakeSite<Second>(block);
    for (int k = 0; k < (kDerivatives + 1) * order(); ++k) {
      Second& value = site.mutable_basis()[k];
      value = Second(Jet(values[k]), Jet(along * values[k + order()]));
      if (moves && t < kChunk) {
        value.value.v[t] = values[k + order()];
        value.slope.v[t] = along * values[k + 2 * order()];
      }
    }
    Second variables[kVariableStorage];
    const Second* points[kOrderStorage];
    for (int j = 0; j < order(); ++j) points[j] = variables + j * dimension();
    for (int v = 0; v + 1 < num_variables(); ++v) {
      variables[v] = Second(Jet(x[Offset(block, v)]), Jet(direction[Offset(block, v)]));
      if (v >= first && v < first + kChunk) variables[v].value.v[v - first] = 1.0;
    }
    return functor_(site, points, results);
  }

 private:
  /// Derivatives 0..highest of the basis functions at t.
  void Differentiate(const Block& block, int highest, double* values) const {
    EvaluateBasisDerivatives<P>(basis_.degree(), basis_.knots().data(), block.place.span,
                                block.place.t, highest, values);
  }

  template <typename Real>
  Site<Real, P, D, kDerivatives> MakeSite(const Block& block) const {
    Site<Real, P, D, kDerivatives> site(basis_.degree(), dimension());
    for (int c = 0; c < dimension(); ++c) site.mutable_point()[c] = Real(block.point[c]);
    site.set_root_weight(Real(block.root_weight));
    return site;
  }

  const FitSetting& setting_;
  const BsplineBasis& basis_;
  const Functor& functor_;
};

}  // namespace batten

#endif  // BATTEN_COST_FUNCTIONS_FREE_KERNEL_H_
