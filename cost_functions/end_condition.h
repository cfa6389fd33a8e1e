#ifndef BATTEN_COST_FUNCTIONS_END_CONDITION_H_
#define BATTEN_COST_FUNCTIONS_END_CONDITION_H_

#include <memory>

#include "cost_functions/term.h"

namespace batten {

/// r = sqrt(w) (C^(k)(t) - V), k = kDerivative, one block of d residuals at the begin, the end or
/// both ends t of the domain of an open curve. V: of k = 0 the data point there, of k = 1 Bessel's
/// tangent, of k = 2 zero, unless the options x, y, z, w say otherwise.
template <int kDerivative>
struct EndResidual {
  static TermInfo Info();
  static constexpr bool kAffine = true;
  static constexpr int kDerivatives = kDerivative;
  static constexpr bool kOnlyHighestDerivative = true;
  static constexpr int NumResiduals(int dimension) { return dimension; }
  /// There are one or two sites however many the data.
  static constexpr bool CompiledFor(int /*degree*/, int /*dimension*/) { return false; }

  explicit EndResidual(std::shared_ptr<const Sites> ends) : ends_(std::move(ends)) {}
  std::shared_ptr<const Sites> MakeSites(const FitSetting& /*setting*/) const { return ends_; }

  template <typename SiteType, typename T>
  bool operator()(const SiteType& site, const T* const* control_points, T* residuals) const {
    for (int c = 0; c < site.dimension(); ++c) {
      residuals[c] =
          site.root_weight() * (site.Derivative(kDerivative, control_points, c) - site.point(c));
    }
    return true;
  }

 private:
  std::shared_ptr<const Sites> ends_;
};

std::unique_ptr<Term> MakeEndPointTerm();
/// In `scale_free` units r is multiplied by the length of the domain, in `source` units by the knot
/// difference over the degree, which makes it P_1 - P_0 (P_(n-1) - P_(n-2)) minus that of V.
std::unique_ptr<Term> MakeEndTangentTerm();
/// V is the second derivative; `scale_free`: times the square of the domain's length.
std::unique_ptr<Term> MakeEndCurvatureTerm();

}  // namespace batten

#endif  // BATTEN_COST_FUNCTIONS_END_CONDITION_H_
