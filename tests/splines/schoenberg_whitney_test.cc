#include "splines/schoenberg_whitney.h"

#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <random>

#include "tests/splines/example_splines.h"

namespace batten {
namespace {

/// Control points that can be given a parameter of their own, by augmenting paths, from the
/// recursive definition of the basis.
int LargestMatching(const BsplineBasis& basis, std::vector<double> t) {
  std::sort(t.begin(), t.end());
  t.erase(std::unique(t.begin(), t.end()), t.end());
  const int n = basis.num_control_points();
  const auto touches = [&](int j, double at) {
    if (!basis.periodic() && at == basis.knots().back()) return j == n - 1;
    for (int f = j; f < (basis.periodic() ? n + basis.degree() : n); f += n) {
      if (BasisByDefinition(basis.knots(), f, basis.degree(), at) > 0.0L) return true;
    }
    return false;
  };
  std::vector<int> owner(t.size(), -1);
  const std::function<bool(int, std::vector<bool>*)> place = [&](int j, std::vector<bool>* seen) {
    for (std::size_t i = 0; i < t.size(); ++i) {
      if ((*seen)[i] || !touches(j, t[i])) continue;
      (*seen)[i] = true;
      if (owner[i] < 0 || place(owner[i], seen)) {
        owner[i] = j;
        return true;
      }
    }
    return false;
  };
  int size = 0;
  for (int j = 0; j < n; ++j) {
    std::vector<bool> seen(t.size(), false);
    size += place(j, &seen) ? 1 : 0;
  }
  return size;
}

TEST(LargestDataShortage, IsThereExactlyWhereNoMatchingServesAllControlPoints) {
  std::mt19937 random(20240911);
  int num_short = 0;
  for (int round = 0; round < 400; ++round) {
    const int degree = 1 + round % 5;
    const EndKnots ends[] = {EndKnots::kPeriodic, EndKnots::kEndInterpolating, EndKnots::kFloating};
    const SplineKind kind = {degree, ends[round % 3], round % 2 == 0};
    const int n = degree + 2 + static_cast<int>(random() % 12);
    const BsplineBasis basis = MakeBasis(kind, n, &random);
    std::vector<double> t;
    const auto m = static_cast<int>(random() % 25);
    for (int i = 0; i < m; ++i) {
      // Some equal, some at knots of the domain.
      const int choice = static_cast<int>(random() % 4);
      if (choice == 0 && i > 0) {
        t.push_back(t.back());
      } else if (choice == 1) {
        const auto spans = static_cast<unsigned>(basis.num_domain_spans());
        t.push_back(basis.knots()[static_cast<std::size_t>(degree) + random() % spans]);
      } else {
        t.push_back(RandomParameter(basis, &random));
      }
    }
    const DataShortage shortage = LargestDataShortage(basis, t);
    const int left_over = n - LargestMatching(basis, t);
    // Several runs may lack data: the largest shortage is one of them.
    const int largest = shortage.num_control_points - shortage.num_parameters;
    EXPECT_EQ(largest > 0, left_over > 0)
        << kind.Name() << " n = " << n << " m = " << m << " round " << round;
    EXPECT_LE(largest, left_over) << kind.Name() << " round " << round;
    num_short += left_over > 0 ? 1 : 0;
  }
  EXPECT_GT(num_short, 100);
  EXPECT_LT(num_short, 350);
}

TEST(LargestDataShortage, NamesTheRunOfControlPoints) {
  // Cubic on knots 0, 1, ..., 13, domain [3, 10]: parameters in [3, 5] and [9, 10] only. Control
  // points 5, 6, 7, 8 live inside (5, 12), but 6, ..., 8 have (6, 12) with the points of [9, 10].
  const BsplineBasis basis = BasisOf(3, false, UniformKnots(3, 10, EndKnots::kFloating, 3.0, 10.0));
  std::vector<double> t;
  for (int i = 0; i <= 10; ++i) t.push_back(3.0 + 0.2 * i);
  EXPECT_EQ(LargestDataShortage(basis, t).first_control_point, 5);
  EXPECT_EQ(LargestDataShortage(basis, t).num_control_points, 5);
  EXPECT_EQ(LargestDataShortage(basis, t).num_parameters, 0);
  for (int i = 1; i <= 5; ++i) t.push_back(9.0 + 0.2 * i);
  EXPECT_EQ(LargestDataShortage(basis, t).num_control_points, 1);
  EXPECT_EQ(LargestDataShortage(basis, t).first_control_point, 5);
  t.push_back(7.0);
  EXPECT_EQ(LargestDataShortage(basis, t).num_control_points, 0);
}

}  // namespace
}  // namespace batten
