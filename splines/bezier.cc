#include "splines/bezier.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

namespace batten {
namespace {

// The step of de Casteljau's algorithm. From the nearer operand: with weights 1 - t and t, whose
// sum is not 1 after rounding, 25 levels were off by up to 57 roundings after a few cuts; so, 5.
struct Halve {
  double operator()(double a, double b) const { return 0.5 * (a + b); }
};
struct FromFirst {
  double t;  // up to 1/2
  double operator()(double a, double b) const { return a + t * (b - a); }
};
struct FromSecond {
  double s;  // 1 - t, exactly
  double operator()(double a, double b) const { return b + s * (a - b); }
};

// Where level r is finished in place, entry n - r keeps its value until the end: what is left is
// the second piece. The first piece is entry 0 of every level.
template <int d, typename Step>
void CutAnyDegree(int n, const Step& step, const double* points, double* first, double* second) {
  if (second != points) std::copy(points, points + (n + 1) * d, second);
  for (int c = 0; c < d; ++c) first[c] = second[c];
  for (int r = 1; r <= n; ++r) {
    const int count = (n + 1 - r) * d;
    for (int k = 0; k < count; ++k) second[k] = step(second[k], second[k + d]);
    for (int c = 0; c < d; ++c) first[r * d + c] = second[c];
  }
}

// With the degree known everything stays in registers, which at degree 3 is twice as fast.
template <int d, int n, typename Step>
void CutKnownDegree(const Step& step, const double* points, double* first, double* second) {
  double b[(n + 1) * d];
  for (int k = 0; k < (n + 1) * d; ++k) b[k] = points[k];
  for (int c = 0; c < d; ++c) first[c] = b[c];
  for (int r = 1; r <= n; ++r) {
    for (int k = 0; k < (n + 1 - r) * d; ++k) b[k] = step(b[k], b[k + d]);
    for (int c = 0; c < d; ++c) first[r * d + c] = b[c];
  }
  for (int k = 0; k < (n + 1) * d; ++k) second[k] = b[k];
}

template <int d, typename Step>
void CutInDimension(int n, const Step& step, const double* points, double* first, double* second) {
  switch (n) {
    case 2:
      return CutKnownDegree<d, 2>(step, points, first, second);
    case 3:
      return CutKnownDegree<d, 3>(step, points, first, second);
    case 4:
      return CutKnownDegree<d, 4>(step, points, first, second);
    case 5:
      return CutKnownDegree<d, 5>(step, points, first, second);
    default:
      return CutAnyDegree<d>(n, step, points, first, second);
  }
}

template <typename Step>
void CutByStep(int n, int dimension, const Step& step, const double* points, double* first,
               double* second) {
  switch (dimension) {
    case 1:
      return CutInDimension<1>(n, step, points, first, second);
    case 2:
      return CutInDimension<2>(n, step, points, first, second);
    case 3:
      return CutInDimension<3>(n, step, points, first, second);
    default:
      return CutInDimension<4>(n, step, points, first, second);
  }
}

bool IsUsable(const Points& points, std::string* error) {
  if (points.rows() < 1 || points.rows() > kMaxBezierDegree + 1) {
    return FailWith("found " + std::to_string(points.rows()) + " control points; allowed: 1 to " +
                        std::to_string(kMaxBezierDegree + 1),
                    error);
  }
  if (points.cols() < 1 || points.cols() > kMaxDimension) {
    return FailWith("found control points of " + std::to_string(points.cols()) +
                        " coordinates; allowed: 1 to " + std::to_string(kMaxDimension),
                    error);
  }
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    if (!points.row(i).allFinite()) {
      return FailWith("control point " + std::to_string(i) + " is not finite", error);
    }
  }
  return true;
}

}  // namespace

void CutBezier(int degree, int dimension, double t, const double* points, double* first,
               double* second) {
  constexpr double kHalf = 0.5;
  if (t == kHalf) return CutByStep(degree, dimension, Halve(), points, first, second);
  if (t < kHalf) return CutByStep(degree, dimension, FromFirst{t}, points, first, second);
  CutByStep(degree, dimension, FromSecond{1.0 - t}, points, first, second);
}

void EvaluateBezier(int degree, int dimension, const double* points, double t, double* result) {
  std::array<double, kMaxBezierNumbers> first, second;
  CutBezier(degree, dimension, t, points, first.data(), second.data());
  std::copy(second.begin(), second.begin() + dimension, result);
}

std::optional<BezierCurve> BezierCurve::Make(Points control_points, std::string* error) {
  if (!IsUsable(control_points, error)) return std::nullopt;
  return BezierCurve(std::move(control_points));
}

void BezierCurve::Evaluate(double t, double* result) const {
  EvaluateBezier(degree(), dimension(), control_points_.data(), t, result);
}

BezierCurve BezierCurve::Derivative() const {
  const int n = degree();
  if (n == 0) return BezierCurve(Points::Zero(1, dimension()));
  return BezierCurve(n * (control_points_.bottomRows(n) - control_points_.topRows(n)));
}

BezierCurve BezierCurve::Part(double begin, double end) const {
  if (!(0.0 <= begin && begin < end && end <= 1.0)) {
    throw std::logic_error("part [" + std::to_string(begin) + ", " + std::to_string(end) +
                           "] must lie in [0, 1]");
  }
  Points first(control_points_.rows(), control_points_.cols());
  Points second = first;
  CutBezier(degree(), dimension(), end, control_points_.data(), first.data(), second.data());
  const Points up_to_end = first;
  CutBezier(degree(), dimension(), begin / end, up_to_end.data(), first.data(), second.data());
  return BezierCurve(std::move(second));
}

BezierCurve BezierCurve::Raised(int levels) const {
  if (levels < 0 || degree() + levels > kMaxBezierDegree) {
    throw std::logic_error("degree raised to " + std::to_string(degree() + levels) + ", must be " +
                           std::to_string(degree()) + " to " + std::to_string(kMaxBezierDegree));
  }
  Points points = control_points_;
  for (int level = 0; level < levels; ++level) {
    const auto n = static_cast<int>(points.rows()) - 1;
    Points raised(n + 2, points.cols());
    raised.row(0) = points.row(0);
    raised.row(n + 1) = points.row(n);
    for (int i = 1; i <= n; ++i) {
      const double share = i / (n + 1.0);
      raised.row(i) = share * points.row(i - 1) + (1.0 - share) * points.row(i);
    }
    points = std::move(raised);
  }
  return BezierCurve(std::move(points));
}

}  // namespace batten
