#include "experiments/bench_profiles.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "experiments/comparison.h"

namespace batten {
namespace {

/// Share of `count` that the sorted finite values make up, step by step.
Steps StepsOf(std::vector<double> values, std::size_t count) {
  values.erase(std::remove_if(values.begin(), values.end(),
                              [](double value) { return !std::isfinite(value); }),
               values.end());
  std::sort(values.begin(), values.end());
  Steps steps;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double share = static_cast<double>(k + 1) / static_cast<double>(count);
    if (!steps.x.empty() && steps.x.back() == values[k]) {
      steps.y.back() = share;
    } else {
      steps.x.push_back(values[k]);
      steps.y.push_back(share);
    }
  }
  return steps;
}

std::size_t CountRun(const std::vector<double>& costs) {
  return static_cast<std::size_t>(
      std::count_if(costs.begin(), costs.end(), [](double cost) { return !std::isnan(cost); }));
}

std::size_t NumSolvers(const CostTable& costs) { return costs.empty() ? 0 : costs[0].size(); }

}  // namespace

double Steps::At(double place) const {
  const auto after = std::upper_bound(x.begin(), x.end(), place);
  return after == x.begin() ? 0.0 : y[static_cast<std::size_t>(after - x.begin()) - 1];
}

std::vector<Steps> PerformanceProfiles(const CostTable& costs) {
  std::vector<Steps> profiles;
  for (std::size_t s = 0; s < NumSolvers(costs); ++s) {
    std::vector<double> ratios;
    for (const std::vector<double>& problem : costs) {
      double best = HUGE_VAL;
      for (const double cost : problem) best = std::min(best, cost);  // passes over NaN
      // Infinity, too, where nobody solves it: the ratio would be none.
      ratios.push_back(std::isinf(problem[s]) ? HUGE_VAL : problem[s] / best);
    }
    const std::size_t count = CountRun(ratios);
    profiles.push_back(StepsOf(std::move(ratios), count));
  }
  return profiles;
}

std::vector<Steps> PairProfiles(const CostTable& costs, std::size_t first, std::size_t second) {
  CostTable pair;
  for (const std::vector<double>& problem : costs) {
    pair.push_back({problem[first], problem[second]});
  }
  return PerformanceProfiles(pair);
}

std::vector<Steps> DataProfiles(const CostTable& costs, const std::vector<double>& units) {
  std::vector<Steps> profiles;
  for (std::size_t s = 0; s < NumSolvers(costs); ++s) {
    std::vector<double> relative;
    for (std::size_t p = 0; p < costs.size(); ++p) relative.push_back(costs[p][s] / units[p]);
    const std::size_t count = CountRun(relative);
    profiles.push_back(StepsOf(std::move(relative), count));
  }
  return profiles;
}

Steps Distribution(std::vector<double> costs) {
  const std::size_t count = CountRun(costs);
  return StepsOf(std::move(costs), count);
}

double ShiftedGeometricMean(const std::vector<double>& values, double shift) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  double sum = 0.0;
  for (const double value : values) sum += std::log(value + shift);
  return std::exp(sum / static_cast<double>(values.size())) - shift;
}

CostTable ChargeFailures(const CostTable& costs, double factor) {
  CostTable charged;
  for (const std::vector<double>& problem : costs) {
    double largest = -HUGE_VAL;
    for (const double cost : problem) {
      if (std::isfinite(cost)) largest = std::max(largest, cost);
    }
    if (largest < 0.0) continue;
    charged.push_back(problem);
    for (double& cost : charged.back()) {
      if (std::isinf(cost)) cost = factor * largest;
    }
  }
  return charged;
}

MedianWithInterval BootstrapMedian(const std::vector<double>& values, std::uint64_t seed) {
  constexpr int kResamples = 2000;
  constexpr double kTail = 0.025;
  MedianWithInterval result;
  result.median = result.low = result.high = Median(values);
  if (values.size() < 2) return result;
  std::mt19937_64 random(seed);
  std::vector<double> medians;
  std::vector<double> resample(values.size());
  for (int k = 0; k < kResamples; ++k) {
    for (double& value : resample) value = values[random() % values.size()];
    medians.push_back(Median(resample));
  }
  std::sort(medians.begin(), medians.end());
  result.low = medians[static_cast<std::size_t>(kTail * kResamples)];
  result.high = medians[static_cast<std::size_t>((1.0 - kTail) * kResamples) - 1];
  return result;
}

}  // namespace batten
