#ifndef BATTEN_SPLINES_BASIS_DERIVATIVE_H_
#define BATTEN_SPLINES_BASIS_DERIVATIVE_H_

#include "splines/basis_functions.h"

namespace batten {

/// One derivative alone of the p + 1 basis functions of a span k, prepared for several parameters
/// as SpanBasis is. Both template numbers are -1 where they are known at run time only; kDegree and
/// Constant as in SpanBasis.
template <int kDegree, int kDerivative, typename Constant = double>
class SpanBasisDerivative {
  static_assert(kDerivative > 0, "of order 0: SpanBasis");

 public:
  /// `knots` is the whole knot vector; span k must not be empty.
  SpanBasisDerivative(int degree, const double* knots, int span)
      : degree_(degree), low_(LowDegree(), knots, span) {
    const double* const u = knots + span;
    Constant* factor = factors_;
    for (int q = LowDegree() + 1; q <= p(); ++q) {
      for (int j = 0; j < q; ++j) *factor++ = Constant(q / (u[j + 1] - u[j + 1 - q]));
    }
  }

  /// values[j] = N^(d)_(k-p+j),p(t), j = 0..p, as EvaluateBasisDerivatives() has it in its row d;
  /// zero where d > p.
  template <typename T>
  inline __attribute__((always_inline)) void Evaluate(const T& t, T* values) const {
    const T zero = 0.0 * t;
    for (int j = 0; j <= p(); ++j) values[j] = zero;
    if (kDerivative > p()) return;
    if (LowDegree() == 0) {
      values[0] = 1.0 + zero;
    } else {
      low_.Evaluate(t, values);
    }
    const Constant* factor = factors_;
    for (int q = LowDegree() + 1; q <= p(); ++q) {
      // From degree q - 1 (functions k-q+1..k, stored at 0..q-1) to degree q (k-q..k).
      T previous = zero;
      for (int j = 0; j < q; ++j) {
        const T current = values[j] * *factor++;
        values[j] = previous - current;
        previous = current;
      }
      values[q] = previous - zero;
    }
  }

 private:
  static constexpr int kStorage = kDegree >= 0 ? kDegree : kMaxDegree;
  int p() const { return kDegree >= 0 ? kDegree : degree_; }
  int LowDegree() const { return p() > kDerivative ? p() - kDerivative : 0; }

  int degree_;
  SpanBasis<(kDegree > kDerivative ? kDegree - kDerivative : -1), Constant> low_;
  Constant factors_[kStorage * (kStorage + 1) / 2 + 1];
};

}  // namespace batten

#endif  // BATTEN_SPLINES_BASIS_DERIVATIVE_H_
