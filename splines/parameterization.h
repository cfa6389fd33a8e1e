#ifndef BATTEN_SPLINES_PARAMETERIZATION_H_
#define BATTEN_SPLINES_PARAMETERIZATION_H_

#include <cstddef>
#include <optional>
#include <string>

#include "splines/points.h"

namespace batten {

/// How parameters are given to ordered data points (Piegl & Tiller, sec. 9.2.1).
enum class Parameterization { kUniform, kChordLength, kCentripetal };

const char* ToString(Parameterization rule);
bool FromString(const std::string& text, Parameterization* rule);

/// Parameters of m ordered points on [0, 1]. Open: t_0 = 0, t_(m-1) = 1 (uniform: i / (m - 1)).
/// Closed: t_0 = 0 and the chord from the last point back to the first ends at 1 (uniform: i / m).
/// Chord length: steps proportional to |Q_(i+1) - Q_i|; centripetal: to its root.
/// Scaling the points by a power of two changes no bit.
/// Nothing, with a sentence in `error` (may be null), if the rule needs lengths and all points are
/// equal or some are not finite, or if there are fewer than two points (one, when closed and
/// uniform).
std::optional<Eigen::VectorXd> Parameterize(Parameterization rule, bool closed,
                                            const Points& points, std::string* error);

/// values[i] <= values[i + 1] for all i, in one pass that looks at several at a time; false if one
/// is not a number.
bool IsNondecreasing(const double* values, std::ptrdiff_t size);

/// First i >= from with values[i] >= bound, or size; values from `from` on do not decrease. Found
/// in time of the logarithm of the distance from `guess` >= from.
std::ptrdiff_t FirstNotBelow(const double* values, std::ptrdiff_t from, std::ptrdiff_t size,
                             double bound, std::ptrdiff_t guess);

}  // namespace batten

#endif  // BATTEN_SPLINES_PARAMETERIZATION_H_
