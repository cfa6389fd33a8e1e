#ifndef BATTEN_COST_FUNCTIONS_AFFINE_FORM_H_
#define BATTEN_COST_FUNCTIONS_AFFINE_FORM_H_

namespace batten {

/// constant + sum_k coefficient[k] x_k: forward differentiation for residuals that are affine in
/// their variables, with coefficients in Real (a double or a Pack). Only sums, and products with
/// plain numbers, exist, so a residual that is not affine does not compile with it.
template <typename Real, int kVariables>
struct AffineForm {
  AffineForm() = default;
  explicit AffineForm(double value) : constant(value) {
    for (Real& c : coefficient) c = Real(0.0);
  }
  /// The form x_index.
  static AffineForm Variable(int index) {
    AffineForm form(0.0);
    form.coefficient[index] = Real(1.0);
    return form;
  }
  /// values[0] x_0 + ... + values[count - 1] x_(count - 1).
  static AffineForm Combination(const Real* values, int count) {
    AffineForm form;
    form.constant = Real(0.0);
    for (int k = 0; k < count; ++k) form.coefficient[k] = values[k];
    for (int k = count; k < kVariables; ++k) form.coefficient[k] = Real(0.0);
    return form;
  }

  AffineForm& operator+=(const AffineForm& other) { return *this = *this + other; }
  AffineForm& operator-=(const AffineForm& other) { return *this = *this - other; }
  template <typename Number>
  AffineForm& operator*=(const Number& factor) {
    return *this = *this * factor;
  }

  friend AffineForm operator+(const AffineForm& a, const AffineForm& b) {
    AffineForm sum;
    sum.constant = a.constant + b.constant;
    for (int k = 0; k < kVariables; ++k) sum.coefficient[k] = a.coefficient[k] + b.coefficient[k];
    return sum;
  }
  friend AffineForm operator-(const AffineForm& a, const AffineForm& b) {
    AffineForm difference;
    difference.constant = a.constant - b.constant;
    for (int k = 0; k < kVariables; ++k) {
      difference.coefficient[k] = a.coefficient[k] - b.coefficient[k];
    }
    return difference;
  }
  friend AffineForm operator-(const AffineForm& a) { return -1.0 * a; }
  template <typename Number>
  friend AffineForm operator+(AffineForm a, const Number& b) {
    a.constant = a.constant + b;
    return a;
  }
  template <typename Number>
  friend AffineForm operator+(const Number& b, const AffineForm& a) {
    return a + b;
  }
  template <typename Number>
  friend AffineForm operator-(AffineForm a, const Number& b) {
    a.constant = a.constant - b;
    return a;
  }
  template <typename Number>
  friend AffineForm operator-(const Number& b, const AffineForm& a) {
    return -a + b;
  }
  template <typename Number>
  friend AffineForm operator*(AffineForm a, const Number& factor) {
    a.constant = a.constant * factor;
    for (Real& c : a.coefficient) c = c * factor;
    return a;
  }
  template <typename Number>
  friend AffineForm operator*(const Number& factor, const AffineForm& a) {
    return a * factor;
  }
  template <typename Number>
  friend AffineForm operator/(AffineForm a, const Number& divisor) {
    a.constant = a.constant / divisor;
    for (Real& c : a.coefficient) c = c / divisor;
    return a;
  }

  Real constant;
  Real coefficient[kVariables];
};

}  // namespace batten

#endif  // BATTEN_COST_FUNCTIONS_AFFINE_FORM_H_
