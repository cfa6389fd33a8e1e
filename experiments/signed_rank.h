#ifndef BATTEN_EXPERIMENTS_SIGNED_RANK_H_
#define BATTEN_EXPERIMENTS_SIGNED_RANK_H_

#include <vector>

namespace batten {

/// Wilcoxon's signed-rank test of paired differences: Hollander, Wolfe & Chicken, Nonparametric
/// Statistical Methods, 3rd ed. 2014, sec. 3.1. Differences of 0 are left out, equal sizes share
/// their mean rank.
struct SignedRank {
  int count = 0;              // of differences that are not 0
  double positive_sum = 0.0;  // T+, of the ranks of positive ones
  /// Probability of a T+ at least as large if each sign were as likely as the other. Exact, given
  /// the ranks, for up to 500 differences; beyond, by the normal distribution with the variance
  /// that ties leave. 1 for no differences.
  double p_greater = 1.0;
};
SignedRank TestSignedRank(const std::vector<double>& differences);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_SIGNED_RANK_H_
