#ifndef BATTEN_SPLINES_BRENT_MINIMUM_H_
#define BATTEN_SPLINES_BRENT_MINIMUM_H_

#include <algorithm>
#include <cmath>
#include <utility>

namespace batten {

/// A minimum of f inside (low, high), next to `middle` where f is `value`, at most at both ends:
/// parabolas through the three best points, golden sections where they fail (Brent, Algorithms for
/// Minimization without Derivatives, 1973, ch. 5). Ends when the place is known to `tolerance`, or
/// after max_calls calls. Returns the best place and its value.
template <typename Function>
std::pair<double, double> BrentMinimum(const Function& f, double low, double middle, double value,
                                       double high, double tolerance, int max_calls) {
  constexpr double kGolden = 0.3819660112501051;
  double best = middle, second = middle, third = middle;
  double f_best = value, f_second = value, f_third = value;
  double step = 0.0, step_before = 0.0;
  for (int call = 0; call < max_calls; ++call) {
    const double centre = 0.5 * (low + high);
    if (std::abs(best - centre) + 0.5 * (high - low) <= 2.0 * tolerance) break;
    // The parabola's minimum is best + numerator / denominator.
    const double r = (best - second) * (f_best - f_third);
    const double q = (best - third) * (f_best - f_second);
    double numerator = (best - third) * q - (best - second) * r;
    double denominator = 2.0 * (q - r);
    if (denominator > 0.0) numerator = -numerator;
    denominator = std::abs(denominator);
    const bool is_inside =
        numerator > denominator * (low - best) && numerator < denominator * (high - best);
    const bool shrinks = std::abs(numerator) < std::abs(0.5 * denominator * step_before);
    step_before = step;
    if (is_inside && shrinks && std::abs(step_before) > tolerance) {
      step = numerator / denominator;
      const double place = best + step;
      if (place - low < 2.0 * tolerance || high - place < 2.0 * tolerance) {
        step = best < centre ? tolerance : -tolerance;
      }
    } else {
      step_before = (best < centre ? high : low) - best;
      step = kGolden * step_before;
    }
    const double place =
        best + (std::abs(step) >= tolerance ? step : std::copysign(tolerance, step));
    const double f_place = f(place);
    if (f_place <= f_best) {
      (place < best ? high : low) = best;
      third = std::exchange(second, std::exchange(best, place));
      f_third = std::exchange(f_second, std::exchange(f_best, f_place));
      continue;
    }
    (place < best ? low : high) = place;
    if (f_place <= f_second || second == best) {
      third = std::exchange(second, place);
      f_third = std::exchange(f_second, f_place);
    } else if (f_place <= f_third || third == best || third == second) {
      third = place;
      f_third = f_place;
    }
  }
  return {best, f_best};
}

}  // namespace batten

#endif  // BATTEN_SPLINES_BRENT_MINIMUM_H_
