#include "experiments/signed_rank.h"

#include <algorithm>
#include <cmath>

namespace batten {
namespace {

/// Twice the rank of each size, which is whole for shared ranks too; `sizes` ascending.
std::vector<long> DoubledRanks(const std::vector<double>& sizes) {
  std::vector<long> ranks;
  for (std::size_t begin = 0; begin < sizes.size();) {
    std::size_t end = begin;
    while (end < sizes.size() && sizes[end] == sizes[begin]) ++end;
    // Ranks begin + 1 .. end: their mean, doubled.
    ranks.resize(end, static_cast<long>(begin + 1 + end));
    begin = end;
  }
  return ranks;
}

/// Probability that a sum of ranks, each taken with probability 1/2, is at least `least`.
double ExactTail(const std::vector<long>& ranks, long least) {
  long total = 0;
  for (const long rank : ranks) total += rank;
  std::vector<double> probability(static_cast<std::size_t>(total) + 1, 0.0);
  probability[0] = 1.0;
  long reached = 0;
  for (const long rank : ranks) {
    reached += rank;
    for (long sum = reached; sum >= 0; --sum) {
      const auto at = static_cast<std::size_t>(sum);
      const double with = sum >= rank ? probability[static_cast<std::size_t>(sum - rank)] : 0.0;
      probability[at] = 0.5 * (probability[at] + with);
    }
  }
  double tail = 0.0;
  for (long sum = total; sum >= least; --sum) tail += probability[static_cast<std::size_t>(sum)];
  return std::min(tail, 1.0);
}

double NormalTail(const std::vector<long>& ranks, long sum) {
  double mean = 0.0, variance = 0.0;
  for (const long rank : ranks) {
    mean += 0.5 * static_cast<double>(rank);
    variance += 0.25 * static_cast<double>(rank) * static_cast<double>(rank);
  }
  // One half of a rank, doubled as the ranks are, for the continuity of the sum.
  const double z = (static_cast<double>(sum) - 1.0 - mean) / std::sqrt(variance);
  return 0.5 * std::erfc(z / std::sqrt(2.0));
}

}  // namespace

SignedRank TestSignedRank(const std::vector<double>& differences) {
  std::vector<double> kept;
  for (const double difference : differences) {
    if (difference != 0.0 && std::isfinite(difference)) kept.push_back(difference);
  }
  SignedRank result;
  result.count = static_cast<int>(kept.size());
  if (kept.empty()) return result;
  std::sort(kept.begin(), kept.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  std::vector<double> sizes;
  for (const double difference : kept) sizes.push_back(std::abs(difference));
  const std::vector<long> ranks = DoubledRanks(sizes);
  long positive = 0;
  for (std::size_t k = 0; k < kept.size(); ++k) positive += kept[k] > 0.0 ? ranks[k] : 0;
  result.positive_sum = 0.5 * static_cast<double>(positive);
  constexpr std::size_t kMostExact = 500;
  result.p_greater =
      kept.size() <= kMostExact ? ExactTail(ranks, positive) : NormalTail(ranks, positive);
  return result;
}

}  // namespace batten
