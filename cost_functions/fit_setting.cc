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
  for (int begin = 0; begin < sites->size;) {
    span = basis.FindSpanFrom(span, t[begin]);
    const double next_knot = basis.knots()[static_cast<std::size_t>(span) + 1];
    // The end of an open domain belongs to the span before it.
    const bool last = !basis.periodic() && next_knot >= basis.domain_end();
    const auto end = last ? sites->size : FirstNotBelow(t, begin, sites->size, next_knot);
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

}  // namespace batten
