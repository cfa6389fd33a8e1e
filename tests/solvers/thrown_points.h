#ifndef BATTEN_TESTS_SOLVERS_THROWN_POINTS_H_
#define BATTEN_TESTS_SOLVERS_THROWN_POINTS_H_

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "splines/closest_point.h"
#include "tests/solvers/test_fits.h"

namespace batten {

/// A smooth closed curve of size about 2 with noise, a tenth of its points thrown up to half that
/// far away, and the curve itself.
struct ThrownPoints {
  ThrownPoints(unsigned seed, bool thrown) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0.0, 0.01);
    std::uniform_real_distribution<double> far(-1.0, 1.0);
    const int m = 200;
    data.name = "thrown";
    data.points.resize(m, 2);
    truth.resize(m, 2);
    for (int i = 0; i < m; ++i) {
      const double a = 2.0 * M_PI * i / m;
      truth.row(i) << std::cos(a) + 0.15 * std::cos(3 * a), 0.8 * std::sin(a);
      data.points.row(i) = truth.row(i) + Eigen::RowVector2d(noise(random), noise(random));
    }
    std::vector<int> order(m);
    for (int i = 0; i < m; ++i) order[i] = i;
    std::shuffle(order.begin(), order.end(), random);
    for (int k = 0; k < m / 10; ++k) {
      const Eigen::RowVector2d away(far(random), far(random));
      if (thrown) data.points.row(order[k]) += away;
    }
  }
  std::unique_ptr<Problem> Fit(const std::string& terms, ParameterKind kind = ParameterKind::kFixed,
                               int control_points = 20) const {
    FitSpec spec = MakeSpec(3, true, control_points, terms);
    spec.parameters = Parameterization::kUniform;
    spec.parameter_kind = kind;
    return MakeFit(data, spec);
  }
  /// Root mean square distance of the curve from the truth at the data's parameters.
  double Error(const Problem& problem, const Eigen::VectorXd& x) const {
    const CurveFit& fit = *problem.curve_fit();
    return std::sqrt((fit.Curve(x).Sample(fit.parameters()) - truth).squaredNorm() /
                     static_cast<double>(truth.rows()));
  }
  /// Root mean square distance of the truth's points from the curve, at their feet.
  double ErrorAtFeet(const Problem& problem, const Eigen::VectorXd& x) const {
    const BsplineCurve curve = problem.curve_fit()->Curve(x);
    Eigen::VectorXd t = Eigen::VectorXd::Zero(truth.rows()), squared;
    ClosestPoint(curve).FindAll(truth, 1, &t, &squared);
    return std::sqrt(squared.mean());
  }
  DataSet data;
  Points truth;
};

inline double Median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

}  // namespace batten

#endif  // BATTEN_TESTS_SOLVERS_THROWN_POINTS_H_
