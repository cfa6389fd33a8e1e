#include "splines/gauss_legendre.h"

#include <cmath>
#include <limits>

namespace batten {
namespace {

struct Legendre {
  long double value;
  long double slope;
};

/// P_n and its derivative at x, |x| < 1, by Bonnet's recursion.
Legendre EvaluateLegendre(int n, long double x) {
  long double before = 1.0L;
  long double value = x;
  for (int k = 1; k < n; ++k) {
    const long double next = ((2 * k + 1) * x * value - k * before) / (k + 1);
    before = value;
    value = next;
  }
  return {value, n * (x * value - before) / (x * x - 1.0L)};
}

/// Zero number i = 0..n-1 of P_n, from the largest down.
long double LegendreZero(int n, int i) {
  const long double pi = std::acos(-1.0L);
  // Tricomi's first approximation: near enough for Newton to find this zero and no other.
  long double x = std::cos(pi * (i + 0.75L) / (n + 0.5L));
  // Digits double: five steps would do for long double, from the two that x has.
  constexpr int kMaxSteps = 10;
  for (int step = 0; step < kMaxSteps; ++step) {
    const Legendre p = EvaluateLegendre(n, x);
    const long double change = p.value / p.slope;
    x -= change;
    if (std::abs(change) < std::numeric_limits<double>::epsilon() / 16) break;
  }
  return x;
}

}  // namespace

GaussRule GaussLegendreRule(int num_points) {
  const int n = num_points;
  GaussRule rule;
  rule.nodes.resize(static_cast<std::size_t>(n));
  rule.weights.resize(static_cast<std::size_t>(n));
  for (int i = 0; i <= n / 2 && i < n; ++i) {
    const bool middle = 2 * i + 1 == n;
    const long double x = middle ? 0.0L : LegendreZero(n, i);
    const long double slope = EvaluateLegendre(n, x).slope;
    const auto mirrored = static_cast<std::size_t>(n - 1 - i);
    const auto index = static_cast<std::size_t>(i);
    rule.nodes[mirrored] = static_cast<double>(x);
    rule.nodes[index] = middle ? 0.0 : -rule.nodes[mirrored];
    rule.weights[index] = rule.weights[mirrored] =
        static_cast<double>(2.0L / ((1.0L - x * x) * slope * slope));
  }
  return rule;
}

}  // namespace batten
