#include "experiments/taylor_slope.h"

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace batten {

TaylorSlope MeasureTaylorSlope(const std::function<double(double)>& remainder, double noise) {
  constexpr int kLongest = 4;
  constexpr int kShortest = 16;
  constexpr std::size_t kFewest = 3;
  constexpr std::size_t kMost = 5;
  TaylorSlope result;
  result.noise = noise;
  result.slope = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::pair<double, double>> points;  // log h, log |R|
  for (int k = kLongest; k <= kShortest; ++k) {
    const double h = std::ldexp(1.0, -k);
    const double size = std::abs(remainder(h));
    if (k == kLongest) result.largest = size;
    // A remainder that is no number is none that falls.
    if (!std::isfinite(size)) {
      result.largest = size;
      return result;
    }
    if (size > noise) points.emplace_back(std::log(h), std::log(size));
  }
  if (points.size() < kFewest) return result;
  if (points.size() > kMost) points.erase(points.begin(), points.end() - kMost);
  double mean_h = 0.0, mean_r = 0.0;
  for (const auto& [h, r] : points) {
    mean_h += h / static_cast<double>(points.size());
    mean_r += r / static_cast<double>(points.size());
  }
  double covariance = 0.0, variance = 0.0;
  for (const auto& [h, r] : points) {
    covariance += (h - mean_h) * (r - mean_r);
    variance += (h - mean_h) * (h - mean_h);
  }
  result.slope = covariance / variance;
  return result;
}

bool IsRightDerivative(const TaylorSlope& slope) {
  // Kinks of second derivatives between steps move it a little; a wrong derivative gives 1.
  constexpr double kLowest = 1.75;
  if (std::isnan(slope.slope)) return std::isfinite(slope.largest);
  return slope.slope >= kLowest;
}

}  // namespace batten
