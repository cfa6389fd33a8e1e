#ifndef BATTEN_COST_FUNCTIONS_DIRECTIONAL_DUAL_H_
#define BATTEN_COST_FUNCTIONS_DIRECTIONAL_DUAL_H_

#include <ceres/jet.h>

#include <cmath>

namespace batten {

/// value + epsilon * slope with epsilon^2 = 0, over a scalar S that may itself be a ceres::Jet:
/// seeded with a direction v it gives the derivative along v of everything S computes, so that
/// DirectionalDual<Jet> yields products of second derivatives with v. (Ceres' Jets do not nest:
/// a Jet of Jets has no product with a double.)
template <typename S>
struct DirectionalDual {
  DirectionalDual() = default;
  // Conversion from plain numbers is what lets functors write `T(0)` and `2.0 * t`.
  // NOLINTNEXTLINE(google-explicit-constructor)
  DirectionalDual(double number) : value(number), slope(0.0) {}
  DirectionalDual(const S& v, const S& s) : value(v), slope(s) {}

  DirectionalDual& operator+=(const DirectionalDual& b) { return *this = *this + b; }
  DirectionalDual& operator-=(const DirectionalDual& b) { return *this = *this - b; }
  DirectionalDual& operator*=(const DirectionalDual& b) { return *this = *this * b; }
  DirectionalDual& operator/=(const DirectionalDual& b) { return *this = *this / b; }

  friend DirectionalDual operator-(const DirectionalDual& a) { return {-a.value, -a.slope}; }
  friend DirectionalDual operator+(const DirectionalDual& a, const DirectionalDual& b) {
    return {a.value + b.value, a.slope + b.slope};
  }
  friend DirectionalDual operator-(const DirectionalDual& a, const DirectionalDual& b) {
    return {a.value - b.value, a.slope - b.slope};
  }
  friend DirectionalDual operator*(const DirectionalDual& a, const DirectionalDual& b) {
    return {a.value * b.value, a.value * b.slope + a.slope * b.value};
  }
  friend DirectionalDual operator/(const DirectionalDual& a, const DirectionalDual& b) {
    const S quotient = a.value / b.value;
    return {quotient, (a.slope - quotient * b.slope) / b.value};
  }
  friend bool operator<(const DirectionalDual& a, const DirectionalDual& b) {
    return a.value < b.value;
  }
  friend bool operator>(const DirectionalDual& a, const DirectionalDual& b) {
    return a.value > b.value;
  }
  friend bool operator<=(const DirectionalDual& a, const DirectionalDual& b) {
    return a.value <= b.value;
  }
  friend bool operator>=(const DirectionalDual& a, const DirectionalDual& b) {
    return a.value >= b.value;
  }
  friend bool operator==(const DirectionalDual& a, const DirectionalDual& b) {
    return a.value == b.value;
  }
  friend bool operator!=(const DirectionalDual& a, const DirectionalDual& b) {
    return a.value != b.value;
  }

  friend DirectionalDual sqrt(const DirectionalDual& a) {
    using std::sqrt;
    const S root = sqrt(a.value);
    return {root, a.slope / (2.0 * root)};
  }
  friend DirectionalDual exp(const DirectionalDual& a) {
    using std::exp;
    const S value = exp(a.value);
    return {value, value * a.slope};
  }
  friend DirectionalDual log(const DirectionalDual& a) {
    using std::log;
    return {log(a.value), a.slope / a.value};
  }
  friend DirectionalDual sin(const DirectionalDual& a) {
    using std::cos;
    using std::sin;
    return {sin(a.value), cos(a.value) * a.slope};
  }
  friend DirectionalDual cos(const DirectionalDual& a) {
    using std::cos;
    using std::sin;
    return {cos(a.value), -sin(a.value) * a.slope};
  }
  friend DirectionalDual atan2(const DirectionalDual& y, const DirectionalDual& x) {
    using std::atan2;
    const S squared = x.value * x.value + y.value * y.value;
    return {atan2(y.value, x.value), (x.value * y.slope - y.value * x.slope) / squared};
  }
  friend DirectionalDual pow(const DirectionalDual& a, double exponent) {
    using std::pow;
    return {pow(a.value, exponent), exponent * pow(a.value, exponent - 1.0) * a.slope};
  }
  friend DirectionalDual abs(const DirectionalDual& a) { return a.value < S(0.0) ? -a : a; }

  S value;
  S slope;
};

}  // namespace batten

#endif  // BATTEN_COST_FUNCTIONS_DIRECTIONAL_DUAL_H_
