#ifndef BATTEN_COST_FUNCTIONS_FREE_SITES_H_
#define BATTEN_COST_FUNCTIONS_FREE_SITES_H_

#include "splines/bspline_basis.h"

namespace batten {

/// Data points whose parameters are variables: t_i stands at x[parameter_offset + i], and
/// E = sum_i w_i |C(t_i) - Q_i|^2. What methods that know this structure work on instead of single
/// residual blocks.
struct FreeSites {
  const BsplineBasis* basis = nullptr;
  int dimension = 0;
  int control_point_offset = 0;
  int parameter_offset = 0;
  Points points;            ///< Q, scaled as inside, m x d.
  Eigen::VectorXd weights;  ///< w_i >= 0, the term's weight in them.
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

}  // namespace batten

#endif  // BATTEN_COST_FUNCTIONS_FREE_SITES_H_
