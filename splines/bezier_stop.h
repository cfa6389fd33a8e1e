#ifndef BATTEN_SPLINES_BEZIER_STOP_H_
#define BATTEN_SPLINES_BEZIER_STOP_H_

#include <string>
#include <vector>

#include "splines/bezier.h"

namespace batten {

/// What must be small on a piece of a subdivided curve before its chord stands for it. Tolerances
/// are relative to L, the larger side of the original control points' box.
enum class StopMeasure {
  kControlPoints,  ///< Largest distance of an inner control point from the chord's line, / L.
  kPolygon,        ///< The same from the chord's segment: it bounds the true error, / L.
  kHullArea,       ///< Area of the hull of the control points, / L^2; planar curves.
  kFlatness,       ///< Sum of squared distances of inner control points from the line, / L^2.
  kSegment,        ///< Largest distance of the curve itself from the chord's segment, / L.
  kAngle,          ///< Largest angle of a leg of the control polygon with the chord, in radians,
                   ///< below pi / 2.
};

const char* ToString(StopMeasure measure);
bool FromString(const std::string& text, StopMeasure* measure);
const std::vector<std::string>& StopMeasureNames();

/// What a stop test found on a piece.
struct StopValue {
  double value = 0.0;
  double limit = 0.0;  ///< The piece passes if value <= limit.
  int power = 1;       ///< The value of short pieces goes with this power of their length.

  bool passes() const { return value <= limit; }
  /// The piece's length in units of the longest that would pass if the curve went on as it does
  /// here: (value / limit)^(1 / power).
  double RelativeLength() const;
};

/// A measure with its tolerance, for pieces of one curve. Tolerances below what rounding lets be
/// told apart are raised to that; a piece that is a point to rounding passes by any measure.
class StopTest {
 public:
  /// `size` is L; 0: the larger side of the control points' box of `curve`.
  StopTest(StopMeasure measure, double relative_tolerance, double size, const BezierCurve& curve);

  /// `points`: a piece's control points, of the curve's degree and dimension.
  bool Passes(const double* points) const;
  /// Passes() wherever it says so; of kSegment the value is at most 2 % too large.
  StopValue Value(const double* points) const;
  /// The tolerance is below rounding and was raised.
  bool is_raised() const { return is_raised_; }
  StopMeasure measure() const { return measure_; }
  int power() const;  ///< StopValue::power.
  /// Largest allowed value: in the curve's own units, squared where the measure is an area; the
  /// squared distance of kControlPoints and kPolygon; of kAngle the squared tangent.
  double limit() const { return limit_; }

 private:
  StopValue Measured(const double* points) const;
  bool IsPoint(const double* points) const;

  StopMeasure measure_;
  int degree_;
  int dimension_;
  double limit_ = 0.0;
  double rounding_ = 0.0;
  bool is_raised_ = false;
};

}  // namespace batten

#endif  // BATTEN_SPLINES_BEZIER_STOP_H_
