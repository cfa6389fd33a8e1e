#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "splines/bspline_curve.h"
#include "tests/splines/example_splines.h"

namespace batten {
namespace {

// t, then x and y of derivatives 0, 1, ..., p.
struct Reference {
  double t;
  std::vector<std::vector<double>> derivatives;
};

void ExpectMatches(const BsplineCurve& curve, const std::vector<Reference>& references) {
  const int p = curve.basis().degree();
  for (int d = 0; d <= p; ++d) {
    double largest = 1.0;
    for (const Reference& reference : references) {
      for (const double x : reference.derivatives[d]) largest = std::max(largest, std::abs(x));
    }
    // SciPy and we round some 4 (p + 1) times each, in sums whose terms are up to four times the
    // largest value of their derivative.
    const double tolerance = 4 * 2 * 4 * (p + 1) * kEpsilon * largest;
    for (const Reference& reference : references) {
      double result[2];
      curve.Evaluate(reference.t, d, result);
      for (int c = 0; c < 2; ++c) {
        EXPECT_NEAR(result[c], reference.derivatives[d][c], tolerance)
            << "derivative " << d << " at " << reference.t << ", coordinate " << c;
      }
    }
  }
}

// The references of the next three tests, by SciPy 1.10:
//   s = scipy.interpolate.BSpline(np.array(knots), np.array(points), degree)
//   for t in ...: print(t, [list(s(t, d)) for d in range(degree + 1)])
const std::vector<std::vector<double>> kEightPoints = {{0.0, 1.0},  {0.7, -0.4}, {1.1, 2.3},
                                                       {-0.6, 0.9}, {2.0, 0.2},  {0.3, -1.7},
                                                       {1.4, 0.8},  {-0.5, 0.1}};

TEST(BsplineCurve, CubicWithADoubleKnotMatchesScipy) {
  const std::vector<std::vector<double>> points(kEightPoints.begin(), kEightPoints.begin() + 7);
  const BsplineCurve curve(BasisOf(3, false, {0, 0, 0, 0, 0.3, 0.5, 0.5, 1, 1, 1, 1}),
                           PointsOf(points));
  ExpectMatches(curve, {{0.0,
                         {{0.0, 1.0},
                          {7.0, -14.0},
                          {-30.66666666666667, 201.33333333333334},
                          {-65.77777777777783, -999.1111111111113}}},
                        {0.13,
                         {{0.626781037037037, 0.5154254814814815},
                          {2.4575111111111108, 3.7308444444444437},
                          {-39.217777777777776, 71.44888888888889},
                          {-65.77777777777783, -999.1111111111113}}},
                        {0.42,
                         {{-0.1781668571428571, 1.0477760000000003},
                          {-1.7101714285714298, -4.8816},
                          {107.89714285714282, -6.960000000000019},
                          {1319.1428571428573, 762.0}}},
                        {0.5,
                         {{0.14285714285714296, 0.7000000000000001},
                          {11.142857142857142, -3.0},
                          {-85.37142857142855, -33.599999999999994},
                          {305.1428571428571, 278.4}}},
                        {0.77,
                         {{1.0406611428571428, -0.42142879999999994},
                          {-0.78497142857143, -1.9243200000000003},
                          {-2.982857142857142, 41.568000000000005},
                          {305.1428571428571, 278.4}}}});
}

TEST(BsplineCurve, FloatingQuinticMatchesScipy) {
  const BsplineCurve curve(
      BasisOf(5, false,
              {-2.1, -1.6, -1.3, -0.4, -0.2, 0.0, 0.35, 0.6, 1.0, 1.7, 1.9, 2.2, 3.1, 3.3}),
      PointsOf(kEightPoints));
  ExpectMatches(curve, {{0.0,
                         {{0.813606981712245, 1.4825317783403908},
                          {-1.0969096205938307, 2.41495955754329},
                          {-14.064319695898643, -20.982996447111272},
                          {29.600720916510372, -108.86754925032439},
                          {1363.8820244083406, 1885.2581761672673},
                          {-8442.43982711475, -8004.762413994049}}},
                        {0.21,
                         {{0.40061375237270924, 1.484487142747667},
                          {-1.9766915141896784, -2.130759078670545},
                          {9.194524461620826, -14.630589791190973},
                          {129.8601478543816, 110.53165651623291},
                          {-409.03033928575735, 204.25806922851663},
                          {-8442.43982711475, -8004.762413994049}}},
                        {0.93,
                         {{0.999576502458556, -0.514179955802332},
                          {-0.4522004536915569, -1.5404396814607262},
                          {-3.0090582071894674, 10.659377573041052},
                          {50.15300364579176, 31.587629613207593},
                          {-110.54282233973652, -227.309442111949},
                          {-3233.662352632691, -1973.7031851033648}}}});
}

TEST(BsplineCurve, PeriodicQuarticOfThreePointsMatchesScipy) {
  // SciPy got the seven functions with the three points standing in turn.
  const std::vector<double> turn = {0.0, 0.25, 0.7};
  std::vector<double> knots;
  for (int k = -4; k < 8; ++k) knots.push_back(turn[(k + 6) % 3] + (k + 6) / 3 - 2);
  const std::vector<std::vector<double>> points(kEightPoints.begin(), kEightPoints.begin() + 3);
  const BsplineCurve curve(BasisOf(4, true, knots), PointsOf(points));
  ExpectMatches(curve, {{0.0,
                         {{0.8575367735712563, 1.033871473354232},
                          {0.49819146370870526, 4.219435736677116},
                          {-8.893947431878468, -2.467711598746086},
                          {-36.56194839643115, -255.0169278996865},
                          {492.9682179889078, 1396.1228840125389}}},
                        {0.31,
                         {{0.5923450352891246, 1.493602523586207},
                          {-1.5970729082228121, -1.916975668965517},
                          {2.008550875331565, -16.93126620689655},
                          {67.91084703801945, 94.71411494252874},
                          {-312.8209843796051, 11.672030651341004}}},
                        {0.99,
                         {{0.8521162795642364, 0.9915957411689305},
                          {0.5852931031696273, 4.231558830233367},
                          {-8.525406716501887, 0.02341049111808058},
                          {-37.14619467888433, -243.2074900731452},
                          {58.42462824531782, -1180.9437826541275}}}});
}

}  // namespace
}  // namespace batten
