// A term that has no value any more after it was called some thousand times.
#include <atomic>

#include "solvers/plugin.h"

struct Faulty : batten::TermAtDataPoints {
  using TermAtDataPoints::TermAtDataPoints;
  static batten::TermInfo Info() {
    return batten::MakeTermInfo("faulty_term", "gives out", "tests/plugins");
  }
  template <typename SiteType, typename T>
  bool operator()(const SiteType& site, const T* const* control_points, T* residuals) const {
    static std::atomic<int> calls{0};
    for (int c = 0; c < site.dimension(); ++c) {
      residuals[c] = site.Curve(control_points, c) - site.point(c);
    }
    return ++calls < 5000;
  }
};

BATTEN_PLUGIN(registry) { batten::AddTerm<Faulty>(registry); }
