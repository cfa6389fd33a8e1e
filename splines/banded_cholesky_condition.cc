#include <algorithm>
#include <cmath>

#include "splines/banded_cholesky.h"

namespace batten {
namespace {

/// ||x||_1; x becomes its signs, which `signs` keeps. `changed`: whether one is not as it was.
double TakeSigns(Eigen::Map<Eigen::VectorXd>* x, std::vector<signed char>* signs, bool* changed) {
  constexpr Eigen::Index kBlock = 512;  // is still in the nearest cache when its signs are taken
  double norm = 0.0;
  int changes = 0;
  for (Eigen::Index begin = 0; begin < x->size(); begin += kBlock) {
    const Eigen::Index end = std::min(begin + kBlock, x->size());
    norm += x->segment(begin, end - begin).lpNorm<1>();
    for (Eigen::Index i = begin; i < end; ++i) {
      const auto now = static_cast<signed char>((*x)[i] >= 0.0 ? 1 : -1);
      changes |= now ^ (*signs)[static_cast<std::size_t>(i)];
      (*signs)[static_cast<std::size_t>(i)] = now;
      (*x)[i] = now;
    }
  }
  *changed = changes != 0;
  return norm;
}

}  // namespace

double BandedCholesky::ConditionEstimate() const {
  if (n_ == 0) return 1.0;
  // Hager 1984 with Higham's changes of 1988: ||N^-1||_1 is the maximum of the convex function
  // ||N^-1 x||_1 over the unit ball, climbed from corner to corner. Higham's last vector, of
  // alternating signs, is solved for beside the first one: a solve waits for its own results.
  LargeArray memory(2 * static_cast<std::size_t>(n_));
  Eigen::Map<Points> pair(memory.data(), n_, 2);
  const double share = 1.0 / n_;
  const double slope = 1.0 / std::max(n_ - 1, 1);
  for (int i = 0; i < n_; ++i) {
    pair(i, 0) = share;
    pair(i, 1) = (i % 2 == 0 ? 1.0 : -1.0) * (1.0 + slope * i);
  }
  Solve(pair.data(), 2);
  const double alternating = pair.col(1).lpNorm<1>();
  // In the memory of the pair, which is not asked for again.
  for (int i = 0; i < n_; ++i) pair.data()[i] = pair(i, 0);
  Eigen::Map<Eigen::VectorXd> x(pair.data(), n_);
  double estimate = 0.0;
  int corner = -1;
  std::vector<signed char> signs(static_cast<std::size_t>(n_), 0);
  for (int step = 0; step < 5; ++step) {
    if (step > 0) Solve(x.data(), 1);
    bool changed = false;
    const double norm = TakeSigns(&x, &signs, &changed);
    if (step > 0 && !(norm > estimate)) break;
    estimate = norm;
    if (!changed) break;
    Solve(x.data(), 1);
    const double largest = x.lpNorm<Eigen::Infinity>();
    if (corner >= 0 && std::abs(x[corner]) == largest) break;
    const auto is_largest = [largest](double value) { return std::abs(value) == largest; };
    corner = static_cast<int>(std::find_if(x.begin(), x.end(), is_largest) - x.begin());
    if (corner == n_) break;  // not a number
    // A unit vector on a background that keeps the decaying solution away from denormals.
    x.setConstant(1e-30);
    x[corner] = 1.0;
  }
  estimate = std::max(estimate, 2.0 * alternating / (3.0 * n_));
  return std::max(1.0, norm_ * estimate);
}

}  // namespace batten
