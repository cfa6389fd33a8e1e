#ifndef BATTEN_TESTS_NOT_A_NUMBER_H_
#define BATTEN_TESTS_NOT_A_NUMBER_H_

#include <limits>

namespace batten {

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

}  // namespace batten

#endif  // BATTEN_TESTS_NOT_A_NUMBER_H_
