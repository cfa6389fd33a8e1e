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

/// Where t may go before its block must be bound anew: its span and the nearest one on either side
/// that is not empty, as far as the curve has them, and their distinct control points. t on a knot
/// is thus inside. Spans of closed curves go on past the domain: span k + n is span k a period
/// later.
struct FreeWindow {
  int first_span;
  int last_span;
  int num_blocks;

  FreeWindow(const BsplineBasis& basis, int span)
      : first_span(Neighbour(basis, span, -1)),
        last_span(Neighbour(basis, span, 1)),
        num_blocks(std::min(last_span - first_span + basis.order(), basis.num_control_points())) {}

  /// Control point of block j.
  int ControlPoint(const BsplineBasis& basis, int j) const {
    const int function = first_span - basis.degree() + j;
    return basis.periodic() ? function - Period(basis, function) * basis.num_control_points()
                            : function;
  }
  double low(const BsplineBasis& basis) const { return Knot(basis, first_span); }
  double high(const BsplineBasis& basis) const { return Knot(basis, last_span + 1); }

  /// How many periods `span` is past the domain.
  static int PeriodOfSpan(const BsplineBasis& basis, int span) {
    return basis.periodic() ? Period(basis, span - basis.degree()) : 0;
  }
  static double Knot(const BsplineBasis& basis, int knot) {
    const int period = PeriodOfSpan(basis, knot);
    return basis.knots()[knot - period * basis.num_control_points()] +
           period * basis.domain_length();
  }

 private:
  static int Period(const BsplineBasis& basis, int index) {
    const int n = basis.num_control_points();
    return index >= 0 ? index / n : -((n - 1 - index) / n);
  }
  static int Neighbour(const BsplineBasis& basis, int span, int direction) {
    int next = span + direction;
    while (basis.periodic() || (next >= basis.first_span() && next <= basis.last_span())) {
      if (Knot(basis, next) < Knot(basis, next + 1)) return next;
      next += direction;
    }
    return span;
  }
};

/// A residual functor at a site with free parameter as Ceres' automatic differentiation calls it:
/// parameter blocks are the window's control points, then t. Past the window t is held at its end.
template <typename Functor>
struct FreeFunctorAtSite {
  template <typename T>
  bool operator()(T const* const* blocks, T* residuals) const {
    const int p = basis->degree();
    T t = blocks[window.num_blocks][0];
    const double low = window.low(*basis), high = window.high(*basis);
    const bool is_inside = ScalarOf(t) >= low && ScalarOf(t) <= high;
    // A constraint may hold t in another period than the one the window is in.
    if (!is_inside && basis->periodic()) t += basis->Wrap(ScalarOf(t)) - ScalarOf(t);
    if (!(ScalarOf(t) >= low)) t = T(low);
    if (!(ScalarOf(t) <= high)) t = T(high);
    int span = window.first_span;
    while (span < window.last_span && ScalarOf(t) >= FreeWindow::Knot(*basis, span + 1)) ++span;
    const int period = FreeWindow::PeriodOfSpan(*basis, span);
    Site<T, -1, -1, Functor::kDerivatives> site(p, dimension);
    EvaluateBasisDerivatives(p, basis->knots().data(), span - period * basis->num_control_points(),
                             t - period * basis->domain_length(), Functor::kDerivatives,
                             site.mutable_basis());
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
