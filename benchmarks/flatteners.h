#ifndef BATTEN_BENCHMARKS_FLATTENERS_H_
#define BATTEN_BENCHMARKS_FLATTENERS_H_

#include <algorithm>
#include <cmath>
#include <vector>

#include "splines/bezier.h"

namespace batten {

// Flatteners that font and vector renderers use, each after its publication; planar curves. They
// append the parameters of vertices to `parameters`, from 0 to 1. None of them promises its
// tolerance; they are compared at the true error that they have.

/// Equal steps, as many as Wang's bound asks for (Wang 1984; Filip, Magedson, Markot, CAGD 3,
/// 1986): sqrt(n (n - 1) / 8 max |second difference| / tolerance).
inline void FlattenByWang(const BezierCurve& curve, double tolerance,
                          std::vector<double>* parameters) {
  const Points& p = curve.control_points();
  const int n = curve.degree();
  double largest = 0.0;
  for (int i = 0; i + 2 <= n; ++i) {
    largest = std::max(largest, (p.row(i + 2) - 2.0 * p.row(i + 1) + p.row(i)).squaredNorm());
  }
  const double count = std::sqrt(n * (n - 1) / 8.0 * std::sqrt(largest) / tolerance);
  const int steps = std::max(1, static_cast<int>(std::ceil(count)));
  for (int k = 0; k <= steps; ++k) parameters->push_back(k / static_cast<double>(steps));
}

/// Levien's flattening of a parabola (raphlinus.github.io, 2019): equal steps in an approximation
/// of the integral of the fourth root of the curvature that can be inverted in closed form.
inline void FlattenByLevien(const BezierCurve& parabola, double tolerance,
                            std::vector<double>* parameters) {
  // The integral of (1 + 4 x^2)^(-1/4) over the parabola y = x^2, and its inverse.
  const auto integral = [](double x) {
    constexpr double d = 0.67;
    return x / (1.0 - d + std::sqrt(std::sqrt(d * d * d * d + 0.25 * x * x)));
  };
  const auto inverse = [](double x) {
    constexpr double b = 0.39;
    return x * (1.0 - b + std::sqrt(b * b + 0.25 * x * x));
  };
  const Points& p = parabola.control_points();
  const Eigen::RowVector2d first = p.row(1) - p.row(0), second = p.row(2) - p.row(1);
  const Eigen::RowVector2d bend = first - second, chord = p.row(2) - p.row(0);
  const double cross = chord[0] * bend[1] - chord[1] * bend[0];
  // The curve's ends on the parabola y = x^2 that it is a scaled part of.
  const double x0 = first.dot(bend) / cross, x2 = second.dot(bend) / cross;
  const double scale = std::abs(cross / (bend.norm() * (x2 - x0)));
  parameters->push_back(0.0);
  if (std::isfinite(scale) && scale > 0.0) {
    const double a0 = integral(x0), a2 = integral(x2);
    const int steps = std::max(
        1, static_cast<int>(std::ceil(0.5 * std::abs(a2 - a0) * std::sqrt(scale / tolerance))));
    const double u0 = inverse(a0), u2 = inverse(a2);
    for (int k = 1; k < steps; ++k) {
      parameters->push_back((inverse(a0 + (a2 - a0) * k / steps) - u0) / (u2 - u0));
    }
  }
  parameters->push_back(1.0);
}

/// Hain, Ahmad, Racherla, Langan, Computers & Graphics 29, 2005: a cubic is a parabola near its
/// begin, s2 t^2 from the tangent, and steps of 2 sqrt(tolerance / (3 |s2|)) are cut off; around
/// points of inflection a stretch of 2 cbrt(tolerance / |s3|) is one step.
class HainFlattener {
 public:
  HainFlattener(const BezierCurve& cubic, double tolerance, std::vector<double>* parameters)
      : cubic_(cubic), tolerance_(tolerance), parameters_(*parameters) {}

  void Run() {
    parameters_.push_back(0.0);
    double done = 0.0;
    for (const double inflection : Inflections()) {
      const double reach = ReachAround(inflection);
      StepTo(std::min(1.0, inflection - reach), &done);
      done = std::max(done, std::min(1.0, inflection + reach));
      if (done > parameters_.back() && done < 1.0) parameters_.push_back(done);
    }
    StepTo(1.0, &done);
    if (parameters_.back() < 1.0) parameters_.push_back(1.0);
  }

 private:
  std::vector<double> Inflections() const {
    const Points& p = cubic_.control_points();
    const Eigen::RowVector2d a = p.row(3) - 3 * p.row(2) + 3 * p.row(1) - p.row(0);
    const Eigen::RowVector2d b = 3 * (p.row(2) - 2 * p.row(1) + p.row(0));
    const Eigen::RowVector2d c = 3 * (p.row(1) - p.row(0));
    const auto cross = [](const Eigen::RowVector2d& u, const Eigen::RowVector2d& v) {
      return u[0] * v[1] - u[1] * v[0];
    };
    // C' x C'' = 0: 3 (a x b) t^2 + 3 (a x c) t + (b x c) = 0.
    const double k2 = 3 * cross(a, b), k1 = 3 * cross(a, c), k0 = cross(b, c);
    std::vector<double> found;
    const double discriminant = k1 * k1 - 4 * k2 * k0;
    if (k2 == 0.0 || discriminant < 0.0) return found;
    for (const double sign : {-1.0, 1.0}) {
      const double t = (-k1 + sign * std::sqrt(discriminant)) / (2 * k2);
      if (t > 0.0 && t < 1.0) found.push_back(t);
    }
    std::sort(found.begin(), found.end());
    return found;
  }

  /// Distance of point i of the rest [begin, 1] from its begin's tangent.
  static double Offset(const double* q, int i) {
    const double x = q[2] - q[0], y = q[3] - q[1];
    return std::abs((q[2 * i] - q[0]) * y - (q[2 * i + 1] - q[1]) * x) / std::hypot(x, y);
  }

  double ReachAround(double t) const {
    double before[8], rest[8];
    CutBezier(3, 2, t, cubic_.control_points().data(), before, rest);
    const double s3 = Offset(rest, 3);
    return s3 > 0.0 ? std::cbrt(tolerance_ / s3) * (1.0 - t) : 1.0;
  }

  void StepTo(double end, double* done) {
    double rest[8], before[8];
    while (*done < end) {
      CutBezier(3, 2, *done, cubic_.control_points().data(), before, rest);
      const double s2 = Offset(rest, 2);
      const double step = s2 > 0.0 ? 2.0 * std::sqrt(tolerance_ / (3.0 * s2)) : 1.0;
      *done = std::min(end, *done + step * (1.0 - *done));
      if (*done < 1.0) parameters_.push_back(*done);
    }
  }

  const BezierCurve& cubic_;
  const double tolerance_;
  std::vector<double>& parameters_;
};

inline void FlattenByHain(const BezierCurve& cubic, double tolerance,
                          std::vector<double>* parameters) {
  HainFlattener(cubic, tolerance, parameters).Run();
}

}  // namespace batten

#endif  // BATTEN_BENCHMARKS_FLATTENERS_H_
