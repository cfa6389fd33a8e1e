#include "cost_functions/fit_setting.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "cost_functions/interpolation.h"
#include "splines/knot_rules.h"
#include "splines/parameterization.h"
#include "tests/cost_functions/example_fit.h"

namespace batten {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

Sites SitesAt(const std::vector<double>& parameters, const BsplineBasis& basis) {
  Sites sites;
  sites.size = static_cast<int>(parameters.size());
  sites.parameters = parameters.data();
  GroupBySpan(basis, IsNondecreasing(sites.parameters, sites.size), &sites);
  return sites;
}

/// Every site stands once, in the group of its span, and groups ascend without a gap.
void ExpectGrouped(const Sites& sites, const BsplineBasis& basis) {
  int next = 0;
  int last_span = -1;
  std::vector<int> items;
  for (const Sites::Group& group : sites.groups) {
    EXPECT_EQ(group.begin, next);
    EXPECT_LT(group.begin, group.end);
    EXPECT_GT(group.span, last_span);
    for (int s = group.begin; s < group.end; ++s) {
      items.push_back(sites.item(s));
      EXPECT_EQ(basis.FindSpan(sites.parameters[sites.item(s)]), group.span);
      // Equal spans keep the order of their items: sums do not depend on the sort.
      if (s > group.begin) {
        EXPECT_LT(sites.item(s - 1), sites.item(s));
      }
    }
    next = group.end;
    last_span = group.span;
  }
  EXPECT_EQ(next, sites.size);
  std::sort(items.begin(), items.end());
  std::vector<int> all(items.size());
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(items, all);
}

// Spans [0, 1), [1, 2), [2, 3], named 2, 3, 4.
BsplineBasis ThreeSpans() { return BasisOf(2, false, {0, 0, 0, 1, 2, 3, 3, 3}); }

TEST(GroupBySpan, LeavesSortedParametersWhereTheyAre) {
  const std::vector<double> parameters = {0.0, 0.5, 2.0, 2.5, 3.0};
  const Sites sites = SitesAt(parameters, ThreeSpans());
  EXPECT_THAT(sites.order, IsEmpty());
  ASSERT_EQ(sites.groups.size(), 2u);
  EXPECT_EQ(sites.groups[0].span, 2);
  EXPECT_EQ(sites.groups[1].span, 4);
  ExpectGrouped(sites, ThreeSpans());
}

TEST(GroupBySpan, NeedsSpansInOrderButNotParameters) {
  const std::vector<double> parameters = {0.9, 0.1, 1.5, 1.2};
  const Sites sites = SitesAt(parameters, ThreeSpans());
  EXPECT_THAT(sites.order, IsEmpty());
  ExpectGrouped(sites, ThreeSpans());
}

TEST(GroupBySpan, SortsUnsortedParametersBySpan) {
  const std::vector<double> parameters = {2.5, 0.5, 1.5, 3.0, 0.2, 1.0};
  const Sites sites = SitesAt(parameters, ThreeSpans());
  EXPECT_THAT(sites.order, ElementsAre(1, 4, 2, 5, 0, 3));
  ExpectGrouped(sites, ThreeSpans());
}

TEST(GroupBySpan, NeverUsesAnEmptySpan) {
  const BsplineBasis basis = BasisOf(2, false, {0, 0, 0, 1, 1, 2, 2, 2});
  const std::vector<double> parameters = {1.0, 2.0, 0.999, 0.0};
  ExpectGrouped(SitesAt(parameters, basis), basis);
}

TEST(GroupBySpan, OfNothingIsNothing) {
  const Sites sites = SitesAt({}, ThreeSpans());
  EXPECT_THAT(sites.order, IsEmpty());
  EXPECT_THAT(sites.groups, IsEmpty());
}

TEST(GroupBySpan, ForgetsAnEarlierGrouping) {
  const std::vector<double> parameters = {2.5, 0.5, 1.5};
  Sites sites = SitesAt(parameters, ThreeSpans());
  GroupBySpan(ThreeSpans(), IsNondecreasing(sites.parameters, sites.size), &sites);
  ExpectGrouped(sites, ThreeSpans());
}

TEST(GroupBySpan, GroupsRandomParametersOfEveryKindOfSpline) {
  std::mt19937 random(20240703);
  for (const SplineKind& kind : AllSplineKinds()) {
    for (const BsplineBasis& basis : MakeBases(kind, &random)) {
      std::vector<double> parameters;
      for (int i = 0; i < 40; ++i) parameters.push_back(RandomParameter(basis, &random));
      SCOPED_TRACE(kind.Name());
      ExpectGrouped(SitesAt(parameters, basis), basis);
      std::sort(parameters.begin(), parameters.end());
      ExpectGrouped(SitesAt(parameters, basis), basis);
    }
  }
}

TEST(GroupBySpan, ChangesNoEnergyAndNoGradient) {
  std::mt19937 random(20240704);
  const SplineKind kind = {3, EndKnots::kPeriodic, false};
  const BsplineBasis basis = MakeBasis(kind, 8, &random);
  const ExampleFit unsorted(basis, 2, 30, true, &random);
  ASSERT_FALSE(unsorted.sites.order.empty());

  // The same data in the order of their parameters.
  std::vector<int> order(30);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return unsorted.parameters[a] < unsorted.parameters[b]; });
  ExampleFit sorted(basis, 2, 30, true, &random);
  for (int i = 0; i < 30; ++i) {
    sorted.parameters[i] = unsorted.parameters[order[i]];
    sorted.weights[i] = unsorted.weights[order[i]];
    sorted.points.row(i) = unsorted.points.row(order[i]);
  }
  GroupBySpan(sorted.basis, IsNondecreasing(sorted.sites.parameters, sorted.sites.size),
              &sorted.sites);
  ASSERT_TRUE(sorted.sites.order.empty());

  const auto term = MakeInterpolationTerm();
  const OptionValues options(CommonTermOptions());
  std::string error;
  const auto a = term->MakeFamily(unsorted.setting, options, &error);
  const auto b = term->MakeFamily(sorted.setting, options, &error);
  const Eigen::VectorXd x = unsorted.RandomVariables(&random);
  const double tolerance = 60 * 3 * kEpsilon;  // 60 squares, weights up to 3
  EXPECT_NEAR(EnergyAt(*a, x), EnergyAt(*b, x), tolerance);
  EXPECT_LT((GradientAt(*a, x) - GradientAt(*b, x)).norm(), 4 * tolerance);
}

/// Columns that the sites of a part touch.
std::set<int> ColumnsOf(const BsplineBasis& basis, const Sites& sites, int first, int end) {
  std::set<int> columns;
  for (int g = first; g < end; ++g) {
    for (int j = 0; j <= basis.degree(); ++j) {
      columns.insert(basis.ControlPointIndex(sites.groups[g].span - basis.degree() + j));
    }
  }
  return columns;
}

std::vector<double> SpreadOver(const BsplineBasis& basis, int count, double power) {
  std::vector<double> parameters;
  for (int i = 0; i < count; ++i) {
    parameters.push_back(basis.domain_begin() +
                         basis.domain_length() * std::pow((i + 0.5) / count, power));
  }
  return parameters;
}

TEST(CutIntoParts, LetsEveryOtherPartBeSummedWithoutLocks) {
  constexpr int kSites = 200000;
  for (const bool periodic : {false, true}) {
    for (const int degree : {1, 3, 5}) {
      for (const int n : {6, 13, 40, 1000}) {
        for (const double power : {1.0, 4.0}) {
          const BsplineBasis basis = BasisOf(
              degree, periodic,
              UniformKnots(degree, n, periodic ? EndKnots::kPeriodic : EndKnots::kEndInterpolating,
                           0.0, 1.0));
          const std::vector<double> parameters = SpreadOver(basis, kSites, power);
          const Sites sites = SitesAt(parameters, basis);
          const std::vector<int> begins = CutIntoParts(basis, sites);
          const auto parts = static_cast<int>(begins.size()) - 1;
          ASSERT_GE(parts, 1);
          EXPECT_TRUE(parts == 1 || parts % 2 == 0);
          if (n == 1000) {
            EXPECT_GE(parts, 4);
          }
          EXPECT_EQ(begins.front(), 0);
          EXPECT_EQ(begins.back(), static_cast<int>(sites.groups.size()));
          for (const int parity : {0, 1}) {
            std::set<int> touched;
            for (int k = parity; parts > 1 && k < parts; k += 2) {
              for (const int column : ColumnsOf(basis, sites, begins[k], begins[k + 1])) {
                EXPECT_TRUE(touched.insert(column).second)
                    << "column " << column << " of " << n << ", degree " << degree;
              }
            }
          }
        }
      }
    }
  }
}

TEST(CutIntoParts, LeavesFewSitesTogether) {
  const std::vector<double> parameters = {0.0, 0.5, 2.0, 2.5, 3.0};
  const Sites sites = SitesAt(parameters, ThreeSpans());
  EXPECT_THAT(CutIntoParts(ThreeSpans(), sites), ElementsAre(0, 2));
  const Sites none = SitesAt({}, ThreeSpans());
  EXPECT_THAT(CutIntoParts(ThreeSpans(), none), ElementsAre(0, 0));
}

}  // namespace
}  // namespace batten
