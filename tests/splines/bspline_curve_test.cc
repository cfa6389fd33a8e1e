#include "splines/bspline_curve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include "tests/splines/example_splines.h"

namespace batten {
namespace {

TEST(BsplineCurve, EndInterpolatingCurvesBeginAndEndInTheirEndPoints) {
  const BsplineCurve curve(BasisOf(3, false, {0, 0, 0, 0, 1, 2, 2, 2, 2}),
                           PointsOf({{1, 2}, {3, -1}, {0, 0}, {5, 5}, {7, 4}}));
  double end[2];
  curve.Evaluate(0.0, 0, end);
  EXPECT_EQ(end[0], 1.0);
  EXPECT_EQ(end[1], 2.0);
  curve.Evaluate(2.0, 0, end);
  EXPECT_EQ(end[0], 7.0);
  EXPECT_EQ(end[1], 4.0);
  curve.Evaluate(0.0, 1, end);  // p (P_1 - P_0) / (u_(p+1) - u_1), NURBS Book 3.7
  EXPECT_DOUBLE_EQ(end[0], 6.0);
  EXPECT_DOUBLE_EQ(end[1], -9.0);
}

TEST(BsplineCurve, ParametersOutsideTheDomainAreClampedOnOpenCurves) {
  const BsplineCurve curve(BasisOf(2, false, {0, 0, 0, 1, 1, 1}), PointsOf({{1}, {3}, {-2}}));
  double value = 0.0;
  curve.Evaluate(-5.0, 0, &value);
  EXPECT_EQ(value, 1.0);
  curve.Evaluate(std::numeric_limits<double>::infinity(), 0, &value);
  EXPECT_EQ(value, -2.0);
}

TEST(BsplineCurve, NanParameterGivesNan) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const BsplineCurve open(BasisOf(1, false, {0, 0, 1, 1}), PointsOf({{1}, {3}}));
  const BsplineCurve closed(BasisOf(1, true, {-1, 0, 1, 2}), PointsOf({{1}}));
  for (const BsplineCurve* curve : {&open, &closed}) {
    double value = 0.0;
    curve->Evaluate(nan, 0, &value);
    EXPECT_TRUE(std::isnan(value));
  }
}

TEST(BsplineCurve, RefusesControlPointsOfAnotherSize) {
  const BsplineBasis basis = BasisOf(1, false, {0, 0, 1, 1});
  EXPECT_THROW(BsplineCurve(basis, Points::Zero(3, 2)), std::logic_error);
  EXPECT_THROW(BsplineCurve(basis, Points::Zero(2, 5)), std::logic_error);
  EXPECT_THROW(BsplineCurve(basis, Points::Zero(2, 0)), std::logic_error);
  double value[2];
  EXPECT_THROW(BsplineCurve(basis, Points::Zero(2, 2)).Evaluate(0.5, -1, value), std::logic_error);
}

class EveryCurve : public ::testing::TestWithParam<SplineKind> {
 protected:
  std::mt19937 random_{20240503};
  const int p_ = GetParam().degree;
  std::vector<BsplineCurve> curves_;

  void SetUp() override {
    for (const BsplineBasis& basis : MakeBases(GetParam(), &random_)) {
      for (int d = 1; d <= kMaxDimension; ++d) {
        curves_.emplace_back(basis, RandomPoints(basis.num_control_points(), d, &random_));
      }
    }
  }
};

// Bound on the roundings in a derivative: basis functions of degree p - d make about 4 (p + 1),
// and each of the d differences at most doubles the terms and divides by a span, times p.
double RoundingOfDerivative(const BsplineBasis& basis, int derivative) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const int k : NonEmptySpans(basis)) {
    shortest = std::min(shortest, basis.knots()[k + 1] - basis.knots()[k]);
  }
  const int p = basis.degree();
  return 8 * (p + 1) * kEpsilon * std::pow(2.0 * p / shortest, derivative);
}

TEST_P(EveryCurve, IsTheSumOfControlPointsTimesBasisFunctions) {
  for (const BsplineCurve& curve : curves_) {
    const BsplineBasis& basis = curve.basis();
    const double t = RandomParameter(basis, &random_);
    std::vector<long double> sum(curve.dimension(), 0.0L);
    // Functions between num_functions and the end of the periodic knots begin behind the domain.
    const int num_functions = static_cast<int>(basis.knots().size()) - p_ - 1;
    for (int j = 0; j < num_functions; ++j) {
      const long double value = BasisByDefinition(basis.knots(), j, p_, t);
      const int index = j % basis.num_control_points();
      for (int c = 0; c < curve.dimension(); ++c)
        sum[c] += value * curve.control_points()(index, c);
    }
    double result[kMaxDimension];
    curve.Evaluate(t, 0, result);
    for (int c = 0; c < curve.dimension(); ++c) {
      EXPECT_NEAR(result[c], static_cast<double>(sum[c]), RoundingOfDerivative(basis, 0));
    }
  }
}

TEST_P(EveryCurve, AllDerivativesAtOnceAreTheSingleOnes) {
  for (const BsplineCurve& curve : curves_) {
    const int d = curve.dimension();
    const double t = RandomParameter(curve.basis(), &random_);
    double all[(kMaxDegree + 3) * kMaxDimension];
    curve.EvaluateUpTo(t, p_ + 2, all);
    for (int k = 0; k <= p_ + 2; ++k) {
      double single[kMaxDimension];
      curve.Evaluate(t, k, single);
      for (int c = 0; c < d; ++c) {
        EXPECT_EQ(all[k * d + c], single[c]);
        EXPECT_TRUE(k <= p_ || single[c] == 0.0);
      }
    }
    const Points sampled = curve.Sample(Eigen::VectorXd::Constant(2, t));
    for (int c = 0; c < d; ++c) EXPECT_EQ(sampled(1, c), all[c]);
  }
}

TEST_P(EveryCurve, JoinsItsSpansAsSmoothlyAsTheKnotsAllow) {
  // C^(p - multiplicity) at every knot, across the seam of periodic ones as well.
  for (const BsplineCurve& curve : curves_) {
    const BsplineBasis& basis = curve.basis();
    const std::vector<double>& u = basis.knots();
    const std::vector<int> spans = NonEmptySpans(basis);
    for (std::size_t s = basis.periodic() ? 0 : 1; s < spans.size(); ++s) {
      const double knot = u[spans[s]];
      const int before = s > 0 ? spans[s - 1] : spans.back();
      int multiplicity = spans[s] - before;
      if (multiplicity <= 0) multiplicity += basis.num_control_points();
      // One double to the left: higher derivatives times eps of the span are within the tolerance.
      const double left = std::nextafter(s > 0 ? knot : basis.domain_end(), knot - 1e9);
      for (int k = 0; k <= p_ - multiplicity; ++k) {
        double from_left[kMaxDimension];
        double from_right[kMaxDimension];
        curve.Evaluate(left, k, from_left);
        curve.Evaluate(knot, k, from_right);
        const double size = std::abs(u.front()) + std::abs(u.back());
        const double tolerance =
            2 * RoundingOfDerivative(basis, k) +
            2 * kEpsilon * size * RoundingOfDerivative(basis, k + 1) / (8 * (p_ + 1) * kEpsilon);
        for (int c = 0; c < curve.dimension(); ++c) {
          EXPECT_NEAR(from_left[c], from_right[c], tolerance) << "derivative " << k;
        }
      }
    }
  }
}

TEST_P(EveryCurve, PeriodicOnesAreOpenOnesWithTheirPointsRepeated) {
  if (!GetParam().periodic()) return;
  for (const BsplineCurve& curve : curves_) {
    const BsplineBasis& basis = curve.basis();
    const int n = basis.num_control_points();
    Points repeated(n + p_, curve.dimension());
    for (int j = 0; j < n + p_; ++j) repeated.row(j) = curve.control_points().row(j % n);
    const BsplineCurve open(BasisOf(p_, false, basis.knots()), repeated);
    for (int trial = 0; trial < 10; ++trial) {
      const double t = RandomParameter(basis, &random_);
      for (int k = 0; k <= p_; ++k) {
        double closed_result[kMaxDimension];
        double open_result[kMaxDimension];
        curve.Evaluate(t, k, closed_result);
        open.Evaluate(t, k, open_result);
        for (int c = 0; c < curve.dimension(); ++c) EXPECT_EQ(closed_result[c], open_result[c]);
      }
    }
  }
}

TEST_P(EveryCurve, PeriodicOnesRepeatAfterEveryTurn) {
  if (!GetParam().periodic()) return;
  for (const BsplineCurve& curve : curves_) {
    const BsplineBasis& basis = curve.basis();
    const double t = RandomParameter(basis, &random_);
    for (const double turns : {-2.0, 1.0, 3.0}) {
      double here[kMaxDimension];
      double there[kMaxDimension];
      curve.Evaluate(t, 0, here);
      curve.Evaluate(t + turns * basis.domain_length(), 0, there);
      // The parameter moves by a few roundings of its size; |C'| <= (2 p / span) max |P|.
      const double size = std::abs(basis.domain_begin()) + 4 * basis.domain_length();
      const double slope = RoundingOfDerivative(basis, 1) / RoundingOfDerivative(basis, 0);
      for (int c = 0; c < curve.dimension(); ++c) {
        EXPECT_NEAR(here[c], there[c],
                    RoundingOfDerivative(basis, 0) + 4 * kEpsilon * size * slope);
      }
    }
  }
}

TEST_P(EveryCurve, ReproducesStraightLines) {
  // Control points at a + b * (mean of p knots) make C(t) = a + b t (Marsden for degree 1).
  if (GetParam().periodic()) return;
  for (const BsplineCurve& curve : curves_) {
    const BsplineBasis& basis = curve.basis();
    Points line(basis.num_control_points(), 2);
    for (int j = 0; j < line.rows(); ++j) {
      line.row(j) << 0.3 - 2.0 * basis.Greville(j), basis.Greville(j);
    }
    const BsplineCurve straight(basis, line);
    const double t = RandomParameter(basis, &random_);
    double result[4];
    straight.EvaluateUpTo(t, 1, result);
    const double size = line.cwiseAbs().maxCoeff();
    EXPECT_NEAR(result[0], 0.3 - 2.0 * t, RoundingOfDerivative(basis, 0) * size);
    EXPECT_NEAR(result[1], t, RoundingOfDerivative(basis, 0) * size);
    EXPECT_NEAR(result[2], -2.0, RoundingOfDerivative(basis, 1) * size);
    EXPECT_NEAR(result[3], 1.0, RoundingOfDerivative(basis, 1) * size);
  }
}

TEST_P(EveryCurve, MovesWithItsControlPoints) {
  for (const BsplineCurve& curve : curves_) {
    const Points moved = (4.0 * curve.control_points()).array() + 0.75;
    const double t = RandomParameter(curve.basis(), &random_);
    double before[kMaxDimension];
    double after[kMaxDimension];
    curve.Evaluate(t, 0, before);
    BsplineCurve(curve.basis(), moved).Evaluate(t, 0, after);
    for (int c = 0; c < curve.dimension(); ++c) {
      EXPECT_NEAR(after[c], 4.0 * before[c] + 0.75, 5 * RoundingOfDerivative(curve.basis(), 0));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Splines, EveryCurve, ::testing::ValuesIn(AllSplineKinds()), NameOf);

}  // namespace
}  // namespace batten
