#include "cost_functions/fit_setting.h"

#include <algorithm>
#include <numeric>

#include "splines/parameterization.h"

namespace batten {

namespace {

/// Parameters that do not decrease: looked at only around the knots.
void GroupSorted(const BsplineBasis& basis, Sites* sites) {
  const double* const t = sites->parameters;
  int span = basis.first_span();
  // A parameter comes from memory in about the time that eight groups take.
  const std::ptrdiff_t ahead = std::ptrdiff_t(8) * sites->size / basis.num_control_points();
  std::ptrdiff_t length = 0;  // of the last group: the next is mostly about as long
  for (int begin = 0; begin < sites->size;) {
    span = basis.FindSpanFrom(span, t[begin]);
    const double next_knot = basis.knots()[static_cast<std::size_t>(span) + 1];
    __builtin_prefetch(t + begin + ahead);
    // The end of an open domain belongs to the span before it.
    const bool last = !basis.periodic() && next_knot >= basis.domain_end();
    const auto end =
        last ? sites->size : FirstNotBelow(t, begin, sites->size, next_knot, begin + length);
    length = end - begin;
    sites->groups.push_back({span, begin, static_cast<int>(end)});
    begin = static_cast<int>(end);
  }
}

}  // namespace

void GroupBySpan(const BsplineBasis& basis, bool nondecreasing, Sites* sites) {
  sites->order.clear();
  sites->groups.clear();
  if (nondecreasing) return GroupSorted(basis, sites);
  const auto size = static_cast<std::size_t>(sites->size);
  const auto add = [sites](int span, int site) {
    if (sites->groups.empty() || sites->groups.back().span != span) {
      sites->groups.push_back({span, site, site});
    }
    sites->groups.back().end = site + 1;
  };
  int span = basis.first_span();
  bool sorted = true;
  for (int i = 0; i < sites->size && sorted; ++i) {
    const double t = sites->parameters[i];
    const std::vector<double>& u = basis.knots();
    // Most points lie in the span of the point before.
    const int next = t >= u[span] && t < u[span + 1] ? span : basis.FindSpanFrom(span, t);
    sorted = next >= span;
    span = next;
    if (sorted) add(span, i);
  }
  if (sorted) return;

  std::vector<int> spans(size);
  span = basis.first_span();
  for (std::size_t i = 0; i < size; ++i) {
    spans[i] = span = basis.FindSpanFrom(span, sites->parameters[i]);
  }
  sites->order.resize(size);
  std::iota(sites->order.begin(), sites->order.end(), 0);
  std::stable_sort(sites->order.begin(), sites->order.end(),
                   [&](int a, int b) { return spans[a] < spans[b]; });
  sites->groups.clear();
  for (std::size_t s = 0; s < size; ++s) add(spans[sites->order[s]], static_cast<int>(s));
}

std::vector<int> CutIntoParts(const BsplineBasis& basis, const Sites& sites) {
  // About 0.1 ms of work.
  constexpr int kLeastSites = 1 << 14;
  const std::vector<Sites::Group>& groups = sites.groups;
  std::vector<int> begins = {0};
  const auto first_of_last_part = [&] { return groups[static_cast<std::size_t>(begins.back())]; };
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const bool is_long_enough = groups[g].begin - first_of_last_part().begin >= kLeastSites &&
                                groups[g].span - first_of_last_part().span >= basis.order();
    if (is_long_enough) begins.push_back(static_cast<int>(g));
  }
  // Behind it a periodic curve goes on with the first part.
  const bool last_is_short =
      begins.size() > 1 && basis.last_span() + 1 - first_of_last_part().span < basis.order();
  if (last_is_short) begins.pop_back();
  if (begins.size() % 2 == 1 && begins.size() > 1) begins.pop_back();
  begins.push_back(static_cast<int>(groups.size()));
  return begins;
}

}  // namespace batten
