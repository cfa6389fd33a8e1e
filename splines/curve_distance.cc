#include "splines/curve_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace batten {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

double Dot(const double* a, const double* b, int d) {
  double sum = 0.0;
  for (int c = 0; c < d; ++c) sum += a[c] * b[c];
  return sum;
}

/// `to_point` is Q - C.
double CircleStep(const double* to_point, const double* first, const double* second, int d) {
  const double squared_speed = Dot(first, first, d);
  const double speed = std::sqrt(squared_speed);
  const double along = Dot(first, second, d);
  // Curvature vector k n, n the principal normal.
  double bend[kMaxDimension];
  for (int c = 0; c < d; ++c) {
    bend[c] = (second[c] - along / squared_speed * first[c]) / squared_speed;
  }
  const double tangential = Dot(to_point, first, d) / speed;
  const double curvature = std::sqrt(Dot(bend, bend, d));
  // Angle at the circle's centre from C to the point's place in the osculating plane.
  const double angle = std::atan2(curvature * tangential, 1.0 - Dot(to_point, bend, d));
  constexpr double kStraight = 1e-12;  // angle / curvature is tangential then
  const double arc = curvature * std::abs(tangential) > kStraight
                         ? angle / curvature
                         : tangential / (1.0 - Dot(to_point, bend, d));
  // Arc length is speed dt + along / speed dt^2 / 2 to second order.
  return arc / speed - along * arc * arc / (2.0 * squared_speed * squared_speed);
}

}  // namespace

CurveDistance MeasureDistance(const BezierStretch& stretch, const double* point, double t) {
  const int p = stretch.degree;
  const int d = stretch.dimension;
  const double length = stretch.high - stretch.low;
  const double u = (t - stretch.low) / length;
  // De Casteljau's levels; the last three hold C, C' and C''.
  double level[kMaxOrder * kMaxDimension];
  double values[3][kMaxDimension] = {};
  std::copy(stretch.points, stretch.points + (p + 1) * d, level);
  for (int r = p; r >= 0; --r) {
    for (int c = 0; c < d; ++c) {
      if (r == 2) values[2][c] = p * (p - 1) * (level[2 * d + c] - 2.0 * level[d + c] + level[c]);
      if (r == 1) values[1][c] = p * (level[d + c] - level[c]);
      if (r == 0) values[0][c] = level[c];
    }
    for (int k = 0; k < r * d; ++k) level[k] += u * (level[k + d] - level[k]);
  }
  CurveDistance at;
  at.t = t;
  double size = 0.0;
  double to_point[kMaxDimension];
  for (int c = 0; c < d; ++c) {
    values[1][c] /= length;
    values[2][c] /= length * length;
    to_point[c] = point[c] - values[0][c];
    size = std::max({size, std::abs(values[0][c]), std::abs(point[c])});
  }
  at.squared_distance = Dot(to_point, to_point, d);
  at.slope = -Dot(to_point, values[1], d);
  at.curvature = Dot(values[1], values[1], d) - Dot(to_point, values[2], d);
  // About p roundings of the size of the coordinates.
  const double off = (p + 4) * kEpsilon * size;
  at.rounding = off * (2.0 * std::sqrt(d * at.squared_distance) + d * off);
  at.circle_step = CircleStep(to_point, values[1], values[2], d);
  return at;
}

CurveDistance FindFoot(const BezierStretch& stretch, const double* point, double low, double start,
                       double high) {
  // Bisection alone needs 53 steps from any bracket to neighbouring doubles.
  constexpr int kMaxSteps = 100;
  const double tolerance = 2.0 * kEpsilon * std::max(std::abs(low), std::abs(high));
  bool low_is_tried = false;
  bool high_is_tried = false;
  const double begin = low;
  const double end = high;
  CurveDistance at = MeasureDistance(stretch, point, start);
  for (int step = 0; step < kMaxSteps && at.slope != 0.0; ++step) {
    (at.slope > 0.0 ? high : low) = at.t;
    (at.slope > 0.0 ? high_is_tried : low_is_tried) = true;
    double next = at.slope > 0.0 ? low : high;
    // A step that goes up, as from beyond the circle's centre, is none.
    const double by_circle = at.slope * at.circle_step < 0.0 ? at.circle_step : 0.0;
    const double by_newton = at.curvature > 0.0 ? -at.slope / at.curvature : 0.0;
    // Once steps are small both agree, and Newton's carries fewer roundings.
    constexpr double kSmall = 1e-6;
    const double by =
        std::abs(by_newton) > kSmall * (high - low) && by_circle != 0.0 ? by_circle : by_newton;
    if (by != 0.0) next = std::clamp(at.t + by, low, high);
    if ((next == low && low_is_tried) || (next == high && high_is_tried)) {
      next = low + 0.5 * (high - low);
    }
    if (!(std::abs(next - at.t) > tolerance)) break;
    const CurveDistance tried = MeasureDistance(stretch, point, next);
    if (tried.squared_distance <= at.squared_distance + at.rounding) {
      at = tried;
    } else {
      // A minimum lies on this side of `next`.
      (next < at.t ? low : high) = next;
      (next < at.t ? low_is_tried : high_is_tried) = true;
    }
  }
  at.is_foot = begin < at.t && at.t < end;
  return at;
}

}  // namespace batten
