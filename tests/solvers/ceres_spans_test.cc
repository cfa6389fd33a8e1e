#include "solvers/ceres_spans.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <set>

#include "problems/objective.h"
#include "tests/roundoff.h"
#include "tests/solvers/test_fits.h"

namespace batten {
namespace {

/// sum over spans of ||r||^2 at x.
double Energy(const std::vector<SpanBlock>& spans, const Eigen::VectorXd& x) {
  double energy = 0.0;
  for (const SpanBlock& span : spans) {
    std::vector<const double*> points;
    for (const int begin : span.begins) points.push_back(x.data() + begin);
    Eigen::VectorXd residuals(span.cost->num_residuals());
    CHECK(span.cost->Evaluate(points.data(), residuals.data(), nullptr));
    energy += residuals.squaredNorm();
  }
  return energy;
}

Eigen::VectorXd Somewhere(int size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-0.5, 0.5);
  Eigen::VectorXd x(size);
  for (double& value : x) value = uniform(random);
  return x;
}

/// E less the sum over the spans is the same everywhere, and not negative.
void ExpectConstantApart(const Problem& problem) {
  Objective objective(&problem, nullptr);
  const std::vector<SpanBlock> spans = MakeSpanBlocks(*objective.curve_view());
  const int n = objective.num_variables();
  double first_difference = 0.0;
  for (const unsigned seed : {1U, 2U, 3U}) {
    const Eigen::VectorXd x = Somewhere(n, seed);
    double energy = 0.0;
    ASSERT_EQ(objective.Energy(x, &energy), Status::kOk);
    const double difference = energy - Energy(spans, x);
    if (seed == 1U) first_difference = difference;
    // Sums of some hundred squares, and a factorization of as many rows.
    const double tolerance = 1000.0 * kEpsilon * energy;
    EXPECT_NEAR(difference, first_difference, tolerance);
    EXPECT_GE(difference, -tolerance);
  }
}

TEST(CeresSpans, HaveOrderTimesDimensionResidualsHoweverManyPointsThereAre) {
  const auto problem = MakeFileFit("animals/rhino_2000.csv", MakeSpec(3, true, 40));
  Objective objective(problem.get(), nullptr);
  const std::vector<SpanBlock> spans = MakeSpanBlocks(*objective.curve_view());
  EXPECT_EQ(spans.size(), 40U);
  for (const SpanBlock& span : spans) {
    EXPECT_EQ(span.cost->num_residuals(), 8);
    EXPECT_EQ(span.begins.size(), 4U);
  }
}

TEST(CeresSpans, LeaveOutAConstant) {
  ExpectConstantApart(*MakeFileFit("animals/rhino_100.csv", MakeSpec(3, true, 40)));
  ExpectConstantApart(*MakeFit(MakeNoisyLoop(300, 3, 41), MakeSpec(5, false, 9)));
  ExpectConstantApart(*MakeFit(MakeNoisyLoop(300, 2, 42),
                               MakeSpec(3, true, 20, "interpolation,interpolation/weight=0.2")));
}

TEST(CeresSpans, TakeMoreRowsThanAreGatheredAtOnce) {
  ExpectConstantApart(*MakeFit(MakeNoisyLoop(20000, 2, 43), MakeSpec(3, true, 3)));
}

TEST(CeresSpans, TakeFewerRowsThanASpanHasPoints) {
  ExpectConstantApart(*MakeFit(MakeNoisyLoop(30, 2, 44), MakeSpec(3, true, 30)));
  ExpectConstantApart(*MakeFit(MakeNoisyLoop(20, 2, 45), MakeSpec(3, false, 50)));
}

TEST(CeresSpans, MeetAPointOnceWhereTheCurveClosesOnItself) {
  const auto problem = MakeFit(MakeNoisyLoop(50, 2, 46), MakeSpec(3, true, 2));
  Objective objective(problem.get(), nullptr);
  for (const SpanBlock& span : MakeSpanBlocks(*objective.curve_view())) {
    EXPECT_EQ(std::set<int>(span.begins.begin(), span.begins.end()).size(), span.begins.size());
  }
  ExpectConstantApart(*problem);
}

TEST(CeresSpans, FollowLinearConstraints) {
  auto problem = MakeFit(MakeNoisyLoop(100, 2, 47), MakeSpec(3, true, 20));
  SetConstraints({HoldCurve(*problem, 0.6, 0, 0.1), HoldCurve(*problem, 0.6, 1, 0.2)},
                 problem.get());
  ExpectConstantApart(*problem);
}

TEST(CeresSpans, DerivativesAreTheDifferencesOfAnAffineFunction) {
  const auto problem = MakeFit(MakeNoisyLoop(100, 3, 48), MakeSpec(3, false, 9));
  Objective objective(problem.get(), nullptr);
  Eigen::VectorXd x = Somewhere(objective.num_variables(), 49);
  for (const SpanBlock& span : MakeSpanBlocks(*objective.curve_view())) {
    const int num_residuals = span.cost->num_residuals();
    std::vector<const double*> points;
    for (const int begin : span.begins) points.push_back(x.data() + begin);
    std::vector<Points> jacobians(points.size(), Points(num_residuals, 3));
    std::vector<double*> pointers;
    for (Points& jacobian : jacobians) pointers.push_back(jacobian.data());
    Eigen::VectorXd before(num_residuals);
    Eigen::VectorXd after(num_residuals);
    ASSERT_TRUE(span.cost->Evaluate(points.data(), before.data(), pointers.data()));
    for (std::size_t j = 0; j < points.size(); ++j) {
      for (int c = 0; c < 3; ++c) {
        double& moved = x[span.begins[j] + c];
        const double old = moved;
        moved += 1.0;
        ASSERT_TRUE(span.cost->Evaluate(points.data(), after.data(), nullptr));
        moved = old;
        // Five products of sizes below 10 with one rounding each.
        EXPECT_LE((after - before - jacobians[j].col(c)).norm(), 100.0 * kEpsilon);
      }
    }
  }
}

}  // namespace
}  // namespace batten
