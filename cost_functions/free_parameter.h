#ifndef BATTEN_COST_FUNCTIONS_FREE_PARAMETER_H_
#define BATTEN_COST_FUNCTIONS_FREE_PARAMETER_H_

#include <memory>

#include "cost_functions/term.h"

namespace batten {

/// r_i = sqrt(w_i) (C(t_i) - Q_i) with t_i a variable, one block per data point, d residuals.
struct FreeParameterResidual {
  static TermInfo Info();
  static constexpr int kDerivatives = 0;
  static constexpr int NumResiduals(int dimension) { return dimension; }

  template <typename SiteType, typename T>
  bool operator()(const SiteType& site, const T* const* control_points, T* residuals) const {
    for (int c = 0; c < site.dimension(); ++c) {
      residuals[c] = site.root_weight() * (site.Curve(control_points, c) - site.point(c));
    }
    return true;
  }
};

std::unique_ptr<Term> MakeFreeParameterTerm();

}  // namespace batten

#endif  // BATTEN_COST_FUNCTIONS_FREE_PARAMETER_H_
