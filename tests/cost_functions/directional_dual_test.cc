#include "cost_functions/directional_dual.h"

#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include "tests/roundoff.h"

namespace batten {
namespace {

using Dual = DirectionalDual<double>;
using Jet = ceres::Jet<double, 2>;
using Second = DirectionalDual<Jet>;

/// A function of two variables that uses one operation; defined for first > second > 0.
struct Operation {
  std::string name;
  double (*value)(double, double);
  Dual (*dual)(Dual, Dual);
  Second (*second)(Second, Second);
};

// One generic lambda for the three scalars.
template <typename Function>
Operation MakeOperation(const std::string& name, Function function) {
  return {name, function, function, function};
}

// The other argument stands in every function, so that the mixed derivatives do not vanish.
std::vector<Operation> AllOperations() {
  // Unqualified, found for the double in std and for the others beside their types.
  using std::abs;
  using std::atan2;
  using std::cos;
  using std::exp;
  using std::log;
  using std::pow;
  using std::sin;
  using std::sqrt;
  return {
      MakeOperation("Sum", [](auto x, auto y) { return x * x + y * y * y; }),
      MakeOperation("Difference", [](auto x, auto y) { return x * x * x - 2.0 * x * y - 0.5; }),
      MakeOperation("Negation", [](auto x, auto y) { return -(x * y * y); }),
      MakeOperation("Product", [](auto x, auto y) { return x * y * x; }),
      MakeOperation("Quotient", [](auto x, auto y) { return x / (y * y) + 1.0 / x; }),
      MakeOperation("InPlace",
                    [](auto x, auto y) {
                      auto z = x;
                      z += y * y;
                      z *= x;
                      z -= 2.0 * y;
                      z /= y;
                      return z;
                    }),
      MakeOperation("Sqrt", [](auto x, auto y) { return sqrt(x * y + x); }),
      MakeOperation("Exp", [](auto x, auto y) { return exp(0.5 * x * y); }),
      MakeOperation("Log", [](auto x, auto y) { return log(x * x + y); }),
      MakeOperation("Sin", [](auto x, auto y) { return sin(x * y); }),
      MakeOperation("Cos", [](auto x, auto y) { return cos(x * y); }),
      MakeOperation("Atan2", [](auto x, auto y) { return atan2(x * y, x - y); }),
      MakeOperation("Pow", [](auto x, auto y) { return pow(x * y, 2.5); }),
      MakeOperation("AbsOfNegative", [](auto x, auto y) { return abs(y * y * y - x * x * x); }),
      MakeOperation("AbsOfPositive", [](auto x, auto y) { return abs(x * x * x - y * y * y); }),
  };
}

void PrintTo(const Operation& each, std::ostream* stream) { *stream << each.name; }

class DualOperation : public ::testing::TestWithParam<Operation> {
 protected:
  // Away from the diagonal and from each other.
  static constexpr double kX = 1.3;
  static constexpr double kY = 0.7;
  static constexpr double kDirection[] = {0.6, -1.1};
  double AlongDirection(double h) const {
    return GetParam().value(kX + h * kDirection[0], kY + h * kDirection[1]);
  }
};

TEST_P(DualOperation, HasTheValueOfTheFunction) {
  const Dual result = GetParam().dual({kX, 0.6}, {kY, -1.1});
  EXPECT_DOUBLE_EQ(result.value, GetParam().value(kX, kY));
}

/// |difference quotient - slope| at steps 2^-5, 2^-6; the central one loses a factor of 4 each
/// time.
TEST_P(DualOperation, SlopeIsTheLimitOfCentralDifferencesWithOrderTwo) {
  const Dual result = GetParam().dual({kX, kDirection[0]}, {kY, kDirection[1]});
  const auto error = [&](double h) {
    return std::abs((AlongDirection(h) - AlongDirection(-h)) / (2.0 * h) - result.slope);
  };
  const double coarse = error(1.0 / 32.0);
  const double fine = error(1.0 / 64.0);
  // A cubic's truncation error is h^2 times a constant, so is every other's up to h^4.
  ASSERT_GT(fine, 1e-9) << "a function without third derivative shows no order";
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.05);
}

TEST_P(DualOperation, OverJetsGivesTheHessianTimesTheDirection) {
  const Second x(Jet(kX, 0), Jet(kDirection[0]));
  const Second y(Jet(kY, 1), Jet(kDirection[1]));
  const Second result = GetParam().second(x, y);
  EXPECT_DOUBLE_EQ(result.value.a, GetParam().value(kX, kY));

  // The same derivatives from plain duals, one axis at a time, differenced along the direction.
  const auto derivative = [&](int axis, double h) {
    return GetParam()
        .dual({kX + h * kDirection[0], axis == 0 ? 1.0 : 0.0},
              {kY + h * kDirection[1], axis == 1 ? 1.0 : 0.0})
        .slope;
  };
  const double step = std::cbrt(kEpsilon);
  const double tolerance = 1000 * step * step;  // fourth derivatives are below 1000
  for (int axis = 0; axis < 2; ++axis) {
    EXPECT_NEAR(result.value.v[axis], derivative(axis, 0.0), 1e-13);
    const double difference = (derivative(axis, step) - derivative(axis, -step)) / (2.0 * step);
    EXPECT_NEAR(result.slope.v[axis], difference, tolerance);
  }
  // Its own value along the direction is the first derivative.
  EXPECT_NEAR(result.slope.a, GetParam().dual({kX, kDirection[0]}, {kY, kDirection[1]}).slope,
              1e-13);
}

INSTANTIATE_TEST_SUITE_P(All, DualOperation, ::testing::ValuesIn(AllOperations()),
                         [](const auto& each) { return each.param.name; });

TEST(DirectionalDual, OfANumberHasNoSlope) {
  const Dual three = 3.0;
  EXPECT_EQ(three.value, 3.0);
  EXPECT_EQ(three.slope, 0.0);
  const Second four = 4.0;
  EXPECT_EQ(four.value.a, 4.0);
  EXPECT_EQ(four.slope.a, 0.0);
  EXPECT_EQ(four.value.v[1], 0.0);
}

TEST(DirectionalDual, ComparesByValueOnly) {
  const Dual small(1.0, 9.0);
  const Dual large(2.0, -9.0);
  EXPECT_TRUE(small < large);
  EXPECT_TRUE(large > small);
  EXPECT_TRUE(small <= Dual(1.0));
  EXPECT_TRUE(small >= Dual(1.0));
  EXPECT_TRUE(small == Dual(1.0));
  EXPECT_TRUE(small != large);
}

TEST(DirectionalDual, ClosedFormsOfAQuadratic) {
  // f = x^2 + 3 x y at (2, 5) along (1, -1): f = 34, slope = (2x + 3y) - 3x = 13,
  // Hessian (2 3; 3 0) times (1, -1) = (-1, 3).
  const auto f = [](const auto& x, const auto& y) { return x * x + 3.0 * x * y; };
  const Second result = f(Second(Jet(2.0, 0), Jet(1.0)), Second(Jet(5.0, 1), Jet(-1.0)));
  EXPECT_EQ(result.value.a, 34.0);
  EXPECT_EQ(result.value.v, Eigen::Vector2d(19.0, 6.0));
  EXPECT_EQ(result.slope.a, 13.0);
  EXPECT_EQ(result.slope.v, Eigen::Vector2d(-1.0, 3.0));
}

}  // namespace
}  // namespace batten
