#include "solvers/plugin.h"

// sum_i w_i |C'(t_i)|^2: draws the curve together at the data points.
struct Tension : batten::TermAtDataPoints {
  static constexpr bool kAffine = true;
  static constexpr int kDerivatives = 1;
  using TermAtDataPoints::TermAtDataPoints;
  static batten::TermInfo Info() {
    return batten::MakeTermInfo("tension", "squared speed of the curve at the data points",
                                "Schweikert, J. Math. Phys. 45, 1966");
  }
  template <typename SiteType, typename T>
  bool operator()(const SiteType& site, const T* const* control_points, T* residuals) const {
    for (int c = 0; c < site.dimension(); ++c) {
      residuals[c] = site.root_weight() * site.Derivative(1, control_points, c);
    }
    return true;
  }
};
BATTEN_PLUGIN(registry) { batten::AddTerm<Tension>(registry); }
