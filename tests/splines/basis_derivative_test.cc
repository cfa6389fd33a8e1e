#include "splines/basis_derivative.h"

#include <gtest/gtest.h>

#include "tests/splines/example_splines.h"

namespace batten {
namespace {

template <int kDegree, int kDerivative>
void ExpectOneRowOfAll(const BsplineBasis& basis, std::mt19937* random) {
  const int p = basis.degree();
  for (const int span : NonEmptySpans(basis)) {
    const double t = InSpan(basis, span, RandomBetween(0.0, 1.0, random));
    double all[4 * kMaxOrder];
    double one[kMaxOrder];
    EvaluateBasisDerivatives(p, basis.knots().data(), span, t, 3, all);
    SpanBasisDerivative<kDegree, kDerivative>(p, basis.knots().data(), span).Evaluate(t, one);
    for (int j = 0; j <= p; ++j) {
      const double expected = all[kDerivative * (p + 1) + j];
      // Fixed loops may be contracted otherwise.
      EXPECT_NEAR(one[j], expected, 16 * kEpsilon * (1.0 + std::abs(expected)));
    }
  }
}

TEST(BasisDerivative, IsOneRowOfAllDerivatives) {
  std::mt19937 random(20250801);
  for (const SplineKind& kind : AllSplineKinds()) {
    for (const BsplineBasis& basis : MakeBases(kind, &random)) {
      ExpectOneRowOfAll<-1, 1>(basis, &random);
      ExpectOneRowOfAll<-1, 2>(basis, &random);
      ExpectOneRowOfAll<-1, 3>(basis, &random);
      if (kind.degree == 3) ExpectOneRowOfAll<3, 2>(basis, &random);
      if (kind.degree == 3) ExpectOneRowOfAll<3, 3>(basis, &random);
      if (kind.degree == 2) ExpectOneRowOfAll<2, 1>(basis, &random);
    }
  }
}

}  // namespace
}  // namespace batten
