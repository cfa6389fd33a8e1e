#include "splines/schoenberg_whitney.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace batten {
namespace {

/// Distinct parameters, and how many there are below a place; periodic ones go on beyond the
/// domain.
class ParameterCount {
 public:
  ParameterCount(const BsplineBasis& basis, std::vector<double> parameters)
      : basis_(basis), sorted_(std::move(parameters)) {
    std::sort(sorted_.begin(), sorted_.end());
    sorted_.erase(std::unique(sorted_.begin(), sorted_.end()), sorted_.end());
  }
  int size() const { return static_cast<int>(sorted_.size()); }
  long Below(double t) const {
    long turns = 0;
    if (basis_.periodic()) {
      turns = std::lround(std::floor((t - basis_.domain_begin()) / basis_.domain_length()));
      t -= static_cast<double>(turns) * basis_.domain_length();
    }
    return turns * size() + (std::lower_bound(sorted_.begin(), sorted_.end(), t) - sorted_.begin());
  }
  long UpTo(double t) const {
    return Below(std::nextafter(t, std::numeric_limits<double>::infinity()));
  }

 private:
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
  // Knots of control point j, 0 <= j < 2 n on periodic splines.
  const auto knot = [&](int k) {
    const int turns = basis.periodic() ? k / n : 0;
    return basis.knots()[static_cast<std::size_t>(k - turns * n)] + turns * basis.domain_length();
  };
  // Supports are open, but for the ends of an open curve that are repeated p + 1 times.
  const auto below_support = [&](int j) {
    const bool closed_end = !basis.periodic() && knot(j) == knot(j + p);
    return closed_end ? count.Below(knot(j)) : count.UpTo(knot(j));
  };
  const auto to_support_end = [&](int j) {
    const bool closed_end = !basis.periodic() && knot(j + 1) == knot(j + p + 1);
    return closed_end ? count.UpTo(knot(j + p + 1)) : count.Below(knot(j + p + 1));
  };
  // Of a run a..b: shortage = (b - a + 1) - (to_support_end(b) - below_support(a)). For each b the
  // best a is the one with the largest below_support(a) - a.
  const int last = basis.periodic() ? 2 * n - 1 : n - 1;
  const int longest = basis.periodic() ? n - p - 1 : n;  // longer runs see every parameter
  std::vector<std::pair<long, int>> candidates;          // decreasing values, increasing a
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
