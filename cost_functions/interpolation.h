#ifndef BATTEN_COST_FUNCTIONS_INTERPOLATION_H_
#define BATTEN_COST_FUNCTIONS_INTERPOLATION_H_

#include <memory>

#include "cost_functions/term.h"

namespace batten {

/// r_i = sqrt(w_i) (C(t_i) - Q_i), one block per data point, d residuals: sum_i w_i |C(t_i) -
/// Q_i|^2.
struct InterpolationResidual {
  static TermInfo Info();
  static constexpr bool kAffine = true;
  static constexpr int kDerivatives = 0;
  static constexpr int NumResiduals(int dimension) { return dimension; }

  explicit InterpolationResidual(const OptionValues& /*options*/) {}

  std::shared_ptr<const Sites> MakeSites(const FitSetting& setting) const {
    return std::shared_ptr<const Sites>(std::shared_ptr<const Sites>(), setting.data);
  }

  template <typename SiteType, typename T>
  bool operator()(const SiteType& site, const T* const* control_points, T* residuals) const {
    for (int c = 0; c < site.dimension(); ++c) {
      residuals[c] = site.root_weight() * (site.Curve(control_points, c) - site.point(c));
    }
    return true;
  }
};

std::unique_ptr<Term> MakeInterpolationTerm();

}  // namespace batten

#endif  // BATTEN_COST_FUNCTIONS_INTERPOLATION_H_
