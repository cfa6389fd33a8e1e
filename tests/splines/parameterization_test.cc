#include "splines/parameterization.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "tests/splines/example_splines.h"

namespace batten {
namespace {

// Piegl & Tiller, example 9.1; chords 5, 4, 5, 3, and 5 from the last point back to the first.
Points BookPoints() {
  Points points(5, 2);
  points << 0, 0, 3, 4, -1, 4, -4, 0, -4, -3;
  return points;
}

constexpr Parameterization kAllRules[] = {
    Parameterization::kUniform, Parameterization::kChordLength, Parameterization::kCentripetal};

Eigen::VectorXd ParametersOf(Parameterization rule, bool closed, const Points& points) {
  std::string error;
  const auto parameters = Parameterize(rule, closed, points, &error);
  EXPECT_TRUE(parameters.has_value()) << error;
  return parameters.value();
}

std::string WhyRefused(Parameterization rule, bool closed, const Points& points) {
  std::string error;
  EXPECT_FALSE(Parameterize(rule, closed, points, &error).has_value());
  return error;
}

void ExpectParameters(const Eigen::VectorXd& actual, const std::vector<double>& expected) {
  // Rounded where lengths, sums and quotients are: four times, of numbers <= 1.
  const double tolerance = 4 * kEpsilon;
  ASSERT_EQ(actual.size(), static_cast<Eigen::Index>(expected.size()));
  for (Eigen::Index i = 0; i < actual.size(); ++i) EXPECT_NEAR(actual[i], expected[i], tolerance);
}

TEST(Parameterization, ChordLengthsGiveTheBooksExample) {
  ExpectParameters(ParametersOf(Parameterization::kChordLength, false, BookPoints()),
                   {0.0, 5.0 / 17.0, 9.0 / 17.0, 14.0 / 17.0, 1.0});
}

TEST(Parameterization, ClosedChordLengthsCountTheChordBackToTheFirstPoint) {
  ExpectParameters(ParametersOf(Parameterization::kChordLength, true, BookPoints()),
                   {0.0, 5.0 / 22.0, 9.0 / 22.0, 14.0 / 22.0, 17.0 / 22.0});
}

TEST(Parameterization, CentripetalStepsAreProportionalToRootsOfChords) {
  const double root_3 = std::sqrt(3.0);
  const double root_5 = std::sqrt(5.0);
  const double open = 2.0 * root_5 + 2.0 + root_3;
  ExpectParameters(ParametersOf(Parameterization::kCentripetal, false, BookPoints()),
                   {0.0, root_5 / open, (root_5 + 2.0) / open, (2.0 * root_5 + 2.0) / open, 1.0});
  const double closed = open + root_5;
  ExpectParameters(ParametersOf(Parameterization::kCentripetal, true, BookPoints()),
                   {0.0, root_5 / closed, (root_5 + 2.0) / closed, (2.0 * root_5 + 2.0) / closed,
                    open / closed});
}

TEST(Parameterization, UniformStepsIgnoreThePoints) {
  const Points equal = Points::Constant(5, 3, 2.0);
  ExpectParameters(ParametersOf(Parameterization::kUniform, false, equal),
                   {0.0, 0.25, 0.5, 0.75, 1.0});
  ExpectParameters(ParametersOf(Parameterization::kUniform, true, equal),
                   {0.0, 0.2, 0.4, 0.6, 0.8});
  ExpectParameters(ParametersOf(Parameterization::kUniform, true, Points::Zero(1, 2)), {0.0});
}

TEST(Parameterization, RepeatedPointsRepeatTheirParameter) {
  Points points(4, 1);
  points << 0, 1, 1, 3;
  ExpectParameters(ParametersOf(Parameterization::kChordLength, false, points),
                   {0.0, 1.0 / 3.0, 1.0 / 3.0, 1.0});
}

TEST(Parameterization, AClosedCurveWhoseFirstPointIsRepeatedEndsAtOne) {
  Points points(4, 2);
  points << 0, 0, 3, 0, 3, 4, 0, 0;
  ExpectParameters(ParametersOf(Parameterization::kChordLength, true, points),
                   {0.0, 3.0 / 12.0, 7.0 / 12.0, 1.0});
}

TEST(Parameterization, EndsAreExactAndStepsNeverNegativeInEveryDimension) {
  std::mt19937 random(20240504);
  for (int d = 1; d <= kMaxDimension; ++d) {
    for (const Parameterization rule : kAllRules) {
      for (const bool closed : {false, true}) {
        const Points points = RandomPoints(37, d, &random);
        const Eigen::VectorXd t = ParametersOf(rule, closed, points);
        EXPECT_EQ(t[0], 0.0);
        EXPECT_EQ(t[36] == 1.0, !closed);
        for (int i = 1; i < 37; ++i) EXPECT_GT(t[i], t[i - 1]);
      }
    }
  }
}

TEST(Parameterization, ScalingByAPowerOfTwoChangesNoBit) {
  // Odd powers as well, whose roots are irrational; and squares that would leave the doubles.
  std::mt19937 random(20240505);
  const Points points = RandomPoints(20, 3, &random);
  for (const Parameterization rule : kAllRules) {
    const Eigen::VectorXd t = ParametersOf(rule, true, points);
    for (const int exponent : {1, -7, 900, -900}) {
      const Points scaled = points * std::ldexp(1.0, exponent);
      EXPECT_EQ(ParametersOf(rule, true, scaled), t) << ToString(rule) << " 2^" << exponent;
    }
  }
}

TEST(Parameterization, ReversingThePointsMirrorsTheParameters) {
  const Points reversed = BookPoints().colwise().reverse();
  for (const Parameterization rule : kAllRules) {
    const Eigen::VectorXd t = ParametersOf(rule, false, BookPoints());
    const Eigen::VectorXd mirrored = 1.0 - t.reverse().array();
    ExpectParameters(ParametersOf(rule, false, reversed),
                     std::vector<double>(mirrored.begin(), mirrored.end()));
  }
}

TEST(Parameterization, AMillionPointsKeepThirteenDigits) {
  // One rounding of a long double per point; with sums of doubles it would be up to 2e-10.
  const int m = 1000001;
  const double tolerance = m * static_cast<double>(std::numeric_limits<long double>::epsilon());
  Points points(m, 1);
  for (int i = 0; i < m; ++i) points(i, 0) = i;
  const Eigen::VectorXd t = ParametersOf(Parameterization::kCentripetal, false, points);
  double largest_error = 0.0;
  for (int i = 0; i < m; ++i) largest_error = std::max(largest_error, std::abs(t[i] - i * 1e-6));
  EXPECT_LE(largest_error, tolerance);
}

TEST(Parameterization, RefusesEqualPointsWhereLengthsAreNeeded) {
  EXPECT_EQ(WhyRefused(Parameterization::kChordLength, false, Points::Ones(3, 2)),
            "all 3 points are equal, chords have no length; use uniform");
}

TEST(Parameterization, RefusesTooFewPoints) {
  EXPECT_EQ(WhyRefused(Parameterization::kUniform, false, Points::Ones(1, 2)),
            "there are 1 points, uniform parameters need at least 2");
  EXPECT_EQ(WhyRefused(Parameterization::kUniform, true, Points(0, 2)),
            "there are 0 points, uniform parameters need at least 1");
  EXPECT_EQ(WhyRefused(Parameterization::kCentripetal, true, Points::Ones(1, 2)),
            "there are 1 points, centripetal parameters need at least 2");
}

TEST(Parameterization, RefusesPointsWithoutMeasurableChords) {
  Points points = BookPoints();
  points(3, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(WhyRefused(Parameterization::kChordLength, false, points),
            "point 3 is not finite, no chord can be measured to it");
  points(3, 1) = 1e308;
  points(4, 1) = -1e308;
  EXPECT_EQ(WhyRefused(Parameterization::kChordLength, false, points),
            "the points are farther apart than a double can hold; scale them down");
  EXPECT_EQ(WhyRefused(Parameterization::kChordLength, false, Points(3, 0)),
            "the points have no coordinates, chords have no length; use uniform");
  EXPECT_FALSE(Parameterize(Parameterization::kChordLength, false, points, nullptr).has_value());
}

TEST(Parameterization, NamesAreReadAsTheyAreWritten) {
  for (const Parameterization rule : kAllRules) {
    Parameterization read = Parameterization::kUniform;
    EXPECT_TRUE(FromString(ToString(rule), &read));
    EXPECT_EQ(read, rule);
  }
  Parameterization untouched = Parameterization::kCentripetal;
  EXPECT_FALSE(FromString("chord", &untouched));
  EXPECT_EQ(untouched, Parameterization::kCentripetal);
}

TEST(FirstNotBelow, FindsWhatAScanFindsWhateverIsGuessed) {
  const std::vector<double> values = {0, 1, 1, 1, 2, 4, 4, 5, 7, 7, 7, 7, 8, 9, 9, 12};
  const auto size = static_cast<std::ptrdiff_t>(values.size());
  for (std::ptrdiff_t from = 0; from <= size; ++from) {
    for (std::ptrdiff_t guess = from; guess <= size + 3; ++guess) {
      for (const double bound : {-1.0, 0.0, 0.5, 1.0, 3.0, 4.0, 7.0, 9.0, 11.0, 12.0, 13.0}) {
        std::ptrdiff_t expected = from;
        while (expected < size && values[expected] < bound) ++expected;
        EXPECT_EQ(FirstNotBelow(values.data(), from, size, bound, guess), expected)
            << "from " << from << ", guess " << guess << ", bound " << bound;
      }
    }
  }
}

}  // namespace
}  // namespace batten
