#ifndef BATTEN_COST_FUNCTIONS_CURVE_FAIRING_H_
#define BATTEN_COST_FUNCTIONS_CURVE_FAIRING_H_

#include <algorithm>
#include <cmath>
#include <memory>

#include "cost_functions/term.h"

namespace batten {

/// What of the curvature is integrated over the arc length s.
enum class CurvatureMeasure {
  kBending,   ///< kappa^2: Euler's elastica.
  kVariation  ///< (d kappa / ds)^2 in the plane, |d(kappa b) / ds|^2 in space, b the binormal.
};

/// Residuals whose sum of squares over the sites is a Gauss rule for the integral of kappa^2 ds or
/// of (d kappa / ds)^2 ds, whatever the curve's parameter is. With a, b, c = C', C'', C''' and the
/// minors (x ^ y)_ij = x_i y_j - x_j y_i, i < j, one residual each (1 in the plane, 3 in space):
///   bending    r = sqrt(w) (a ^ b) / |a|^(5/2),
///   variation  r = sqrt(w) (|a|^2 (a ^ c) - 3 (a . b) (a ^ b)) / |a|^(11/2),
/// since the curvature as a bivector is kappa = (a ^ b) / |a|^3 and ds = |a| du. Minors lose no
/// digits where the curve is nearly straight, and are smooth where it is. No value where |a| is 0
/// to rounding, as at a cusp: its direction is noise there, and so were any step.
template <CurvatureMeasure kMeasure>
struct CurveFairingResidual {
  static TermInfo Info();
  static constexpr bool kAffine = false;
  static constexpr int kDerivatives = kMeasure == CurvatureMeasure::kBending ? 2 : 3;
  /// On a line there is no curvature; the term is refused there.
  static constexpr int NumResiduals(int dimension) {
    return std::max(1, dimension * (dimension - 1) / 2);
  }
  /// The curvature of quadratics jumps at every knot: hardly anybody makes them fair by it.
  static constexpr bool CompiledFor(int degree, int dimension) {
    return degree > 2 && dimension > 1;
  }

  /// `least_speed`: |a| that is not rounding yet.
  CurveFairingResidual(const OptionValues& options, double factor, double least_speed)
      : points(options.Integer("points")),
        factor_(factor),
        least_squared_speed_(least_speed * least_speed) {}

  std::shared_ptr<const Sites> MakeSites(const FitSetting& setting) const;

  template <typename SiteType, typename T>
  bool operator()(const SiteType& site, const T* const* control_points, T* residuals) const {
    using std::sqrt;
    constexpr int kStorage = SiteType::kDimensionStorage;
    const int d = site.dimension();
    T a[kStorage], b[kStorage];
    [[maybe_unused]] T c[kStorage];
    T squared_speed(0.0), along(0.0);
    for (int i = 0; i < d; ++i) {
      a[i] = site.Derivative(1, control_points, i);
      b[i] = site.Derivative(2, control_points, i);
      if constexpr (kMeasure == CurvatureMeasure::kVariation) {
        c[i] = site.Derivative(3, control_points, i);
      }
      squared_speed += a[i] * a[i];
      along += a[i] * b[i];
    }
    if (!(squared_speed > T(least_squared_speed_))) return false;
    // Reciprocals once, then products: a Jet's quotient rounds otherwise than a number's.
    const T over_squared = 1.0 / squared_speed;
    const T over_speed = sqrt(over_squared);
    const T factor = site.root_weight() * over_squared * sqrt(over_speed);
    residuals[0] = T(0.0);
    int r = 0;
    for (int i = 0; i < d; ++i) {
      for (int j = i + 1; j < d; ++j) {
        const T bend = a[i] * b[j] - a[j] * b[i];
        if constexpr (kMeasure == CurvatureMeasure::kBending) {
          residuals[r++] = bend * factor;
        } else {
          const T change = (a[i] * c[j] - a[j] * c[i]) - 3.0 * (along * over_squared) * bend;
          residuals[r++] = change * factor * over_speed;
        }
      }
    }
    return true;
  }

  int points;  ///< Of the Gauss rule in each span.

 private:
  double factor_;
  double least_squared_speed_;
};

/// On a curve of constant speed and length S, kappa^2 ds = |C''|^2 / S^3 dv, v the parameter on
/// [0, 1], and |d(kappa b) / ds|^2 ds = |C'''|^2 / S^5 dv up to what bending adds: the term
/// `fairing`, with the same weight, times (unit / S)^power.
struct ConstantSpeedFairing {
  NameSpec fairing;
  double unit = 1.0;  ///< In the coordinates inside.
  int power = 3;
};
/// `options`: of curve_fairing.
ConstantSpeedFairing FairingOfConstantSpeed(const FitSetting& setting, const OptionValues& options);

/// Options: measure bending|variation; points of the rule per span; units.
std::unique_ptr<Term> MakeCurveFairingTerm();

}  // namespace batten

#endif  // BATTEN_COST_FUNCTIONS_CURVE_FAIRING_H_
