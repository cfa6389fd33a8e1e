#include "splines/schoenberg_whitney.h"

#include <algorithm>
#include <utility>

namespace batten {
namespace {

/// Distinct parameters, and how many there are below a knot; on periodic splines they go on beyond
/// the domain, as do the knots.
class ParameterCount {
 public:
  ParameterCount(const BsplineBasis& basis, std::vector<double> parameters)
      : basis_(basis), sorted_(std::move(parameters)) {
    std::sort(sorted_.begin(), sorted_.end());
    sorted_.erase(std::unique(sorted_.begin(), sorted_.end()), sorted_.end());
  }
  long size() const { return static_cast<long>(sorted_.size()); }
  long Below(int k) const {
    return Turns(k) * size() +
           (std::lower_bound(sorted_.begin(), sorted_.end(), Knot(k)) - sorted_.begin());
  }
  long UpTo(int k) const {
    return Turns(k) * size() +
           (std::upper_bound(sorted_.begin(), sorted_.end(), Knot(k)) - sorted_.begin());
  }

 private:
  // Knots outside a periodic domain by their copies inside, which no rounding has moved.
  long Turns(int k) const {
    const int n = basis_.num_control_points();
    return basis_.periodic() ? (k - basis_.degree() + n * kTurnsBefore) / n - kTurnsBefore : 0;
  }
  double Knot(int k) const {
    const auto n = basis_.num_control_points();
    return basis_.knots()[static_cast<std::size_t>(k - Turns(k) * n)];
  }
  static constexpr int kTurnsBefore = kMaxDegree;  // n >= 1: no knot lies farther before the domain

  const BsplineBasis& basis_;
  std::vector<double> sorted_;
};

}  // namespace

DataShortage LargestDataShortage(const BsplineBasis& basis, std::vector<double> parameters) {
  const int n = basis.num_control_points();
  const int p = basis.degree();
  const ParameterCount count(basis, std::move(parameters));
  DataShortage worst;
  const auto offer = [&worst](int first, int size, long available) {
    if (size - available > worst.num_control_points - worst.num_parameters) {
      worst = {first, size, static_cast<int>(available)};
    }
  };
  // Supports are open, but for the ends of an open curve that are repeated p + 1 times.
  const std::vector<double>& u = basis.knots();
  const auto below_support = [&](int j) {
    const bool closed_end = !basis.periodic() && u[j] == u[j + p];
    return closed_end ? count.Below(j) : count.UpTo(j);
  };
  const auto to_support_end = [&](int j) {
    const bool closed_end = !basis.periodic() && u[j + 1] == u[j + p + 1];
    return closed_end ? count.UpTo(j + p + 1) : count.Below(j + p + 1);
  };
  // Of a run a..b: shortage = (b - a + 1) - (to_support_end(b) - below_support(a)). For each b the
  // best a is the one with the largest below_support(a) - a.
  const int last = basis.periodic() ? 2 * n - 1 : n - 1;
  const int longest = basis.periodic() ? n - p : n;  // longer runs see every parameter
  std::vector<std::pair<long, int>> candidates;      // decreasing values, increasing a
  std::size_t front = 0;
  for (int b = 0; b <= last && longest > 0; ++b) {
    const long value = below_support(b) - b;
    while (candidates.size() > front && candidates.back().first <= value) candidates.pop_back();
    candidates.emplace_back(value, b);
    while (candidates[front].second < b - longest + 1) ++front;
    const int a = candidates[front].second;
    offer(a % n, b - a + 1, to_support_end(b) - below_support(a));
  }
  if (basis.periodic()) offer(0, n, count.size());
  return worst;
}

}  // namespace batten
