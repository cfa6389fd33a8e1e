#ifndef BATTEN_SPLINES_BASIS_FUNCTIONS_H_
#define BATTEN_SPLINES_BASIS_FUNCTIONS_H_

#include "splines/points.h"

namespace batten {

/// One span of a basis, prepared for many parameters: its knots and the reciprocals of their
/// differences, so that a parameter costs no division. Cox-de Boor recursion in the order of
/// Piegl & Tiller, algorithm A2.2. kDegree >= 0 fixes the degree at compile time, -1 takes
/// `degree`. Constant is what knots are kept as: a double, or a pack of equal ones.
template <int kDegree = -1, typename Constant = double>
class SpanBasis {
 public:
  /// `knots` is the whole knot vector; span k must not be empty.
  SpanBasis(int degree, const double* knots, int span) : degree_(degree) {
    const double* u = knots + span;
    Constant* reciprocal = reciprocals_;
    for (int r = 1; r <= p(); ++r) {
      right_[r] = Constant(u[r]);
      left_[r] = Constant(u[1 - r]);
      // The difference of the two knots, a plain number: exact where knots are repeated.
      for (int j = 0; j < r; ++j) *reciprocal++ = Constant(1.0 / (u[j + 1] - u[1 - r + j]));
    }
  }

  /// values[j] = N_(k-p+j),p(t), j = 0..p. T is a double, an automatic differentiation scalar or a
  /// pack of doubles. Outside the span its polynomials are continued. Inlined at any size: as a
  /// call for each pack, the values go through memory and rows take twice as long.
  template <typename T>
  inline __attribute__((always_inline)) void Evaluate(const T& t, T* values) const {
    T left[kStorage];
    T right[kStorage];
    const Constant* reciprocal = reciprocals_;
    left[1] = t - left_[1];
    right[1] = right_[1] - t;
    // Degree 1 starts the recursion: the one function of degree 0 is 1.
    values[0] = right[1] * *reciprocal;
    values[1] = left[1] * *reciprocal++;
    for (int r = 2; r <= p(); ++r) {
      left[r] = t - left_[r];
      right[r] = right_[r] - t;
      T saved = left[r] * (values[0] * *reciprocal);
      values[0] = right[1] * (values[0] * *reciprocal++);
      for (int j = 1; j < r; ++j) {
        const T part = values[j] * *reciprocal++;
        values[j] = saved + right[j + 1] * part;
        saved = left[r - j] * part;
      }
      values[r] = saved;
    }
  }

 private:
  static constexpr int kStorage = (kDegree >= 0 ? kDegree : kMaxDegree) + 1;
  int p() const { return kDegree >= 0 ? kDegree : degree_; }

  int degree_;
  Constant left_[kStorage];
  Constant right_[kStorage];
  Constant reciprocals_[kStorage * (kStorage - 1) / 2];
};

/// The p + 1 basis functions that are not zero on span k, at t: values[j] = N_(k-p+j),p(t),
/// j = 0..p; p = 0 gives the one. See SpanBasis for `knots`, T and kDegree.
template <int kDegree = -1, typename T>
inline void EvaluateBasis(int degree, const double* knots, int span, const T& t, T* values) {
  if (kDegree == 0 || (kDegree < 0 && degree == 0)) {
    values[0] = 1.0 + 0.0 * t;
    return;
  }
  SpanBasis<kDegree>(degree, knots, span).Evaluate(t, values);
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
