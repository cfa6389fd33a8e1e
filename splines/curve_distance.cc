#include "splines/curve_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace batten {
namespace {

constexpr double kUnitRoundoff = std::numeric_limits<double>::epsilon();

/// C, C' and C'' at t, and Q - C.
struct Jet {
  double to_point[kMaxDimension];
  double first[kMaxDimension];
  double second[kMaxDimension];
};

double Dot(const double* a, const double* b, int d) {
  double sum = 0.0;
  for (int c = 0; c < d; ++c) sum += a[c] * b[c];
  return sum;
}

/// Step in t to the foot point on the osculating circle, to second order in its arc length (Hu &
/// Wallner, 2005); NaN where the curve has no tangent.
double CircleStep(const Jet& jet, int d) {
  const double squared_speed = Dot(jet.first, jet.first, d);
  const double speed = std::sqrt(squared_speed);
  const double along = Dot(jet.first, jet.second, d);
  // Curvature vector k n, n the principal normal.
  double bend[kMaxDimension];
  for (int c = 0; c < d; ++c) {
    bend[c] = (jet.second[c] - along / squared_speed * jet.first[c]) / squared_speed;
  }
  const double tangential = Dot(jet.to_point, jet.first, d) / speed;
  const double curvature = std::sqrt(Dot(bend, bend, d));
  const double to_centre = 1.0 - Dot(jet.to_point, bend, d);
  // Angle at the circle's centre from C to the point's place in the osculating plane; where the
  // circle is a line, its tangent.
  constexpr double kStraight = 1e-12;
  const double arc = curvature * std::abs(tangential) > kStraight
                         ? std::atan2(curvature * tangential, to_centre) / curvature
                         : tangential / to_centre;
  // Arc length is speed dt + along / speed dt^2 / 2 to second order.
  return arc / speed - along * arc * arc / (2.0 * squared_speed * squared_speed);
}

/// P and D are -1 where they are known at run time only.
template <int P, int D>
CurveDistance Measure(const BezierStretch& stretch, const double* point, double t, Jet* jet) {
  constexpr int kSize = P >= 0 ? (P + 1) * D : kMaxOrder * kMaxDimension;
  const int p = P >= 0 ? P : stretch.degree;
  const int d = P >= 0 ? D : stretch.dimension;
  const double length = stretch.high - stretch.low;
  const double u = (t - stretch.low) / length;
  // De Casteljau's levels; the last three hold C, C' and C''.
  double level[kSize];
  std::copy(stretch.points, stretch.points + (p + 1) * d, level);
  for (int c = 0; c < d; ++c) jet->second[c] = 0.0;
  for (int r = p; r > 0; --r) {
    for (int c = 0; c < d; ++c) {
      if (r == 2) jet->second[c] = p * (p - 1) * (level[2 * d + c] - 2.0 * level[d + c] + level[c]);
      if (r == 1) jet->first[c] = p * (level[d + c] - level[c]);
    }
    for (int k = 0; k < r * d; ++k) level[k] += u * (level[k + d] - level[k]);
  }
  CurveDistance at;
  at.t = t;
  double size = 0.0;
  for (int c = 0; c < d; ++c) {
    jet->first[c] /= length;
    jet->second[c] /= length * length;
    jet->to_point[c] = point[c] - level[c];
    size = std::max({size, std::abs(level[c]), std::abs(point[c])});
  }
  at.squared_distance = Dot(jet->to_point, jet->to_point, d);
  at.slope = -Dot(jet->to_point, jet->first, d);
  at.curvature = Dot(jet->first, jet->first, d) - Dot(jet->to_point, jet->second, d);
  // About p roundings of the size of the coordinates.
  const double off = (p + 4) * kUnitRoundoff * size;
  at.rounding = off * (2.0 * std::sqrt(d * at.squared_distance) + d * off);
  return at;
}

CurveDistance Measure(const BezierStretch& stretch, const double* point, double t, Jet* jet) {
  if (stretch.degree == 3 && stretch.dimension == 2) return Measure<3, 2>(stretch, point, t, jet);
  if (stretch.degree == 3 && stretch.dimension == 3) return Measure<3, 3>(stretch, point, t, jet);
  return Measure<-1, -1>(stretch, point, t, jet);
}

}  // namespace

CurveDistance MeasureDistance(const BezierStretch& stretch, const double* point, double t) {
  Jet jet;
  return Measure(stretch, point, t, &jet);
}

CurveDistance FindFoot(const BezierStretch& stretch, const double* point, double low, double start,
                       double high) {
  // Bisection alone needs 53 steps from any bracket to neighbouring doubles.
  constexpr int kMaxSteps = 100;
  const double tolerance = 2.0 * kUnitRoundoff * std::max(std::abs(low), std::abs(high));
  bool low_is_tried = false;
  bool high_is_tried = false;
  const double begin = low;
  const double end = high;
  Jet jet;
  CurveDistance at = Measure(stretch, point, start, &jet);
  for (int step = 0; step < kMaxSteps && at.slope != 0.0; ++step) {
    (at.slope > 0.0 ? high : low) = at.t;
    (at.slope > 0.0 ? high_is_tried : low_is_tried) = true;
    double next = at.slope > 0.0 ? low : high;
    double by = at.curvature > 0.0 ? -at.slope / at.curvature : 0.0;
    // Once steps are small both agree, and Newton's carries fewer roundings.
    constexpr double kSmall = 1e-6;
    if (!(std::abs(by) <= kSmall * (high - low)) || by == 0.0) {
      const double by_circle = CircleStep(jet, stretch.dimension);
      // A step that goes up, as from beyond the circle's centre, is none.
      if (at.slope * by_circle < 0.0) by = by_circle;
    }
    if (by != 0.0) next = std::clamp(at.t + by, low, high);
    if ((next == low && low_is_tried) || (next == high && high_is_tried)) {
      next = low + 0.5 * (high - low);
    }
    if (!(std::abs(next - at.t) > tolerance)) break;
    Jet tried_jet;
    const CurveDistance tried = Measure(stretch, point, next, &tried_jet);
    if (tried.squared_distance <= at.squared_distance + at.rounding) {
      at = tried;
      jet = tried_jet;
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
