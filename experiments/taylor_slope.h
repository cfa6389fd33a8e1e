#ifndef BATTEN_EXPERIMENTS_TAYLOR_SLOPE_H_
#define BATTEN_EXPERIMENTS_TAYLOR_SLOPE_H_

#include <functional>

namespace batten {

/// How a remainder falls with the step: |R(h)| ~ h^slope.
struct TaylorSlope {
  /// Least-squares slope of log |R| over log h at the five shortest steps whose remainder stands
  /// above the rounding: where a derivative that is wrong by little shows most. NaN: fewer than
  /// three of them.
  double slope = 0.0;
  double largest = 0.0;  ///< Remainder at the longest step.
  double noise = 0.0;
};

/// `remainder(h)` at h = 2^-4, 2^-5, ..., 2^-16, of which those above `noise` count: 2 for
/// f(x + h v) - f(x) - h f'(x) v where f has a Lipschitz derivative, 1 where f' is wrong (the
/// Taylor test of Farrell et al., SIAM J. Sci. Comput. 35, 2013).
TaylorSlope MeasureTaylorSlope(const std::function<double(double)>& remainder, double noise);

/// The derivative is right: the slope is near 2, or there is no remainder above the rounding.
bool IsRightDerivative(const TaylorSlope& slope);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_TAYLOR_SLOPE_H_
