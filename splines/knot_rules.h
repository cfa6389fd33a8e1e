#ifndef BATTEN_SPLINES_KNOT_RULES_H_
#define BATTEN_SPLINES_KNOT_RULES_H_

#include <string>
#include <vector>

#include "splines/bspline_basis.h"

namespace batten {

enum class KnotRule { kUniform, kAveraged };
/// End-interpolating: p + 1 equal knots at either end. Floating: knots go on past the domain.
enum class EndKnots { kEndInterpolating, kFloating, kPeriodic };

const char* ToString(KnotRule rule);
bool FromString(const std::string& text, KnotRule* rule);

/// Uniform knots on [begin, end]: inner knots equally spaced; floating and periodic ones go on
/// with the same step. Empty unless 1 <= p <= kMaxDegree, n >= p + 1 (periodic: n >= 1) and
/// begin < end, both finite.
std::vector<double> UniformKnots(int degree, int num_control_points, EndKnots ends, double begin,
                                 double end);

/// Knots averaged from nondecreasing parameters on [begin, end].
/// End-interpolating, n = m: u_(j+p) = mean(t_j..t_(j+p-1)) (NURBS Book 9.8); n < m: 9.68 and 9.69
/// with d = m / (n - p); n > m: the parameters are first refined to n values by linear
/// interpolation of the map i -> t_i. Floating: the same inner knots, end steps repeated outside.
/// Periodic: the counterpart without ends, u_(p+j) = the periodic map i -> t_i, linear between
/// integers, at i = j m / n, shifted by half a step for even degree, so that n = m gives knots at
/// (odd p) or half way between (even p) the parameters, where the interpolation matrix is regular.
/// The domain then is not [begin, end] but the turn from u_p on: parameters belong to it after
/// BsplineBasis::Wrap(). Knots that would coincide more than p times, parameters that decrease or
/// leave [begin, end] and what UniformKnots refuses are a sentence in `error` (may be null) and an
/// empty result.
std::vector<double> AveragedKnots(int degree, int num_control_points, EndKnots ends, double begin,
                                  double end, const Eigen::VectorXd& parameters,
                                  std::string* error);

}  // namespace batten

#endif  // BATTEN_SPLINES_KNOT_RULES_H_
