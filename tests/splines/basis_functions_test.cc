#include "splines/basis_functions.h"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "tests/splines/example_splines.h"

namespace batten {
namespace {

// About four roundings in each of the p levels, on terms <= 1.
double RoundingOfBasis(int degree) { return 4.0 * (degree + 1) * kEpsilon; }

TEST(BasisFunctions, UniformCubicAtAKnotIsOneFourOneSixths) {
  const double knots[] = {0, 1, 2, 3, 4, 5, 6, 7};
  double values[4];
  EvaluateBasis(3, knots, 3, 3.0, values);
  EXPECT_NEAR(values[0], 1.0 / 6.0, RoundingOfBasis(3));
  EXPECT_NEAR(values[1], 4.0 / 6.0, RoundingOfBasis(3));
  EXPECT_NEAR(values[2], 1.0 / 6.0, RoundingOfBasis(3));
  EXPECT_EQ(values[3], 0.0);
}

TEST(BasisFunctions, UniformCubicDerivativesAtAKnotAreTheDifferenceStencils) {
  const double knots[] = {0, 1, 2, 3, 4, 5, 6, 7};
  const double expected[] = {1.0 / 6, 4.0 / 6, 1.0 / 6, 0,  // value
                             -0.5,    0,       0.5,     0,  // central difference
                             1,       -2,      1,       0,  // second difference
                             -1,      3,       -3,      1,  // third difference
                             0,       0,       0,       0};
  double values[20];
  EvaluateBasisDerivatives(3, knots, 3, 3.0, 4, values);
  for (int k = 0; k < 20; ++k) EXPECT_NEAR(values[k], expected[k], 4 * RoundingOfBasis(3)) << k;
}

TEST(BasisFunctions, AreBernsteinPolynomialsWithoutInnerKnots) {
  const double t = 0.3;
  for (int p = 1; p <= kMaxDegree; ++p) {
    std::vector<double> knots(p + 1, 0.0);
    knots.resize(2 * p + 2, 1.0);
    double values[kMaxOrder];
    EvaluateBasis(p, knots.data(), p, t, values);
    double binomial = 1.0;
    for (int j = 0; j <= p; ++j) {
      EXPECT_NEAR(values[j], binomial * std::pow(t, j) * std::pow(1.0 - t, p - j),
                  2 * RoundingOfBasis(p));
      binomial *= static_cast<double>(p - j) / (j + 1);
    }
  }
}

// SciPy 1.10:
//   u = [0, 0.1, 0.25, 0.3, 0.6, 0.8, 1.0, 1.5, 1.6, 2.0]
//   for d in range(5): print([BSpline(np.array(u), np.eye(5)[j], 4)(0.67, d) for j in range(5)])
TEST(BasisFunctions, QuarticValuesAndDerivativesMatchScipy) {
  const double knots[] = {0, 0.1, 0.25, 0.3, 0.6, 0.8, 1.0, 1.5, 1.6, 2.0};
  const double expected[5][5] = {{0.007418441558441555, 0.24897915584415578, 0.5959710401635403,
                                  0.14729789021164033, 0.00033347222222222323},
                                 {-0.22825974025974013, -2.3954025974025974, 1.0791491101491093,
                                  1.5254576719576727, 0.019055555555555596},
                                 {5.267532467532465, 7.4103896103896165, -22.9937950937951,
                                  9.499206349206348, 0.8166666666666678},
                                 {-81.038961038961, 176.103896103896, -87.76334776334767,
                                  -30.634920634920682, 23.333333333333346},
                                 {623.376623376623, -2233.7662337662323, 2531.02453102453,
                                  -1253.9682539682535, 333.3333333333332}};
  double values[25];
  EvaluateBasisDerivatives(4, knots, 4, 0.67, 4, values);
  for (int d = 0; d <= 4; ++d) {
    double largest = 0.0;
    for (const double value : expected[d]) largest = std::max(largest, std::abs(value));
    // Each derivative differences numbers of the size of its largest entry: twice the roundings,
    // SciPy's and ours.
    const double tolerance = 2 * RoundingOfBasis(4) * (d + 1) * largest;
    for (int j = 0; j < 5; ++j) EXPECT_NEAR(values[d * 5 + j], expected[d][j], tolerance);
  }
}

TEST(BasisFunctions, FixedAndRuntimeDegreeAgree) {
  const double knots[] = {0, 0.1, 0.25, 0.3, 0.6, 0.8, 1.0, 1.5};
  double fixed[16];
  double runtime[16];
  EvaluateBasisDerivatives<3>(3, knots, 3, 0.4, 3, fixed);
  EvaluateBasisDerivatives(3, knots, 3, 0.4, 3, runtime);
  for (int k = 0; k < 16; ++k) EXPECT_DOUBLE_EQ(fixed[k], runtime[k]) << k;
}

TEST(BasisFunctions, JetsCarryTheDerivativeByTheParameter) {
  using Jet = ceres::Jet<double, 2>;
  const double knots[] = {0, 0.1, 0.25, 0.3, 0.6, 0.8, 1.0, 1.5, 1.6, 2.0};
  Jet values[3 * 5];
  EvaluateBasisDerivatives(4, knots, 4, Jet(0.67, 1), 2, values);
  double expected[4 * 5];
  EvaluateBasisDerivatives(4, knots, 4, 0.67, 3, expected);
  for (int k = 0; k < 15; ++k) {
    // The third derivative has entries near 200, each from a handful of rounded terms that size.
    const double tolerance = 400 * RoundingOfBasis(4);
    EXPECT_NEAR(values[k].a, expected[k], tolerance) << k;
    EXPECT_EQ(values[k].v[0], 0.0);
    EXPECT_NEAR(values[k].v[1], expected[k + 5], tolerance) << k;
  }
}

// The least a pack of parameters has to offer.
struct Pack {
  Pack() = default;
  explicit Pack(double value) { lanes.fill(value); }
  std::array<double, 4> lanes;
};
template <typename Operation>
Pack Lanewise(const Pack& a, const Pack& b, Operation operation) {
  Pack result;
  for (int i = 0; i < 4; ++i) result.lanes[i] = operation(a.lanes[i], b.lanes[i]);
  return result;
}
Pack operator+(const Pack& a, const Pack& b) { return Lanewise(a, b, std::plus<>()); }
Pack operator-(const Pack& a, const Pack& b) { return Lanewise(a, b, std::minus<>()); }
Pack operator*(const Pack& a, const Pack& b) { return Lanewise(a, b, std::multiplies<>()); }
Pack operator+(double a, const Pack& b) { return Pack(a) + b; }
Pack operator-(const Pack& a, double b) { return a - Pack(b); }
Pack operator-(double a, const Pack& b) { return Pack(a) - b; }
Pack operator*(const Pack& a, double b) { return a * Pack(b); }
Pack operator*(double a, const Pack& b) { return Pack(a) * b; }

TEST(BasisFunctions, PacksOfParametersGiveWhatSingleOnesGive) {
  const double knots[] = {0, 0.1, 0.25, 0.3, 0.6, 0.8, 1.0, 1.5};
  Pack t;
  t.lanes = {0.3, 0.41, 0.52, 0.599};
  Pack values[8];
  EvaluateBasisDerivatives<3>(3, knots, 3, t, 1, values);
  Pack prepared[4];
  SpanBasis<3, Pack>(3, knots, 3).Evaluate(t, prepared);
  for (int lane = 0; lane < 4; ++lane) {
    double expected[8];
    EvaluateBasisDerivatives<3>(3, knots, 3, t.lanes[lane], 1, expected);
    for (int k = 0; k < 8; ++k) EXPECT_DOUBLE_EQ(values[k].lanes[lane], expected[k]);
    for (int k = 0; k < 4; ++k) EXPECT_DOUBLE_EQ(prepared[k].lanes[lane], expected[k]);
  }
}

TEST(BasisFunctions, NanParameterGivesNanInEveryRowUpToTheDegree) {
  const double knots[] = {0, 0, 0, 1, 1, 1};
  double values[9];
  EvaluateBasisDerivatives(2, knots, 2, std::nan(""), 2, values);
  for (int k = 0; k < 9; ++k) EXPECT_TRUE(std::isnan(values[k])) << k;
}

class EveryBasis : public ::testing::TestWithParam<SplineKind> {
 protected:
  std::mt19937 random_{20240501};
  const std::vector<BsplineBasis> bases_ = MakeBases(GetParam(), &random_);
  const int p_ = GetParam().degree;
};

TEST_P(EveryBasis, EqualsItsRecursiveDefinition) {
  for (const BsplineBasis& basis : bases_) {
    SCOPED_TRACE(basis.num_control_points());
    for (const int span : NonEmptySpans(basis)) {
      for (const double fraction : {0.0, 1e-8, 0.37, 0.9}) {
        const double t = InSpan(basis, span, fraction);
        double values[kMaxOrder];
        EvaluateBasis(p_, basis.knots().data(), span, t, values);
        for (int j = 0; j <= p_; ++j) {
          const long double exact = BasisByDefinition(basis.knots(), span - p_ + j, p_, t);
          EXPECT_NEAR(values[j], static_cast<double>(exact), RoundingOfBasis(p_));
        }
      }
    }
  }
}

TEST_P(EveryBasis, IsAPartitionOfUnityWithoutNegativeParts) {
  for (const BsplineBasis& basis : bases_) {
    SCOPED_TRACE(basis.num_control_points());
    for (const int span : NonEmptySpans(basis)) {
      for (const double fraction : {0.0, 1e-8, 0.37, 1.0}) {
        double values[2 * kMaxOrder];
        EvaluateBasisDerivatives(p_, basis.knots().data(), span, InSpan(basis, span, fraction), 1,
                                 values);
        double sum = 0.0;
        double sum_of_slopes = 0.0;
        double largest_slope = 0.0;
        for (int j = 0; j <= p_; ++j) {
          EXPECT_GE(values[j], 0.0);
          sum += values[j];
          sum_of_slopes += values[p_ + 1 + j];
          largest_slope = std::max(largest_slope, std::abs(values[p_ + 1 + j]));
        }
        EXPECT_NEAR(sum, 1.0, RoundingOfBasis(p_));
        EXPECT_NEAR(sum_of_slopes, 0.0, 2 * RoundingOfBasis(p_) * largest_slope);
      }
    }
  }
}

TEST_P(EveryBasis, ReproducesPolynomialsByMarsdensIdentity) {
  for (const BsplineBasis& basis : bases_) {
    SCOPED_TRACE(basis.num_control_points());
    // (x - t)^p = sum_j prod_(i=1..p) (x - u_(j+i)) N_j(t), for every x.
    for (const int span : NonEmptySpans(basis)) {
      const double t = InSpan(basis, span, 0.61);
      double values[kMaxOrder];
      EvaluateBasis(p_, basis.knots().data(), span, t, values);
      for (const double x : {t, t + 0.5, t - 2.0}) {
        double sum = 0.0;
        double size = 0.0;
        for (int j = 0; j <= p_; ++j) {
          double product = 1.0;
          for (int i = 1; i <= p_; ++i) product *= x - basis.knots()[span - p_ + j + i];
          sum += product * values[j];
          size = std::max(size, std::abs(product));
        }
        // Both the products and the values are rounded about 4 p times.
        EXPECT_NEAR(sum, std::pow(x - t, p_), 2 * RoundingOfBasis(p_) * size);
      }
    }
  }
}

// ||(f(t + h) - f(t - h)) / 2h - f'(t)|| over all functions f that are (order - 1)-th derivatives.
// It is h^2 ||f'''(t)|| / 6 + O(h^4); in the norm no f''' can vanish by chance.
double DifferenceError(const BsplineBasis& basis, int span, double t, int order, double h) {
  const int p = basis.degree();
  double center[kMaxOrder * kMaxOrder];
  double left[kMaxOrder * kMaxOrder];
  double right[kMaxOrder * kMaxOrder];
  EvaluateBasisDerivatives(p, basis.knots().data(), span, t, order, center);
  EvaluateBasisDerivatives(p, basis.knots().data(), span, t - h, order, left);
  EvaluateBasisDerivatives(p, basis.knots().data(), span, t + h, order, right);
  double sum = 0.0;
  for (int j = 0; j <= p; ++j) {
    const int below = (order - 1) * (p + 1) + j;
    sum += std::pow((right[below] - left[below]) / (2 * h) - center[below + p + 1], 2);
  }
  return std::sqrt(sum);
}

TEST_P(EveryBasis, DerivativesAreDifferencesOfSecondOrder) {
  for (const BsplineBasis& basis : bases_) {
    SCOPED_TRACE(basis.num_control_points());
    const int span = NonEmptySpans(basis).front();
    const double length = basis.knots()[span + 1] - basis.knots()[span];
    const double t = InSpan(basis, span, 0.43);
    for (int d = 1; d + 2 <= p_; ++d) {
      // Short enough for h^4, long enough for rounding: eps / (h / length)^3 is below 1e-8.
      const double h = length / 128;
      const double order = std::log2(DifferenceError(basis, span, t, d, h) /
                                     DifferenceError(basis, span, t, d, h / 2));
      EXPECT_NEAR(order, 2.0, 0.05) << "derivative " << d;
    }
    for (int d = std::max(1, p_ - 1); d <= p_; ++d) {
      // What is differenced is at most a quadratic, so that only its rounding remains; by the
      // formula of differences it is below (2 p / length)^(d - 1).
      const double h = length / 4;
      const double size = std::pow(2.0 * p_ / length, d - 1);
      EXPECT_LT(DifferenceError(basis, span, t, d, h), RoundingOfBasis(p_) * size / h) << d;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Splines, EveryBasis, ::testing::ValuesIn(AllSplineKinds()), NameOf);

}  // namespace
}  // namespace batten
