#include "solvers/line_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "tests/roundoff.h"

namespace batten {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// phi in closed form; no number where value or slope is not finite.
class ClosedForm : public LineFunction {
 public:
  using Function = std::function<double(double)>;
  ClosedForm(Function value, Function slope) : value_(std::move(value)), slope_(std::move(slope)) {}

  Status Evaluate(LinePoint* point) override {
    ++num_evaluations;
    point->change = value_(point->step) - value_(0.0);
    point->slope = slope_(point->step);
    if (num_evaluations > stop_after) return Status::kStop;
    return std::isfinite(point->change) && std::isfinite(point->slope) ? Status::kOk
                                                                       : Status::kNonFinite;
  }
  double slope_at_zero() const { return slope_(0.0); }

  int num_evaluations = 0;
  int stop_after = std::numeric_limits<int>::max();

 private:
  Function value_;
  Function slope_;
};

struct NamedFunction {
  std::string name;
  ClosedForm::Function value;
  ClosedForm::Function slope;
};

double Power(double base, int exponent) { return std::pow(base, exponent); }

std::vector<NamedFunction> Functions() {
  return {
      {"parabola", [](double a) { return a * (a - 2.0); }, [](double a) { return 2.0 * a - 2.0; }},
      {"far parabola", [](double a) { return 1e-6 * a * (a - 2e5); },
       [](double a) { return 1e-6 * (2.0 * a - 2e5); }},
      {"near parabola", [](double a) { return 1e6 * a * (a - 2e-5); },
       [](double a) { return 1e6 * (2.0 * a - 2e-5); }},
      // The first two functions of More and Thuente, ACM TOMS 20, 1994.
      {"More and Thuente 1", [](double a) { return -a / (a * a + 2.0); },
       [](double a) { return (a * a - 2.0) / Power(a * a + 2.0, 2); }},
      {"More and Thuente 2",
       [](double a) { return Power(a + 0.004, 5) - 2.0 * Power(a + 0.004, 4); },
       [](double a) { return 5.0 * Power(a + 0.004, 4) - 8.0 * Power(a + 0.004, 3); }},
      {"wavy", [](double a) { return -a + 0.9 * std::sin(3.0 * a) / 3.0 + 0.01 * a * a; },
       [](double a) { return -1.0 + 0.9 * std::cos(3.0 * a) + 0.02 * a; }},
      {"barrier at 2", [](double a) { return -a - 0.1 * std::log(2.0 - a); },
       [](double a) { return a < 2.0 ? -1.0 + 0.1 / (2.0 - a) : kInfinity; }},
      {"barrier at 1e-4", [](double a) { return -a - 1e-6 * std::log(1e-4 - a); },
       [](double a) { return a < 1e-4 ? -1.0 + 1e-6 / (1e-4 - a) : kInfinity; }},
      {"no number from 0.7 on", [](double a) { return a < 0.7 ? a * (a - 1.0) : kInfinity; },
       [](double a) { return a < 0.7 ? 2.0 * a - 1.0 : kInfinity; }},
  };
}

TEST(SearchWolfe, FindsAStepThatMeetsTheConditionsFromAnyFirstStep) {
  for (const NamedFunction& row : Functions()) {
    for (const bool strong : {false, true}) {
      for (const double c2 : {0.9, 0.1}) {
        for (const double first : {1e-7, 1e-2, 1.0, 60.0, 1e7}) {
          SCOPED_TRACE(row.name + (strong ? " strong " : " weak ") + std::to_string(c2) + " from " +
                       std::to_string(first));
          WolfeOptions options;
          options.strong = strong;
          options.curvature = c2;
          ClosedForm line(row.value, row.slope);
          const double slope = line.slope_at_zero();
          LinePoint found;
          ASSERT_EQ(SearchWolfe(options, slope, first, &line, &found), LineSearchEnd::kFound);
          EXPECT_LE(line.num_evaluations, options.max_evaluations);
          EXPECT_LE(found.change, options.sufficient_decrease * found.step * slope);
          EXPECT_GE(found.slope, c2 * slope);
          if (strong) {
            EXPECT_LE(found.slope, -c2 * slope);
          }
          // What is found is what was evaluated.
          EXPECT_EQ(found.change, row.value(found.step) - row.value(0.0));
          EXPECT_EQ(found.slope, row.slope(found.step));
        }
      }
    }
  }
}

TEST(SearchWolfe, TakesAFirstStepThatWillDo) {
  ClosedForm line([](double a) { return a * (a - 2.0); }, [](double a) { return 2.0 * a - 2.0; });
  LinePoint found;
  EXPECT_EQ(SearchWolfe({}, -2.0, 0.8, &line, &found), LineSearchEnd::kFound);
  EXPECT_EQ(found.step, 0.8);
  EXPECT_EQ(line.num_evaluations, 1);
}

TEST(SearchWolfe, TheCubicThroughAParabolaFindsItsMinimum) {
  WolfeOptions options;
  options.strong = true;
  options.curvature = 0.01;
  ClosedForm line([](double a) { return a * (a - 2.0); }, [](double a) { return 2.0 * a - 2.0; });
  LinePoint found;
  EXPECT_EQ(SearchWolfe(options, -2.0, 1.9, &line, &found), LineSearchEnd::kFound);
  EXPECT_NEAR(found.step, 1.0, 8 * kEpsilon);
  EXPECT_EQ(line.num_evaluations, 2);
}

TEST(SearchWolfe, OnlyStrongConditionsBoundTheSlopeFromAbove) {
  WolfeOptions options;
  options.curvature = 0.5;
  ClosedForm line([](double a) { return a * (a - 2.0); }, [](double a) { return 2.0 * a - 2.0; });
  LinePoint found;
  SearchWolfe(options, -2.0, 1.9, &line, &found);
  EXPECT_EQ(found.step, 1.9);
  options.strong = true;
  SearchWolfe(options, -2.0, 1.9, &line, &found);
  EXPECT_LE(std::abs(found.slope), 1.0);
}

TEST(SearchWolfe, NearRoundingTheSlopesAloneDecide) {
  // phi = c a (a - 2) with c far below the rounding of phi, which shows as a rise of 2 eps.
  const double c = 1e-20;
  const auto value = [](double a) { return a == 0.0 ? 0.0 : 2.0 * kEpsilon; };
  const auto slope = [c](double a) { return c * (2.0 * a - 2.0); };
  for (const double first : {0.03, 1.0, 1.7, 90.0}) {
    ClosedForm line(value, slope);
    WolfeOptions options;
    LinePoint found;
    EXPECT_EQ(SearchWolfe(options, -2.0 * c, first, &line, &found), LineSearchEnd::kNoStep)
        << first;
    options.noise = 8.0 * kEpsilon;
    ASSERT_EQ(SearchWolfe(options, -2.0 * c, first, &line, &found), LineSearchEnd::kFound) << first;
    // (2 c1 - 1) phi'(0) >= phi'(a) >= c2 phi'(0): Hager and Zhang, eq. 4.1.
    EXPECT_LE(found.slope, (2.0 * options.sufficient_decrease - 1.0) * -2.0 * c);
    EXPECT_GE(found.slope, options.curvature * -2.0 * c);
  }
}

TEST(SearchWolfe, NoiseDoesNotExcuseARiseAboveIt) {
  ClosedForm line([](double a) { return a == 0.0 ? 0.0 : 1e-3; }, [](double) { return -1e-6; });
  WolfeOptions options;
  options.noise = 1e-12;
  LinePoint found;
  EXPECT_EQ(SearchWolfe(options, -1.0, 1.0, &line, &found), LineSearchEnd::kNoStep);
}

TEST(SearchWolfe, NoiseDoesNotExcuseATooSmallDecreaseThatIsSeen) {
  // Flat but for a fall of 1e-5 at once: slopes alone would take any step.
  ClosedForm line([](double a) { return a == 0.0 ? 0.0 : -1e-5; },
                  [](double a) { return a == 0.0 ? -1.0 : 0.0; });
  WolfeOptions options;
  options.noise = 1e-12;
  LinePoint found;
  ASSERT_EQ(SearchWolfe(options, -1.0, 10.0, &line, &found), LineSearchEnd::kFound);
  EXPECT_LE(found.change, options.sufficient_decrease * found.step * -1.0);
}

TEST(SearchWolfe, FindsNoStepAlongAnAscent) {
  ClosedForm line([](double a) { return a; }, [](double) { return 1.0; });
  LinePoint found;
  for (const double slope : {0.0, 1.0, std::nan("")}) {
    EXPECT_EQ(SearchWolfe({}, slope, 1.0, &line, &found), LineSearchEnd::kNoStep);
  }
  EXPECT_EQ(line.num_evaluations, 0);
  // The slope at zero says down, every value says up.
  EXPECT_EQ(SearchWolfe({}, -1.0, 1.0, &line, &found), LineSearchEnd::kNoStep);
  EXPECT_LE(line.num_evaluations, WolfeOptions().max_evaluations);
}

TEST(SearchWolfe, TakesTheLastDecreaseWhereTheLineHasNoEnd) {
  ClosedForm line([](double a) { return -a; }, [](double) { return -1.0; });
  LinePoint found;
  EXPECT_EQ(SearchWolfe({}, -1.0, 1.0, &line, &found), LineSearchEnd::kFound);
  EXPECT_GT(found.step, 1e6);
  EXPECT_EQ(found.change, -found.step);
  EXPECT_EQ(line.num_evaluations, WolfeOptions().max_evaluations);
}

TEST(SearchWolfe, LeavesAtOnceWhenToldToStop) {
  for (int allowed = 0; allowed < 5; ++allowed) {
    ClosedForm line([](double a) { return -a; }, [](double) { return -1.0; });
    line.stop_after = allowed;
    LinePoint found;
    EXPECT_EQ(SearchWolfe({}, -1.0, 1.0, &line, &found), LineSearchEnd::kStopped);
    EXPECT_EQ(line.num_evaluations, allowed + 1);
  }
}

}  // namespace
}  // namespace batten
