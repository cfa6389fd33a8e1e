#include "splines/curve_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace batten {
namespace {

constexpr double kUnitRoundoff = std::numeric_limits<double>::epsilon();

/// C, C' and C'' at t, and Q - C.
template <int kStorage>
struct Jet {
  double to_point[kStorage];
  double first[kStorage];
  double second[kStorage];
};

double Dot(const double* a, const double* b, int d) {
  double sum = 0.0;
  for (int c = 0; c < d; ++c) sum += a[c] * b[c];
  return sum;
}

/// A stretch of degree P in dimension D and the point; -1: both are known at run time only.
template <int P, int D>
class Stretch {
 public:
  static constexpr int kDimensionStorage = D >= 0 ? D : kMaxDimension;
  using StretchJet = Jet<kDimensionStorage>;

  Stretch(const BezierStretch& stretch, const double* point)
      : points_(stretch.points),
        point_(point),
        degree_(stretch.degree),
        dimension_(stretch.dimension),
        low_(stretch.low),
        per_length_(1.0 / (stretch.high - stretch.low)) {}

  CurveDistance Measure(double t, StretchJet* jet) const {
    constexpr int kSize = (P >= 0 ? P + 1 : kMaxOrder) * kDimensionStorage;
    const int p = degree();
    const int d = dimension();
    const double u = (t - low_) * per_length_;
    // De Casteljau's levels; the last three hold C, C' and C''.
    double level[kSize];
    std::copy(points_, points_ + (p + 1) * d, level);
    for (int c = 0; c < d; ++c) jet->second[c] = 0.0;
    for (int r = p; r > 0; --r) {
      for (int c = 0; c < d; ++c) {
        const double* v = level + c;
        if (r == 2) jet->second[c] = p * (p - 1) * (v[2 * d] - 2.0 * v[d] + v[0]);
        if (r == 1) jet->first[c] = p * (v[d] - v[0]);
      }
      for (int k = 0; k < r * d; ++k) level[k] += u * (level[k + d] - level[k]);
    }
    CurveDistance at;
    at.t = t;
    double size = 0.0;
    for (int c = 0; c < d; ++c) {
      jet->first[c] *= per_length_;
      jet->second[c] *= per_length_ * per_length_;
      jet->to_point[c] = point_[c] - level[c];
      size = std::max({size, std::abs(level[c]), std::abs(point_[c])});
    }
    at.squared_distance = Dot(jet->to_point, jet->to_point, d);
    at.slope = -Dot(jet->to_point, jet->first, d);
    at.curvature = Dot(jet->first, jet->first, d) - Dot(jet->to_point, jet->second, d);
    // About p roundings of the size of the coordinates.
    const double off = (p + 5) * kUnitRoundoff * size;
    at.rounding = off * (2.0 * std::sqrt(d * at.squared_distance) + d * off);
    return at;
  }

  /// Step in t to the foot point on the osculating circle, to second order in its arc length (Hu &
  /// Wallner, 2005); NaN where the curve has no tangent.
  double CircleStep(const StretchJet& jet) const {
    const int d = dimension();
    const double squared_speed = Dot(jet.first, jet.first, d);
    const double speed = std::sqrt(squared_speed);
    const double along = Dot(jet.first, jet.second, d);
    // Curvature vector k n, n the principal normal.
    double bend[kDimensionStorage];
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

  CurveDistance FindFoot(double low, double start, double high) const;

 private:
  int degree() const { return P >= 0 ? P : degree_; }
  int dimension() const { return D >= 0 ? D : dimension_; }

  const double* points_;
  const double* point_;
  int degree_;
  int dimension_;
  double low_;
  double per_length_;
};

template <int P, int D>
CurveDistance Stretch<P, D>::FindFoot(double low, double start, double high) const {
  // Bisection alone needs 53 steps from any bracket to neighbouring doubles.
  constexpr int kMaxSteps = 100;
  // Short steps are Newton's, which cost a third of the circle's; a long one may pass a farther
  // place, and feet as near would take turns. After a step so short that the next would be below
  // rounding, none follows.
  constexpr double kShort = 0.1;
  constexpr double kLast = 1e-9;
  const double tolerance = 2.0 * kUnitRoundoff * std::max(std::abs(low), std::abs(high));
  const double begin = low;
  const double end = high;
  bool low_is_tried = false;
  bool high_is_tried = false;
  StretchJet jet, tried_jet;
  CurveDistance at = Measure(start, &jet);
  // Neither where the slope is no number.
  for (int step = 0; step < kMaxSteps && (at.slope < 0.0 || at.slope > 0.0); ++step) {
    (at.slope > 0.0 ? high : low) = at.t;
    (at.slope > 0.0 ? high_is_tried : low_is_tried) = true;
    double next = at.slope > 0.0 ? low : high;
    double by = at.curvature > 0.0 ? -at.slope / at.curvature : 0.0;
    const bool is_last = by != 0.0 && std::abs(by) <= kLast * (end - begin);
    if (!(std::abs(by) <= kShort * (end - begin)) || by == 0.0) {
      const double by_circle = CircleStep(jet);
      // A step that goes up, as from beyond the circle's centre, is none.
      if (at.slope * by_circle < 0.0) by = by_circle;
    }
    if (by != 0.0) next = std::clamp(at.t + by, low, high);
    if ((next == low && low_is_tried) || (next == high && high_is_tried)) {
      if (is_last) break;
      next = low + 0.5 * (high - low);
    }
    if (!(std::abs(next - at.t) > tolerance)) break;
    const CurveDistance tried = Measure(next, &tried_jet);
    if (tried.squared_distance <= at.squared_distance + at.rounding) {
      at = tried;
      jet = tried_jet;
      if (is_last) break;
    } else {
      // A minimum lies on this side of `next`.
      (next < at.t ? low : high) = next;
      (next < at.t ? low_is_tried : high_is_tried) = true;
    }
  }
  at.is_foot = begin < at.t && at.t < end;
  return at;
}

/// body(Stretch<P, D>) with the sizes that have loops of their own.
template <typename Body>
CurveDistance OnStretch(const BezierStretch& stretch, const double* point, const Body& body) {
  if (stretch.degree == 3 && stretch.dimension == 2) return body(Stretch<3, 2>(stretch, point));
  if (stretch.degree == 3 && stretch.dimension == 3) return body(Stretch<3, 3>(stretch, point));
  return body(Stretch<-1, -1>(stretch, point));
}

}  // namespace

CurveDistance MeasureDistance(const BezierStretch& stretch, const double* point, double t) {
  return OnStretch(stretch, point, [t](const auto& on) {
    typename std::decay_t<decltype(on)>::StretchJet jet;
    return on.Measure(t, &jet);
  });
}

CurveDistance FindFoot(const BezierStretch& stretch, const double* point, double low, double start,
                       double high) {
  return OnStretch(stretch, point, [=](const auto& on) { return on.FindFoot(low, start, high); });
}

}  // namespace batten
