#ifndef BATTEN_SPLINES_BASIS_FUNCTIONS_H_
#define BATTEN_SPLINES_BASIS_FUNCTIONS_H_

#include "splines/points.h"

namespace batten {

/// The p + 1 basis functions that are not zero on span k, at t: values[j] = N_(k-p+j),p(t),
/// j = 0..p. Cox-de Boor recursion in the order of Piegl & Tiller, algorithm A2.2. `knots` is the
/// whole knot vector; span k must not be empty. T is a double, an automatic differentiation scalar
/// or a pack of doubles whose entries lie in the same span. kDegree >= 0 fixes the degree at
/// compile time, -1 takes `degree`. Outside the span the polynomials of the span are continued.
template <int kDegree = -1, typename T>
inline void EvaluateBasis(int degree, const double* knots, int span, const T& t, T* values) {
  constexpr int kStorage = kDegree >= 0 ? kDegree + 1 : kMaxOrder;
  const int p = kDegree >= 0 ? kDegree : degree;
  const double* u = knots + span;
  T left[kStorage];
  T right[kStorage];
  values[0] = T(1.0) + 0.0 * t;
  for (int r = 1; r <= p; ++r) {
    left[r] = t - u[1 - r];
    right[r] = u[r] - t;
    T saved = 0.0 * t;
    for (int j = 0; j < r; ++j) {
      // The difference of the two knots, a plain number: exact where knots are repeated.
      const T part = values[j] * (1.0 / (u[j + 1] - u[1 - r + j]));
      values[j] = saved + right[j + 1] * part;
      saved = left[r - j] * part;
    }
    values[r] = saved;
  }
}

/// Derivatives 0..max_derivative of the p + 1 basis functions of span k, with respect to t:
/// values[d * (p + 1) + j] = d-th derivative of N_(k-p+j),p at t; zero for d > p. Each comes from
/// the basis of degree p - d by differencing d times (Piegl & Tiller, eq. 2.9).
template <int kDegree = -1, typename T>
inline void EvaluateBasisDerivatives(int degree, const double* knots, int span, const T& t,
                                     int max_derivative, T* values) {
  const int p = kDegree >= 0 ? kDegree : degree;
  EvaluateBasis<kDegree>(p, knots, span, t, values);
  const double* u = knots + span;
  for (int d = 1; d <= max_derivative; ++d) {
    T* row = values + d * (p + 1);
    for (int j = 0; j <= p; ++j) row[j] = 0.0 * t;
    if (d > p) continue;
    EvaluateBasis<-1>(p - d, knots, span, t, row);
    for (int q = p - d + 1; q <= p; ++q) {
      // From degree q - 1 (functions k-q+1..k, stored at 0..q-1) to degree q (k-q..k).
      T previous = 0.0 * t;
      for (int j = 0; j <= q; ++j) {
        const T current = j < q ? row[j] * (q / (u[j + 1] - u[j + 1 - q])) : T(0.0 * t);
        row[j] = previous - current;
        previous = current;
      }
    }
  }
}

}  // namespace batten

#endif  // BATTEN_SPLINES_BASIS_FUNCTIONS_H_
