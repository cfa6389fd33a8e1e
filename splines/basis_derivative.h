#ifndef BATTEN_SPLINES_BASIS_DERIVATIVE_H_
#define BATTEN_SPLINES_BASIS_DERIVATIVE_H_

#include "splines/basis_functions.h"

namespace batten {

/// One derivative alone of the p + 1 basis functions of span k: values[j] = N^(d)_(k-p+j),p(t), as
/// EvaluateBasisDerivatives() has it in its row d, at a fraction of its cost. Both template numbers
/// are -1 where they are known at run time only.
template <int kDegree, int kDerivative, typename T>
inline void EvaluateBasisDerivative(int degree, const double* knots, int span, const T& t,
                                    T* values) {
  static_assert(kDerivative >= 0, "the derivative is known when compiling");
  const int p = kDegree >= 0 ? kDegree : degree;
  for (int j = 0; j <= p; ++j) values[j] = 0.0 * t;
  if (kDerivative > p) return;
  constexpr int kLowDegree = kDegree > kDerivative ? kDegree - kDerivative : -1;
  EvaluateBasis<kLowDegree>(p - kDerivative, knots, span, t, values);
  const double* u = knots + span;
  for (int q = p - kDerivative + 1; q <= p; ++q) {
    // From degree q - 1 (functions k-q+1..k, stored at 0..q-1) to degree q (k-q..k).
    T previous = 0.0 * t;
    for (int j = 0; j <= q; ++j) {
      const T current = j < q ? values[j] * (q / (u[j + 1] - u[j + 1 - q])) : T(0.0 * t);
      values[j] = previous - current;
      previous = current;
    }
  }
}

}  // namespace batten

#endif  // BATTEN_SPLINES_BASIS_DERIVATIVE_H_
