#ifndef BATTEN_COST_FUNCTIONS_FUNCTOR_CERES_H_
#define BATTEN_COST_FUNCTIONS_FUNCTOR_CERES_H_

#include <ceres/autodiff_cost_function.h>
#include <ceres/dynamic_autodiff_cost_function.h>

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include "cost_functions/site.h"
#include "splines/bspline_basis.h"

namespace batten {

/// A residual functor at one fixed site in the form that Ceres' automatic differentiation calls.
template <typename Functor, typename SiteType>
struct FunctorAtSite {
  /// Ceres' static form: one pointer per control point, then the residuals.
  template <typename T, typename... Rest>
  bool operator()(const T* first, Rest... rest) const {
    const std::array<const T*, sizeof...(Rest) + 1> pointers = {first, rest...};
    return functor(site, pointers.data(), const_cast<T*>(pointers.back()));
  }
  Functor functor;
  SiteType site;
};

/// Ceres' dynamic form; control point j of the span is parameter block j % num_blocks, since a
/// periodic basis with few control points meets the same one several times.
template <typename Functor, typename SiteType>
struct FunctorAtSiteDynamic {
  template <typename T>
  bool operator()(T const* const* blocks, T* residuals) const {
    const T* pointers[kMaxOrder];
    for (int j = 0; j <= site.degree(); ++j) pointers[j] = blocks[j % num_blocks];
    return functor(site, pointers, residuals);
  }
  Functor functor;
  SiteType site;
  int num_blocks;
};

template <typename Functor, int P, int D, int kDerivatives, std::size_t... kIndices>
std::unique_ptr<ceres::CostFunction> MakeStaticCostFunction(
    const Functor& functor, const Site<double, P, D, kDerivatives>& site,
    std::index_sequence<kIndices...>) {
  using Adapter = FunctorAtSite<Functor, Site<double, P, D, kDerivatives>>;
  return std::make_unique<ceres::AutoDiffCostFunction<Adapter, Functor::NumResiduals(D),
                                                      (static_cast<int>(kIndices * 0) + D)...>>(
      new Adapter{functor, site});  // the cost function owns it
}

template <typename Functor, int P, int D, int kDerivatives>
std::unique_ptr<ceres::CostFunction> MakeFunctorCostFunction(
    const Functor& functor, const Site<double, P, D, kDerivatives>& site, const BsplineBasis& basis,
    int dimension) {
  if constexpr (P >= 0) {
    if (basis.num_control_points() >= P + 1) {
      return MakeStaticCostFunction(functor, site, std::make_index_sequence<P + 1>());
    }
  }
  using Adapter = FunctorAtSiteDynamic<Functor, Site<double, P, D, kDerivatives>>;
  const int num_blocks = std::min(basis.order(), basis.num_control_points());
  auto cost = std::make_unique<ceres::DynamicAutoDiffCostFunction<Adapter, 8>>(
      new Adapter{functor, site, num_blocks});
  for (int j = 0; j < num_blocks; ++j) cost->AddParameterBlock(dimension);
  cost->SetNumResiduals(Functor::NumResiduals(dimension));
  return cost;
}

}  // namespace batten

#endif  // BATTEN_COST_FUNCTIONS_FUNCTOR_CERES_H_
