#ifndef BATTEN_COST_FUNCTIONS_FAIRING_H_
#define BATTEN_COST_FUNCTIONS_FAIRING_H_

#include <memory>

#include "cost_functions/term.h"

namespace batten {

/// r_g = sqrt(w_g) C^(k)(u_g), k = kDerivative, at the p - k + 1 points of Gauss and Legendre's
/// rule in every span of the domain, d residuals each. |C^(k)|^2 is a polynomial of degree 2 (p -
/// k) in a span, so that the sum of their squares is the integral of |C^(k)(u)|^2 over the domain
/// itself, times the factor of the units: L^(2k - 1), L the length of the domain, for the parameter
/// normalised to [0, 1] (`scale_free`), 1 for the parameter as it is (`source`).
template <int kDerivative>
struct FairingResidual {
  static TermInfo Info();
  static constexpr bool kAffine = true;
  static constexpr int kDerivatives = kDerivative;
  static constexpr bool kOnlyHighestDerivative = true;
  static constexpr int NumResiduals(int dimension) { return dimension; }
  /// There are few sites in a span, and their rows are asked for once.
  static constexpr bool CompiledFor(int degree, int /*dimension*/) { return degree == 3; }

  explicit FairingResidual(const OptionValues& options)
      : scale_free(options.Word("units") == "scale_free") {}

  /// Gauss points of the non-empty spans, their weights with the factor of the units.
  std::shared_ptr<const Sites> MakeSites(const FitSetting& setting) const;

  template <typename SiteType, typename T>
  bool operator()(const SiteType& site, const T* const* control_points, T* residuals) const {
    for (int c = 0; c < site.dimension(); ++c) {
      residuals[c] = site.root_weight() * site.Derivative(kDerivative, control_points, c);
    }
    return true;
  }

  bool scale_free;
};

/// Options: derivative k = 1..3, at most the degree; units.
std::unique_ptr<Term> MakeFairingTerm();

}  // namespace batten

#endif  // BATTEN_COST_FUNCTIONS_FAIRING_H_
