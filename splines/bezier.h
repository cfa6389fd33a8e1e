#ifndef BATTEN_SPLINES_BEZIER_H_
#define BATTEN_SPLINES_BEZIER_H_

#include <optional>
#include <string>

#include "splines/points.h"

namespace batten {

inline constexpr int kMaxBezierDegree = 60;
inline constexpr int kMaxBezierNumbers = (kMaxBezierDegree + 1) * kMaxDimension;

/// Puts `sentence` into `*error`, unless that is null; always false.
inline bool FailWith(const std::string& sentence, std::string* error) {
  if (error != nullptr) *error = sentence;
  return false;
}

/// Cuts the Bezier curve of n + 1 control points, d coordinates each, at the parameter t in [0, 1]
/// by de Casteljau's algorithm (Farin, Curves and Surfaces for CAGD, sec. 4.2): `first` receives
/// the control points of [0, t], `second` those of [t, 1]. Allocates nothing. `second` may be
/// `points`; other overlaps are not allowed. 0 <= n <= kMaxBezierDegree, 1 <= d <= kMaxDimension.
/// A step rounds three times, at t = 1/2 once. Differences of coordinates must not overflow.
void CutBezier(int degree, int dimension, double t, const double* points, double* first,
               double* second);

/// The point at t, d coordinates; the last point that de Casteljau's algorithm comes to.
void EvaluateBezier(int degree, int dimension, const double* points, double t, double* result);

/// C(t) = sum_i P_i B_i^n(t), 0 <= t <= 1, in the Bernstein basis of degree n.
class BezierCurve {
 public:
  /// Nothing, with one sentence in `error` (may be null), unless there are 1 to 61 control points
  /// of 1 to kMaxDimension coordinates, all finite.
  static std::optional<BezierCurve> Make(Points control_points, std::string* error);

  int degree() const { return static_cast<int>(control_points_.rows()) - 1; }
  int dimension() const { return static_cast<int>(control_points_.cols()); }
  const Points& control_points() const { return control_points_; }  // (n + 1) x d

  /// C(t), d coordinates; outside [0, 1] the same polynomial, less accurately.
  void Evaluate(double t, double* result) const;
  /// The curve of degree n - 1 that is C'; of degree 0: the zero curve.
  BezierCurve Derivative() const;
  /// The part [begin, end] as a curve over [0, 1]; 0 <= begin < end <= 1, else std::logic_error.
  BezierCurve Part(double begin, double end) const;
  /// The same curve by control points of degree n + `levels` (Farin, sec. 5.1); std::logic_error
  /// beyond kMaxBezierDegree.
  BezierCurve Raised(int levels) const;

 private:
  explicit BezierCurve(Points control_points) : control_points_(std::move(control_points)) {}

  Points control_points_;
};

}  // namespace batten

#endif  // BATTEN_SPLINES_BEZIER_H_
