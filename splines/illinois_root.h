#ifndef BATTEN_SPLINES_ILLINOIS_ROOT_H_
#define BATTEN_SPLINES_ILLINOIS_ROOT_H_

#include <cmath>

namespace batten {

/// A root of f between a and b, where it is `fa` and `fb`, of opposite signs and finite: secants
/// that keep it enclosed, the end that stays counting half so that it moves (the Illinois method,
/// Dowell & Jarratt, BIT 11, 1971). Ends at |f| < tolerance, or after max_calls calls. Returns the
/// place of the last call.
template <typename Function>
double IllinoisRoot(const Function& f, double a, double fa, double b, double fb, double tolerance,
                    int max_calls) {
  double place = b;
  for (int call = 0; call < max_calls; ++call) {
    place = (a * fb - b * fa) / (fb - fa);
    const double value = f(place);
    if (std::abs(value) < tolerance) break;
    if (value * fb < 0.0) {
      a = b;
      fa = fb;
    } else {
      fa *= 0.5;
    }
    b = place;
    fb = value;
  }
  return place;
}

}  // namespace batten

#endif  // BATTEN_SPLINES_ILLINOIS_ROOT_H_
