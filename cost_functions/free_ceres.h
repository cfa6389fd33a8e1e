#ifndef BATTEN_COST_FUNCTIONS_FREE_CERES_H_
#define BATTEN_COST_FUNCTIONS_FREE_CERES_H_

#include <ceres/dynamic_autodiff_cost_function.h>

#include <algorithm>
#include <memory>

#include "cost_functions/site.h"
#include "splines/basis_functions.h"
#include "splines/bspline_basis.h"

namespace batten {

/// The scalar of an automatic differentiation type.
inline double ScalarOf(double value) { return value; }
template <typename T, int N>
double ScalarOf(const ceres::Jet<T, N>& jet) {
  return ScalarOf(jet.a);
}

/// Distinct control points of spans `span` - 1..`span` + 1, as far as the curve has them: how many,
/// and the first function.
struct FreeWindow {
  int first_span;
  int last_span;
  int num_blocks;

  FreeWindow(const BsplineBasis& basis, int span) {
    // The knots of periodic curves go on for a span past either end.
    const int beyond = basis.periodic() ? 1 : 0;
    first_span = std::max(span - 1, basis.first_span() - beyond);
    last_span = std::min(span + 1, basis.last_span() + beyond);
    num_blocks = std::min(last_span - first_span + basis.order(), basis.num_control_points());
  }
  /// Control point of block j.
  int ControlPoint(const BsplineBasis& basis, int j) const {
    const int n = basis.num_control_points();
    const int function = first_span - basis.degree() + j;
    return basis.periodic() ? (function + n) % n : function;
  }
};

/// A residual functor at a site with free parameter as Ceres' automatic differentiation calls it:
/// parameter blocks are the window's control points, then t. t may move to the neighbouring spans;
/// past them it is held at the window's end.
template <typename Functor>
struct FreeFunctorAtSite {
  template <typename T>
  bool operator()(T const* const* blocks, T* residuals) const {
    const int p = basis->degree();
    T t = blocks[window.num_blocks][0];
    const double* u = basis->knots().data();
    const double low = u[window.first_span], high = u[window.last_span + 1];
    if (!(ScalarOf(t) >= low)) t = T(low);
    if (!(ScalarOf(t) <= high)) t = T(high);
    int span = window.first_span;
    while (span < window.last_span && (ScalarOf(t) >= u[span + 1] || u[span] >= u[span + 1])) {
      ++span;
    }
    while (span > window.first_span && u[span] >= u[span + 1]) --span;
    Site<T, -1, -1, Functor::kDerivatives> site(p, dimension);
    EvaluateBasisDerivatives(p, u, span, t, Functor::kDerivatives, site.mutable_basis());
    for (int c = 0; c < dimension; ++c) site.mutable_point()[c] = T(point[c]);
    site.set_root_weight(T(root_weight));
    const T* pointers[kMaxOrder] = {};
    for (int j = 0; j <= p; ++j) {
      pointers[j] = blocks[(span - window.first_span + j) % window.num_blocks];
    }
    return functor(site, pointers, residuals);
  }

  Functor functor;
  const BsplineBasis* basis;
  int dimension;
  FreeWindow window;
  double point[kMaxDimension];
  double root_weight;
};

template <typename Functor>
std::unique_ptr<ceres::CostFunction> MakeFreeCostFunction(const FreeFunctorAtSite<Functor>& site) {
  constexpr int kStride = 8;
  auto cost =
      std::make_unique<ceres::DynamicAutoDiffCostFunction<FreeFunctorAtSite<Functor>, kStride>>(
          new FreeFunctorAtSite<Functor>(site));  // the cost function owns it
  for (int j = 0; j < site.window.num_blocks; ++j) cost->AddParameterBlock(site.dimension);
  cost->AddParameterBlock(1);
  cost->SetNumResiduals(Functor::NumResiduals(site.dimension));
  return cost;
}

}  // namespace batten

#endif  // BATTEN_COST_FUNCTIONS_FREE_CERES_H_
