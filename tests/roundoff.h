#ifndef BATTEN_TESTS_ROUNDOFF_H_
#define BATTEN_TESTS_ROUNDOFF_H_

#include <limits>

namespace batten {

/// The distance from 1 to the next double: one rounding is wrong by at most half of it.
inline constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

}  // namespace batten

#endif  // BATTEN_TESTS_ROUNDOFF_H_
