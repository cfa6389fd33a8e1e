#ifndef BATTEN_COST_FUNCTIONS_FREE_SITES_H_
#define BATTEN_COST_FUNCTIONS_FREE_SITES_H_

#include <ceres/loss_function.h>

#include <cmath>
#include <limits>

#include "splines/bspline_basis.h"

namespace batten {

/// Data points whose parameters are variables: t_i stands at x[parameter_offset + i], and
/// E = sum_i w_i |C(t_i) - Q_i|^2, with a loss E = W sum_i rho(w_i |C(t_i) - Q_i|^2 / W), W the
/// term's weight. What methods that know this structure work on instead of single residual blocks.
/// Where parameters are projected, t_i is the foot point instead, and methods keep it at
/// parameter_offset + i of a vector of their own, behind the control points.
struct FreeSites {
  const BsplineBasis* basis = nullptr;
  int dimension = 0;
  int control_point_offset = 0;
  int parameter_offset = 0;
  bool projected = false;
  Points points;            ///< Q, scaled as inside, m x d.
  Eigen::VectorXd weights;  ///< w_i >= 0, the term's weight in them.
  double term_weight = 1.0;
  const ceres::LossFunction* loss = nullptr;  ///< rho; null: the identity, or W is 0.
};

/// Where t is on the curve: its place in the domain and the span there.
struct CurvePlace {
  int span = 0;
  double t = 0.0;
  /// False where t of an open curve is past an end, at which it is held then: nothing changes with
  /// it.
  bool moves = true;
};

inline CurvePlace PlaceOnCurve(const BsplineBasis& basis, double t) {
  CurvePlace place;
  place.t = basis.Wrap(t);
  place.span = basis.FindSpan(place.t);
  place.moves = basis.periodic() || place.t == t;
  return place;
}

/// Where a method that knows what presses t leaves it on an open curve: a t that comes to an end is
/// put a hair past it, where it does not count in the gradient. t inside, and any t of a closed
/// curve, stays.
inline double PastTheEnd(const BsplineBasis& basis, double t) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  if (basis.periodic()) return t;
  if (t >= basis.domain_end()) return std::nextafter(basis.domain_end(), kFar);
  if (t <= basis.domain_begin()) return std::nextafter(basis.domain_begin(), -kFar);
  return t;
}

}  // namespace batten

#endif  // BATTEN_COST_FUNCTIONS_FREE_SITES_H_
