#include "splines/bspline_basis.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "splines/basis_functions.h"
#include "tests/not_a_number.h"
#include "tests/splines/example_splines.h"

namespace batten {
namespace {

const double kInfinity = std::numeric_limits<double>::infinity();

std::string WhyRefused(int degree, bool periodic, const std::vector<double>& knots) {
  std::string error;
  EXPECT_FALSE(BsplineBasis::Make(degree, periodic, knots, &error).has_value());
  return error;
}

TEST(BsplineBasis, OpenKnotsGiveTheNumbersOfTheBook) {
  const BsplineBasis basis =
      BasisOf(2, false, {0, 0, 0, 1, 2, 3, 4, 4, 5, 5, 5});  // NURBS Book ex 2.1
  EXPECT_EQ(basis.num_control_points(), 8);
  EXPECT_EQ(basis.order(), 3);
  EXPECT_EQ(basis.domain_begin(), 0.0);
  EXPECT_EQ(basis.domain_end(), 5.0);
  EXPECT_EQ(basis.first_span(), 2);
  EXPECT_EQ(basis.last_span(), 7);
  EXPECT_EQ(basis.FindSpan(2.5), 4);  // NURBS Book ex 2.3
  EXPECT_EQ(basis.FindSpan(4.0), 7);
  EXPECT_EQ(basis.FindSpan(5.0), 7);
}

TEST(BsplineBasis, PeriodicKnotsGiveOneSpanPerControlPoint) {
  const BsplineBasis basis = BasisOf(2, true, {-3, -1, 0, 1, 3, 4, 5, 7});
  EXPECT_EQ(basis.num_control_points(), 3);
  EXPECT_EQ(basis.num_domain_spans(), 3);
  EXPECT_EQ(basis.domain_begin(), 0.0);
  EXPECT_EQ(basis.domain_end(), 4.0);
  EXPECT_EQ(basis.ControlPointIndex(2), 2);
  EXPECT_EQ(basis.ControlPointIndex(3), 0);
  EXPECT_EQ(basis.ControlPointIndex(4), 1);
}

TEST(BsplineBasis, OneControlPointStandsForAllFunctionsOfAPeriodicSpan) {
  const BsplineBasis basis = BasisOf(3, true, {-3, -2, -1, 0, 1, 2, 3, 4});
  EXPECT_EQ(basis.num_control_points(), 1);
  for (int function = 0; function <= 3; ++function) {
    EXPECT_EQ(basis.ControlPointIndex(function), 0);
  }
}

TEST(BsplineBasis, RefusesDegreesOutsideOneToNine) {
  EXPECT_EQ(WhyRefused(0, false, {0, 1}), "degree is 0, must be 1 to 9");
  EXPECT_EQ(WhyRefused(-3, true, {0, 1}), "degree is -3, must be 1 to 9");
  EXPECT_EQ(WhyRefused(10, false, std::vector<double>(40, 0.0)), "degree is 10, must be 1 to 9");
}

TEST(BsplineBasis, RefusesTooFewKnots) {
  EXPECT_EQ(WhyRefused(3, false, {}),
            "there are 0 knots, an open spline of degree 3 needs at least 8");
  EXPECT_EQ(WhyRefused(3, true, {0, 1, 2, 3, 4, 5, 6}),
            "there are 7 knots, a periodic spline of degree 3 needs at least 8");
}

TEST(BsplineBasis, RefusesDecreasingKnots) {
  EXPECT_EQ(WhyRefused(1, false, {0, 0, 0.5, 0.25, 1, 1}),
            "knot 3 is 0.25, below knot 2, 0.5; knots must not decrease");
}

TEST(BsplineBasis, RefusesKnotsThatAreNotFinite) {
  EXPECT_EQ(WhyRefused(1, false, {0, 0, kNan, 1, 1}), "knot 2 is nan, knots must be finite");
  EXPECT_EQ(WhyRefused(1, false, {0, 0, 1, kInfinity}), "knot 3 is inf, knots must be finite");
}

TEST(BsplineBasis, RefusesKnotsWhoseDifferencesOverflow) {
  EXPECT_EQ(WhyRefused(1, false, {-1e308, -1e308, 1e308, 1e308}),
            "knots reach from -1e+308 to 1e+308, farther than a double can hold; scale them down");
  EXPECT_NE(WhyRefused(1, false, {0, 0, 1e-310, 1, 1}).find("too little to divide by"),
            std::string::npos);
}

TEST(BsplineBasis, RefusesAnEmptyDomain) {
  EXPECT_EQ(WhyRefused(2, false, {0, 0, 1, 1, 2, 2}),
            "knots 2 to 3 are all 1; the domain between them must not be empty");
}

TEST(BsplineBasis, RefusesInnerKnotsRepeatedMoreThanTheDegree) {
  EXPECT_EQ(WhyRefused(2, false, {0, 0, 0, 1, 1, 1, 2, 2, 2}),
            "knot 3, 1, stands 3 times, must be at most 2 times (the degree) inside the domain");
  EXPECT_EQ(WhyRefused(1, true, {-1, 0, 0, 1, 1}),
            "knot 1, 0, stands 2 times, must be at most 1 times (the degree) inside the domain");
}

TEST(BsplineBasis, RefusesEndKnotsRepeatedMoreThanTheOrder) {
  EXPECT_EQ(WhyRefused(2, false, {0, 0, 0, 0, 1, 2, 2, 2}),
            "knot 0, 0, stands 4 times, must be at most 3 times (the order)");
}

TEST(BsplineBasis, RefusesKnotsThatDoNotRepeatWithThePeriod) {
  EXPECT_EQ(WhyRefused(1, true, {-1, 0, 1, 2, 3.5}),
            "knots 2 and 4 are 2.5 apart, the period is 2; periodic knots must repeat with the "
            "period");
}

TEST(BsplineBasis, ErrorMayBeNull) {
  EXPECT_FALSE(BsplineBasis::Make(0, false, {}, nullptr).has_value());
}

TEST(BsplineBasis, AcceptsPeriodicKnotsRoundedFarFromZero) {
  // At 1e6 neighbouring doubles are 1.2e-10 apart, and each knot was rounded once.
  std::vector<double> knots;
  for (int k = -3; k <= 10; ++k) knots.push_back(1e6 + k * 0.1);
  BasisOf(3, true, knots);
}

TEST(BsplineBasis, WrapStaysBelowTheEndOfThePeriodAfterRounding) {
  const BsplineBasis basis = BasisOf(1, true, {-1, 0, 1, 2});
  ASSERT_EQ(basis.domain_end(), 1.0);
  for (const double t : {-1e-20, -1e-300, -0.0, 1.0, 3.0, -5.0, 1e17, -1e300}) {
    EXPECT_GE(basis.Wrap(t), 0.0) << t;
    EXPECT_LT(basis.Wrap(t), 1.0) << t;
  }
  EXPECT_EQ(basis.Wrap(2.25), 0.25);
  EXPECT_EQ(basis.Wrap(-0.25), 0.75);
  EXPECT_EQ(basis.Wrap(-7.25), 0.75);
  EXPECT_TRUE(std::isnan(basis.Wrap(kNan)));
  EXPECT_TRUE(std::isnan(basis.Wrap(kInfinity)));
}

TEST(BsplineBasis, WrapClampsOnOpenSplines) {
  const BsplineBasis basis = BasisOf(1, false, {0, 0, 1, 1});
  EXPECT_EQ(basis.Wrap(-0.5), 0.0);
  EXPECT_EQ(basis.Wrap(kInfinity), 1.0);
  EXPECT_EQ(basis.Wrap(0.3), 0.3);
  EXPECT_TRUE(std::isnan(basis.Wrap(kNan)));
}

TEST(BsplineBasis, FindSpanNeverReturnsAnEmptySpan) {
  // Empty spans inside, and at both ends of the domain although the end knots are simple outside.
  const BsplineBasis basis = BasisOf(3, false, {-2, -1, 0, 0, 0, 1, 1, 1, 2, 3, 3, 3, 4, 5});
  ASSERT_EQ(basis.domain_begin(), 0.0);
  ASSERT_EQ(basis.domain_end(), 3.0);
  for (const double t : {-kInfinity, -3.0, 0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 7.0, kNan}) {
    for (int hint = -5; hint < 20; ++hint) {
      const int span = basis.FindSpanFrom(hint, t);
      EXPECT_LT(basis.knots()[span], basis.knots()[span + 1]) << t;
      EXPECT_EQ(span, basis.FindSpan(t)) << t << " from " << hint;
    }
  }
  EXPECT_EQ(basis.FindSpan(0.0), 4);
  EXPECT_EQ(basis.FindSpan(1.0), 7);
  EXPECT_EQ(basis.FindSpan(3.0), 8);
}

TEST(BsplineBasis, GrevilleAbscissasAreMeansOfInnerKnots) {
  const BsplineBasis open = BasisOf(3, false, {0, 0, 0, 0, 1, 3, 3, 3, 3});
  const double expected[] = {0.0, 1.0 / 3.0, 4.0 / 3.0, 7.0 / 3.0, 3.0};
  for (int j = 0; j < 5; ++j) EXPECT_DOUBLE_EQ(open.Greville(j), expected[j]);
  // Uniform: the middle of the support u_j..u_(j+p+1), j = 0 and 1 from before the seam.
  const BsplineBasis closed = BasisOf(3, true, {-3, -2, -1, 0, 1, 2, 3, 4, 5, 6, 7});
  const double wrapped[] = {3.0, 0.0, 1.0, 2.0};
  for (int j = 0; j < 4; ++j) EXPECT_EQ(closed.Greville(j), wrapped[j]);
}

TEST(BsplineBasis, GrevilleAbscissasOfEndPointsStayOnTheEnds) {
  // 7 * 0.7 / 7 rounds to something else than 0.7.
  for (int p = 1; p <= kMaxDegree; ++p) {
    std::vector<double> knots(p + 1, 0.1);
    knots.resize(2 * p + 2, 0.7);
    const BsplineBasis basis = BasisOf(p, false, knots);
    EXPECT_EQ(basis.Greville(0), 0.1);
    EXPECT_EQ(basis.Greville(p), 0.7);
  }
}

class EveryBsplineBasis : public ::testing::TestWithParam<SplineKind> {
 protected:
  std::mt19937 random_{20240502};
  const std::vector<BsplineBasis> bases_ = MakeBases(GetParam(), &random_);
};

TEST_P(EveryBsplineBasis, FindsTheSpanThatHoldsTheParameter) {
  for (const BsplineBasis& basis : bases_) {
    SCOPED_TRACE(basis.num_control_points());
    const std::vector<double>& u = basis.knots();
    for (int trial = 0; trial < 200; ++trial) {
      // Every other time a knot itself.
      double t = RandomParameter(basis, &random_);
      if (trial % 2 == 0) t = u[basis.first_span() + trial / 2 % basis.num_domain_spans()];
      const int span = basis.FindSpan(t);
      ASSERT_GE(span, basis.first_span());
      ASSERT_LE(span, basis.last_span());
      EXPECT_LE(u[span], t);
      EXPECT_LT(t, u[span + 1]);
      EXPECT_EQ(basis.FindSpanFrom(static_cast<int>(random_() % u.size()), t), span);
    }
  }
}

TEST_P(EveryBsplineBasis, WrapMovesByWholePeriodsOrClamps) {
  for (const BsplineBasis& basis : bases_) {
    SCOPED_TRACE(basis.num_control_points());
    const double begin = basis.domain_begin();
    const double length = basis.domain_length();
    for (const double turns : {-3.0, -1.0, 0.0, 1.0, 2.0}) {
      for (const double fraction : {0.0, 1e-17, 0.31, 0.999}) {
        const double inside = begin + fraction * length;
        const double wrapped = basis.Wrap(inside + turns * length);
        EXPECT_GE(wrapped, begin);
        if (basis.periodic()) {
          EXPECT_LT(wrapped, basis.domain_end());
          // Two roundings of a number that is at most |begin| + 4 periods; the seam may be crossed.
          const double tolerance = 2 * kEpsilon * (std::abs(begin) + 4 * length);
          const double distance = std::abs(wrapped - inside);
          EXPECT_LE(std::min(distance, length - distance), tolerance);
        } else {
          EXPECT_LE(wrapped, basis.domain_end());
        }
      }
    }
  }
}

TEST_P(EveryBsplineBasis, GrevilleAbscissasReproduceTheParameter) {
  for (const BsplineBasis& basis : bases_) {
    SCOPED_TRACE(basis.num_control_points());
    // sum_j g_j N_j(t) = t, g_j the means that Greville() returns before wrapping.
    const int p = basis.degree();
    for (int trial = 0; trial < 20; ++trial) {
      const double t = RandomParameter(basis, &random_);
      const int span = basis.FindSpan(t);
      double values[kMaxOrder];
      EvaluateBasis(p, basis.knots().data(), span, t, values);
      double sum = 0.0;
      for (int j = 0; j <= p; ++j) {
        const int function = span - p + j;
        double greville = basis.Greville(basis.ControlPointIndex(function));
        if (basis.periodic()) {
          // Whole periods away from the mean of this function's own knots, which is less than one
          // half off after rounding.
          double mean = 0.0;
          for (int i = 1; i <= p; ++i) mean += basis.knots()[function + i] / p;
          greville += std::round((mean - greville) / basis.domain_length()) * basis.domain_length();
        }
        sum += greville * values[j];
      }
      const double size = std::abs(basis.knots().front()) + std::abs(basis.knots().back());
      // Some 4 roundings per level in the values, p in the means.
      EXPECT_NEAR(sum, t, 5 * (p + 1) * kEpsilon * size);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Splines, EveryBsplineBasis, ::testing::ValuesIn(AllSplineKinds()), NameOf);

}  // namespace
}  // namespace batten
