#ifndef BATTEN_EXPERIMENTS_SHORT_NUMBER_H_
#define BATTEN_EXPERIMENTS_SHORT_NUMBER_H_

#include <string>

namespace batten {

/// For people: `value` to `digits` significant digits, as short as can be: 0.0123, 1.2e-10, 45100;
/// "-" for NaN.
std::string ShortNumber(double value, int digits);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_SHORT_NUMBER_H_
