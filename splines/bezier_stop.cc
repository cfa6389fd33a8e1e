#include "splines/bezier_stop.h"

#include <algorithm>
#include <cmath>

#include "splines/bezier_distance.h"
#include "splines/bezier_hull.h"
#include "splines/bezier_measures.h"

namespace batten {
namespace {

struct NamedMeasure {
  StopMeasure measure;
  const char* name;
};
constexpr NamedMeasure kNames[] = {
    {StopMeasure::kControlPoints, "control_points"},
    {StopMeasure::kPolygon, "polygon"},
    {StopMeasure::kHullArea, "hull_area"},
    {StopMeasure::kFlatness, "flatness"},
    {StopMeasure::kSegment, "segment"},
    {StopMeasure::kAngle, "angle"},
};

// A piece passes if the upper bound of its distance does: 2 % cost 1 % of its length.
constexpr double kSegmentAccuracy = 0.02;

constexpr int kSecond = 2, kThird = 3, kFourth = 4;

/// How the tolerance and rounding become the largest allowed value.
struct Limits {
  double wanted;
  double lowest;
};

Limits LimitsOf(StopMeasure measure, double tolerance, double side, double rounding, int degree) {
  switch (measure) {
    case StopMeasure::kControlPoints:
    case StopMeasure::kPolygon:
      return {tolerance * side * tolerance * side, rounding * rounding};
    case StopMeasure::kSegment:
      return {tolerance * side, rounding};
    case StopMeasure::kHullArea:
      return {tolerance * side * side, rounding * side};
    case StopMeasure::kFlatness:
      return {tolerance * side * side, degree * rounding * rounding};
    case StopMeasure::kAngle:
      break;
  }
  const double tangent = std::tan(tolerance);
  const double lowest = side > 0.0 ? rounding / side : 0.0;
  return {tangent * tangent, lowest * lowest};
}

}  // namespace

const char* ToString(StopMeasure measure) {
  for (const NamedMeasure& named : kNames) {
    if (named.measure == measure) return named.name;
  }
  return "";
}

bool FromString(const std::string& text, StopMeasure* measure) {
  for (const NamedMeasure& named : kNames) {
    if (text != named.name) continue;
    *measure = named.measure;
    return true;
  }
  return false;
}

const std::vector<std::string>& StopMeasureNames() {
  static const auto& names = *[] {
    auto* made = new std::vector<std::string>;
    for (const NamedMeasure& named : kNames) made->emplace_back(named.name);
    return made;
  }();
  return names;
}

StopTest::StopTest(StopMeasure measure, double relative_tolerance, double size,
                   const BezierCurve& curve)
    : measure_(measure), degree_(curve.degree()), dimension_(curve.dimension()) {
  const double* points = curve.control_points().data();
  const double side = size > 0.0 ? size : BoxSide(degree_, dimension_, points);
  rounding_ = BezierRounding(degree_, dimension_, points);
  const Limits limits = LimitsOf(measure, relative_tolerance, side, rounding_, degree_);
  is_raised_ = limits.wanted < limits.lowest;
  limit_ = std::max(limits.wanted, limits.lowest);
}

bool StopTest::IsPoint(const double* points) const {
  // Nearly all pieces that fail are seen to be longer by their ends.
  const double* last = points + degree_ * dimension_;
  for (int c = 0; c < dimension_; ++c) {
    if (std::abs(last[c] - points[c]) > rounding_) return false;
  }
  return BoxSide(degree_, dimension_, points) <= rounding_;
}

StopValue StopTest::Measured(const double* points) const {
  switch (measure_) {
    case StopMeasure::kControlPoints: {
      const Quotient squared = SquaredChordDistance(degree_, dimension_, points);
      return {squared.numerator, limit_ * squared.denominator, power()};
    }
    case StopMeasure::kPolygon: {
      const Quotient squared = SquaredPolygonDistance(degree_, dimension_, points);
      return {squared.numerator, limit_ * squared.denominator, power()};
    }
    case StopMeasure::kFlatness: {
      const Quotient sum = Flatness(degree_, dimension_, points);
      return {sum.numerator, limit_ * sum.denominator, power()};
    }
    case StopMeasure::kHullArea:
      return {HullArea(degree_, points), limit_, power()};
    case StopMeasure::kSegment: {
      const double* last = points + degree_ * dimension_;
      const DistanceBounds bounds =
          BoundSegmentDistance(degree_, dimension_, points, points, last, kSegmentAccuracy, 0.0);
      return {bounds.upper, limit_, power()};
    }
    case StopMeasure::kAngle:
      break;
  }
  return {SquaredLegSlope(degree_, dimension_, points, rounding_), limit_, power()};
}

int StopTest::power() const {
  switch (measure_) {
    case StopMeasure::kControlPoints:
    case StopMeasure::kPolygon:
    case StopMeasure::kFlatness:
      return kFourth;
    case StopMeasure::kHullArea:
      return kThird;
    case StopMeasure::kSegment:
    case StopMeasure::kAngle:
      break;
  }
  return kSecond;
}

bool StopTest::Passes(const double* points) const {
  if (measure_ == StopMeasure::kControlPoints) {
    return IsNearChord(degree_, dimension_, points, limit_) || IsPoint(points);
  }
  if (measure_ == StopMeasure::kPolygon) {
    return IsNearSegment(degree_, dimension_, points, limit_) || IsPoint(points);
  }
  return Value(points).passes();
}

StopValue StopTest::Value(const double* points) const {
  StopValue found = Measured(points);
  if (!found.passes() && IsPoint(points)) found.value = found.limit;
  return found;
}

double StopValue::RelativeLength() const {
  if (value == 0.0) return 0.0;
  const double ratio = value / limit;
  switch (power) {
    case kSecond:
      return std::sqrt(ratio);
    case kThird:
      return std::cbrt(ratio);
    default:
      return std::sqrt(std::sqrt(ratio));
  }
}

}  // namespace batten
