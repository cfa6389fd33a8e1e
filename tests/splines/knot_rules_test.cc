#include "splines/knot_rules.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "splines/basis_functions.h"
#include "splines/parameterization.h"
#include "tests/splines/example_splines.h"

namespace batten {
namespace {

Eigen::VectorXd ParametersOf(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

// Nondecreasing, on [0, 1]; the first is 0, the last below 1 where closed, else 1.
Eigen::VectorXd RandomParameters(int m, bool closed, std::mt19937* random) {
  std::vector<double> sums = {0.0};
  for (int i = 0; i < m; ++i) sums.push_back(sums.back() + RandomBetween(0.1, 1.9, random));
  const double total = closed ? sums[m] : sums[m - 1];
  Eigen::VectorXd parameters(m);
  for (int i = 0; i < m; ++i) parameters[i] = sums[i] / total;
  return parameters;
}

void ExpectKnots(const std::vector<double>& actual, const std::vector<double>& expected) {
  // Sums of at most nine numbers <= 2, each rounded once.
  const double tolerance = 9 * 2 * kEpsilon;
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t k = 0; k < actual.size(); ++k) EXPECT_NEAR(actual[k], expected[k], tolerance);
}

std::vector<double> Averaged(int degree, int n, EndKnots ends, const Eigen::VectorXd& parameters) {
  std::string error;
  const std::vector<double> knots = AveragedKnots(degree, n, ends, 0.0, 1.0, parameters, &error);
  EXPECT_EQ(error, "");
  return knots;
}

std::string WhyRefused(int degree, int n, EndKnots ends, const std::vector<double>& parameters) {
  std::string error;
  EXPECT_TRUE(AveragedKnots(degree, n, ends, 0.0, 1.0, ParametersOf(parameters), &error).empty());
  return error;
}

TEST(UniformKnots, RepeatTheEndsOfEndInterpolatingSplines) {
  ExpectKnots(UniformKnots(2, 5, EndKnots::kEndInterpolating, 0.0, 1.5),
              {0, 0, 0, 0.5, 1, 1.5, 1.5, 1.5});
}

TEST(UniformKnots, GoOnPastTheDomainOfFloatingSplines) {
  ExpectKnots(UniformKnots(2, 5, EndKnots::kFloating, 0.0, 1.5),
              {-1, -0.5, 0, 0.5, 1, 1.5, 2, 2.5});
}

TEST(UniformKnots, GiveOneStepPerControlPointOfPeriodicSplines) {
  ExpectKnots(UniformKnots(2, 3, EndKnots::kPeriodic, 0.0, 1.5),
              {-1, -0.5, 0, 0.5, 1, 1.5, 2, 2.5});
  ExpectKnots(UniformKnots(3, 1, EndKnots::kPeriodic, 0.0, 0.25),
              {-0.75, -0.5, -0.25, 0, 0.25, 0.5, 0.75, 1});
}

TEST(UniformKnots, KeepTheEndsOfTheDomainToTheBit) {
  for (const EndKnots ends :
       {EndKnots::kEndInterpolating, EndKnots::kFloating, EndKnots::kPeriodic}) {
    for (int n = 4; n < 60; ++n) {
      const BsplineBasis basis =
          BasisOf(3, ends == EndKnots::kPeriodic, UniformKnots(3, n, ends, 0.0, 0.7));
      EXPECT_EQ(basis.domain_begin(), 0.0);
      EXPECT_EQ(basis.domain_end(), 0.7);
    }
  }
}

TEST(UniformKnots, AreEmptyForWhatCannotBe) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(UniformKnots(0, 5, EndKnots::kFloating, 0.0, 1.0).empty());
  EXPECT_TRUE(UniformKnots(10, 20, EndKnots::kFloating, 0.0, 1.0).empty());
  EXPECT_TRUE(UniformKnots(3, 3, EndKnots::kEndInterpolating, 0.0, 1.0).empty());
  EXPECT_TRUE(UniformKnots(3, 0, EndKnots::kPeriodic, 0.0, 1.0).empty());
  EXPECT_TRUE(UniformKnots(3, -7, EndKnots::kPeriodic, 0.0, 1.0).empty());
  EXPECT_TRUE(UniformKnots(3, 5, EndKnots::kFloating, 1.0, 1.0).empty());
  EXPECT_TRUE(UniformKnots(3, 5, EndKnots::kFloating, 0.0, infinity).empty());
  EXPECT_TRUE(UniformKnots(3, 5, EndKnots::kFloating, std::nan(""), 1.0).empty());
}

TEST(AveragedKnots, GiveTheBooksExample) {
  const Eigen::VectorXd t = ParametersOf({0.0, 5.0 / 17.0, 9.0 / 17.0, 14.0 / 17.0, 1.0});
  ExpectKnots(Averaged(3, 5, EndKnots::kEndInterpolating, t),
              {0, 0, 0, 0, 28.0 / 51.0, 1, 1, 1, 1});
}

TEST(AveragedKnots, InterpolateParametersWhereThereAreFewerControlPoints) {
  // Equations 9.68 and 9.69 by hand: d = 7 / 2, i = 3, alpha = 1/2; then d = 7 / 3, i = 2 and 4,
  // alpha = 1/3 and 2/3.
  const Eigen::VectorXd t = ParametersOf({0.0, 0.1, 0.3, 0.4, 0.7, 0.8, 1.0});
  ExpectKnots(Averaged(2, 4, EndKnots::kEndInterpolating, t), {0, 0, 0, (0.3 + 0.4) / 2, 1, 1, 1});
  ExpectKnots(Averaged(2, 5, EndKnots::kEndInterpolating, t),
              {0, 0, 0, (2 * 0.1 + 0.3) / 3, (0.4 + 2 * 0.7) / 3, 1, 1, 1});
}

TEST(AveragedKnots, RefineParametersWhereThereAreMoreControlPoints) {
  // Two parameters 0 and 1, refined to 0, 1/4, ..., 1: means of two neighbours.
  ExpectKnots(Averaged(2, 5, EndKnots::kEndInterpolating, ParametersOf({0.0, 1.0})),
              {0, 0, 0, 3.0 / 8, 5.0 / 8, 1, 1, 1});
}

TEST(AveragedKnots, FloatingOnesRepeatTheirEndSteps) {
  const Eigen::VectorXd t = ParametersOf({0.0, 0.1, 0.3, 0.4, 0.7, 0.8, 1.0});
  ExpectKnots(Averaged(2, 4, EndKnots::kFloating, t), {-0.7, -0.35, 0, 0.35, 1, 1.65, 2.3});
}

TEST(AveragedKnots, PeriodicOnesStandAtTheParametersForOddDegree) {
  ExpectKnots(Averaged(1, 3, EndKnots::kPeriodic, ParametersOf({0.0, 0.5, 0.7})),
              {-0.3, 0, 0.5, 0.7, 1, 1.5});
  ExpectKnots(Averaged(3, 3, EndKnots::kPeriodic, ParametersOf({0.0, 0.5, 0.7})),
              {-1, -0.5, -0.3, 0, 0.5, 0.7, 1, 1.5, 1.7, 2});
}

TEST(AveragedKnots, PeriodicOnesStandHalfWayBetweenParametersForEvenDegree) {
  ExpectKnots(Averaged(2, 3, EndKnots::kPeriodic, ParametersOf({0.0, 0.5, 0.7})),
              {-0.4, -0.15, 0.25, 0.6, 0.85, 1.25, 1.6, 1.85});
}

TEST(AveragedKnots, PeriodicOnesFollowTheMapWhereSizesDiffer) {
  // i = 4 j / 3 and (j + 1/2) 4 / 3 on 0, 0.5, 0.7, 0.8, 1.
  const Eigen::VectorXd t = ParametersOf({0.0, 0.5, 0.7, 0.8});
  ExpectKnots(Averaged(1, 3, EndKnots::kPeriodic, t),
              {0.7 + 0.2 / 3 - 1, 0, 0.5 + 0.2 / 3, 0.7 + 0.2 / 3, 1, 1.5 + 0.2 / 3});
  ExpectKnots(Averaged(2, 3, EndKnots::kPeriodic, t), {0.7 - 1, 0.8 + 0.2 / 3 - 1, 1.0 / 3, 0.7,
                                                       0.8 + 0.2 / 3, 4.0 / 3, 1.7, 1.8 + 0.2 / 3});
}

TEST(AveragedKnots, AllowAClosedCurveWhoseFirstParameterComesAgainAtTheEnd) {
  // begin + (end - begin) rounds to less than end here, which must not turn knots round.
  const double begin = 0.1;
  const double end = std::nextafter(0.7, 1.0);
  for (int p = 2; p <= kMaxDegree; ++p) {
    const Eigen::VectorXd t = ParametersOf({begin, 0.3, 0.5, 0.6, end});
    std::string error;
    const auto knots = AveragedKnots(p, 5, EndKnots::kPeriodic, begin, end, t, &error);
    EXPECT_FALSE(knots.empty()) << error;
  }
}

TEST(AveragedKnots, RefuseWhatWouldCoincideTooOften) {
  EXPECT_EQ(WhyRefused(1, 5, EndKnots::kEndInterpolating, {0, 0.5, 0.5, 0.5, 1}),
            "averaged knot 2, 0.5, stands 3 times, must be at most 1 times (the degree) inside the "
            "domain");
  EXPECT_EQ(WhyRefused(1, 4, EndKnots::kPeriodic, {0, 0.5, 0.5, 0.75}),
            "averaged knot 2, 0.5, stands 2 times, must be at most 1 times (the degree) inside the "
            "domain");
  EXPECT_EQ(WhyRefused(2, 7, EndKnots::kFloating, {0, 0, 0, 0.5, 1, 1, 1}),
            "averaged knot 0, 0, stands 4 times, must be at most 3 times (the order)");
}

TEST(AveragedKnots, RefuseBadParametersAndSizes) {
  EXPECT_EQ(WhyRefused(2, 3, EndKnots::kFloating, {}),
            "there are no parameters to average knots from");
  EXPECT_EQ(WhyRefused(2, 3, EndKnots::kFloating, {0, 0.6, 0.5, 1}),
            "parameter 2 is 0.5, below its predecessor, 0.6; parameters must not decrease");
  EXPECT_EQ(WhyRefused(2, 3, EndKnots::kPeriodic, {0, 1.5}),
            "parameter 1 is 1.5, must be in [0, 1]");
  EXPECT_EQ(WhyRefused(2, 3, EndKnots::kPeriodic, {std::nan("")}),
            "parameter 0 is nan, must be in [0, 1]");
  EXPECT_EQ(WhyRefused(10, 30, EndKnots::kPeriodic, {0.0}), "degree is 10, must be 1 to 9");
  EXPECT_EQ(WhyRefused(3, 3, EndKnots::kFloating, {0.0}),
            "there are 3 control points, degree 3 needs at least 4");
  EXPECT_TRUE(
      AveragedKnots(2, 3, EndKnots::kFloating, 1.0, 0.0, ParametersOf({0.5}), nullptr).empty());
}

TEST(KnotRules, NamesAreReadAsTheyAreWritten) {
  for (const KnotRule rule : {KnotRule::kUniform, KnotRule::kAveraged}) {
    KnotRule read = KnotRule::kUniform;
    EXPECT_TRUE(FromString(ToString(rule), &read));
    EXPECT_EQ(read, rule);
  }
  KnotRule untouched = KnotRule::kAveraged;
  EXPECT_FALSE(FromString("average", &untouched));
  EXPECT_EQ(untouched, KnotRule::kAveraged);
}

class EveryKnotRule : public ::testing::TestWithParam<SplineKind> {
 protected:
  std::mt19937 random_{20240506};
  const int p_ = GetParam().degree;
  const EndKnots ends_ = GetParam().ends;
};

Eigen::MatrixXd CollocationMatrix(const BsplineBasis& basis, const Eigen::VectorXd& parameters) {
  const int p = basis.degree();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(parameters.size(), basis.num_control_points());
  for (Eigen::Index i = 0; i < parameters.size(); ++i) {
    const double t = basis.Wrap(parameters[i]);
    const int span = basis.FindSpan(t);
    double values[kMaxOrder];
    EvaluateBasis(p, basis.knots().data(), span, t, values);
    for (int j = 0; j <= p; ++j) matrix(i, basis.ControlPointIndex(span - p + j)) += values[j];
  }
  return matrix;
}

TEST_P(EveryKnotRule, AveragedKnotsMakeInterpolationRegular) {
  // Odd and even numbers of points: badly placed periodic knots fail for one of the two.
  for (const int n : {2 * p_ + 3, 2 * p_ + 4}) {
    const Eigen::VectorXd t = RandomParameters(n, GetParam().periodic(), &random_);
    const BsplineBasis basis = BasisOf(p_, GetParam().periodic(), Averaged(p_, n, ends_, t));
    const Eigen::PartialPivLU<Eigen::MatrixXd> lu(CollocationMatrix(basis, t));
    // A singular matrix has about n eps, 5e-15; floating splines of degree 9 come to 5e-11.
    const double kSmallestReciprocalCondition = 1e-12;
    EXPECT_GT(lu.rcond(), kSmallestReciprocalCondition) << "n = " << n;
  }
}

TEST_P(EveryKnotRule, AveragedKnotsLeaveNoSpanWithoutDataWhereDataAreMore) {
  for (const int n : {p_ + 1, p_ + 3, 2 * p_ + 9}) {
    for (const int m : {n + 1, 2 * n + 1, 5 * n}) {
      const Eigen::VectorXd t = RandomParameters(m, GetParam().periodic(), &random_);
      const BsplineBasis basis = BasisOf(p_, GetParam().periodic(), Averaged(p_, n, ends_, t));
      std::vector<int> num_data(basis.last_span() + 1, 0);
      for (const double parameter : t) ++num_data[basis.FindSpan(basis.Wrap(parameter))];
      for (int k = basis.first_span(); k <= basis.last_span(); ++k) EXPECT_GE(num_data[k], 1);
    }
  }
}

TEST_P(EveryKnotRule, AveragedKnotsAreGoodForEveryPairOfSizes) {
  for (const int n : SizesOf(GetParam())) {
    for (const int m : {2, 3, n, n + 1, 3 * n}) {
      if (m < 2) continue;
      const Eigen::VectorXd t = RandomParameters(m, GetParam().periodic(), &random_);
      const BsplineBasis basis = BasisOf(p_, GetParam().periodic(), Averaged(p_, n, ends_, t));
      EXPECT_EQ(basis.num_control_points(), n);
      EXPECT_NEAR(basis.domain_length(), 1.0, 2 * kEpsilon);
    }
  }
}

TEST_P(EveryKnotRule, ShiftingClosedDataShiftsTheAveragedKnotsWithThem) {
  if (!GetParam().periodic()) return;
  const int n = 2 * p_ + 3;
  const Eigen::VectorXd t = RandomParameters(n, true, &random_);
  Eigen::VectorXd shifted(n);
  for (int i = 0; i < n; ++i) shifted[i] = t[(i + 1) % n] + (i + 1) / n - t[1];
  const std::vector<double> before = Averaged(p_, n, ends_, t);
  const std::vector<double> after = Averaged(p_, n, ends_, shifted);
  // Three roundings of numbers below 2.
  for (std::size_t k = 0; k + 1 < before.size(); ++k) {
    EXPECT_NEAR(after[k], before[k + 1] - t[1], 6 * kEpsilon);
  }
}

std::vector<SplineKind> KindsWithAveragedKnots() {
  std::vector<SplineKind> kinds;
  for (const SplineKind& kind : AllSplineKinds()) {
    if (!kind.uniform) kinds.push_back(kind);
  }
  return kinds;
}

INSTANTIATE_TEST_SUITE_P(Splines, EveryKnotRule, ::testing::ValuesIn(KindsWithAveragedKnots()),
                         NameOf);

}  // namespace
}  // namespace batten
