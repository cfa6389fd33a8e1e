#include "experiments/short_number.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace batten {

std::string ShortNumber(double value, int digits) {
  if (std::isnan(value)) return "-";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  if (value == 0.0) return "0";
  char buffer[64];
  std::snprintf(buffer, sizeof(buffer), "%.*e", digits - 1, value);
  const int exponent = std::stoi(std::string(buffer).substr(std::string(buffer).find('e') + 1));
  constexpr int kFewestZeros = -3;
  constexpr int kMostDigits = 6;
  if (exponent < kFewestZeros || exponent > kMostDigits) return buffer;
  std::snprintf(buffer, sizeof(buffer), "%.*f", std::max(0, digits - 1 - exponent), value);
  return buffer;
}

}  // namespace batten
