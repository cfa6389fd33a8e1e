// Free parameters that stay in the order of the data points.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/roundoff.h"
#include "tests/solvers/contract_cases.h"

namespace batten {
namespace {

/// Points of a zigzag that runs to and fro: feet on a smooth curve would change their order.
std::unique_ptr<Problem> Zigzag(bool closed, bool keep_order, bool hold_ends = false) {
  DataSet data;
  data.name = "zigzag";
  data.points.resize(40, 2);
  for (int i = 0; i < 40; ++i) {
    const double a = (closed ? 2.0 * M_PI : M_PI) * (i + (i % 3 == 0 ? 1.7 : 0.0)) / 42.0;
    data.points.row(i) << 3.0 * std::cos(a), 2.0 * std::sin(a) + 0.1 * (i % 2);
  }
  FitSpec spec = MakeFreeSpec(3, closed, 9, "data");
  spec.parameters = Parameterization::kUniform;
  spec.keep_order = keep_order;
  spec.hold_ends = hold_ends;
  spec.guard = NameSpec{"length", {}, nullptr};  // without it the points slide for ever
  return MakeFit(data, spec);
}

bool IsInOrder(const Eigen::VectorXd& t) { return std::is_sorted(t.data(), t.data() + t.size()); }

TEST(OrderOfPoints, IsKeptByLbfgsUpToAConstrainedMinimum) {
  for (const auto& [closed, hold_ends] :
       {std::pair(true, false), std::pair(false, false), std::pair(false, true)}) {
    SCOPED_TRACE(std::to_string(closed) + std::to_string(hold_ends));
    const auto problem = Zigzag(closed, true, hold_ends);
    SolverTrial trial(*problem, "lbfgs", {20000});
    EXPECT_EQ(trial.outcome.reason, StopReason::kGradientSmall) << ToString(trial.outcome.reason);
    const CurveFit& fit = *problem->curve_fit();
    // Open curves: on the curve, where those past an end are at it.
    Eigen::VectorXd t = fit.Parameters(trial.all);
    if (closed) t = fit.OrderedIfKept(trial.all.tail(t.size()));
    // The variables themselves are in order, where they are on the curve.
    Eigen::VectorXd s = trial.all.tail(t.size());
    if (!closed) {
      for (double& value : s) value = fit.basis().Wrap(value);
    }
    for (Eigen::Index i = 1; i < s.size(); ++i) EXPECT_GE(s[i], s[i - 1] - 4 * kEpsilon) << i;
    EXPECT_LE(t[t.size() - 1] - t[0], fit.basis().domain_length() * (1 + 4 * kEpsilon));
    // Without the order points do change it, and E is lower.
    const auto loose = Zigzag(closed, false, hold_ends);
    SolverTrial free_trial(*loose, "lbfgs", {20000});
    EXPECT_FALSE(IsInOrder(free_trial.all.tail(t.size())));
    EXPECT_LT(free_trial.context.Energy(free_trial.x), trial.context.Energy(trial.x));
  }
}

TEST(OrderOfPoints, EndsWhereNoOrderedStepLowersTheEnergy) {
  const auto problem = Zigzag(false, true);
  SolverTrial trial(*problem, "lbfgs", {20000});
  const double energy = trial.context.Energy(trial.x);
  const auto m = problem->curve_fit()->parameters().size();
  std::mt19937 random(73);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 200; ++k) {
    // Steps of ordered parameters lead to ordered ones half of the time; t(s) is what counts.
    Eigen::VectorXd x = trial.x;
    for (double& value : x.tail(m)) value += 1e-4 * normal(random);
    EXPECT_GE(trial.context.Energy(x), energy * (1.0 - 64 * kEpsilon));
  }
}

TEST(OrderOfPoints, EndsInConstrainedMinimaWherePointsPressOnTheEndsOfAnOpenCurve) {
  // Ends of these outlines lie side by side: many points come to an end of the curve.
  for (const char* file : {"rhino_100", "cat_110", "squirrel_120", "dolphin_80"}) {
    for (const char* start : {"circle", "data"}) {
      SCOPED_TRACE(std::string(file) + " " + start);
      FitSpec spec = MakeFreeSpec(3, false, 12, start);
      spec.keep_order = true;
      spec.guard = NameSpec{"length", {}, nullptr};
      const auto problem = MakeFileFit(std::string("animals/") + file + ".csv", spec);
      SolverTrial trial(*problem, "lbfgs", {20000});
      const CurveFit& fit = *problem->curve_fit();
      const auto m = fit.parameters().size();
      const Eigen::VectorXd t = trial.all.tail(m);
      EXPECT_EQ(trial.outcome.reason, StopReason::kGradientSmall) << ToString(trial.outcome.reason);
      EXPECT_TRUE(IsInOrder(t));
      EXPECT_GE(t[0], fit.basis().domain_begin());
      EXPECT_LE(t[m - 1], fit.basis().domain_end());
      // Neither a point alone nor, as at the ends, some neighbours together go down.
      const double energy = trial.context.Energy(trial.x);
      const auto offset = trial.x.size() - m;
      for (Eigen::Index i = 0; i < m; ++i) {
        for (Eigen::Index last = i; last < std::min(i + 6, m); ++last) {
          for (const double step : {-1e-4, 1e-4}) {
            Eigen::VectorXd x = trial.x;
            x.segment(offset + i, last - i + 1).array() += step;
            EXPECT_GE(trial.context.Energy(x), energy * (1.0 - 1e-9)) << i << " to " << last;
          }
        }
      }
    }
  }
}

/// Points that go around more than once: the last are to be a period after the first.
std::unique_ptr<Problem> MoreThanOnceAround(int m, double turns, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, 0.1);
  DataSet data;
  data.name = "more_than_once_around";
  data.points.resize(m, 2);
  for (int i = 0; i < m; ++i) {
    const double a = turns * 2.0 * M_PI * i / m;
    data.points.row(i) << 3.0 * std::cos(a) + normal(random), 2.0 * std::sin(a) + normal(random);
  }
  FitSpec spec = MakeFreeSpec(3, true, 8);
  spec.keep_order = true;
  spec.guard = NameSpec{"length", {}, nullptr};
  return MakeFit(data, spec);
}

TEST(OrderOfPoints, IsKeptAcrossTheSeamUpToAConstrainedMinimum) {
  int active = 0;
  for (unsigned seed = 0; seed < 12; ++seed) {
    const int m = 20 + 20 * static_cast<int>(seed % 3);
    const double turns = seed % 2 == 0 ? 1.05 : 1.2;
    SCOPED_TRACE(std::to_string(m) + " " + std::to_string(turns));
    const auto problem = MoreThanOnceAround(m, turns, seed);
    SolverTrial trial(*problem, "lbfgs", {20000});
    EXPECT_EQ(trial.outcome.reason, StopReason::kGradientSmall) << ToString(trial.outcome.reason);
    const Eigen::VectorXd t = trial.all.tail(m);
    EXPECT_TRUE(IsInOrder(t));
    EXPECT_LE(t[m - 1] - t[0], 1.0 + 4 * kEpsilon);
    if (t[m - 1] - t[0] > 1.0 - 4 * kEpsilon) ++active;
    // No step of one control point's coordinate or of one point, put in order, lowers E.
    const double energy = trial.context.Energy(trial.x);
    for (Eigen::Index i = 0; i < trial.x.size(); ++i) {
      for (const double step : {-1e-4, 1e-4}) {
        Eigen::VectorXd x = trial.x;
        x[i] += step;
        EXPECT_GE(trial.context.Energy(x), energy * (1.0 - 64 * kEpsilon)) << i;
      }
    }
  }
  EXPECT_GT(active, 6);
}

TEST(OrderOfPoints, OfTwoPointsWithHeldEndsIsKeptByItself) {
  for (const int m : {2, 3}) {
    DataSet data = MakeNoisyBean(m, 2, 650);
    data.weights.reset();
    FitSpec spec = MakeFreeSpec(3, false, 4, "data");
    spec.keep_order = spec.hold_ends = true;
    const auto problem = MakeFit(data, spec);
    SolverTrial trial(*problem, "lbfgs", {200});
    EXPECT_TRUE(trial.x.allFinite());
  }
}

TEST_P(EverySolver, KeepsTheOrderOfPointsOrSaysThatItDoesNot) {
  const auto problem = Zigzag(true, true);
  const std::string why = WhyUnsupported(*problem, free_name());
  // The base of the second is the first.
  const bool is_lbfgs = GetParam() == "lbfgs" || GetParam() == "augmented_lagrangian";
  EXPECT_EQ(why.empty(), is_lbfgs) << why;
  if (!why.empty()) ExpectOneSentenceWithAWayOut(why, free_name());
}

TEST(BestOf, KeepsTheOrderOfPointsOverLbfgs) {
  const auto problem = Zigzag(true, true);
  ASSERT_EQ(WhyUnsupported(*problem, "best_of/starts=3/steps=20:lbfgs"), "");
  const SolverTrial trial(*problem, "best_of/starts=3/steps=20:lbfgs", {60});
  const Eigen::VectorXd t = problem->curve_fit()->Parameters(trial.all);
  // Where the points go around once, all but one of the steps go forward.
  int back = 0;
  for (Eigen::Index i = 1; i < t.size(); ++i) back += t[i] < t[i - 1] ? 1 : 0;
  EXPECT_LE(back, 1);
}

}  // namespace
}  // namespace batten
