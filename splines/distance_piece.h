#ifndef BATTEN_SPLINES_DISTANCE_PIECE_H_
#define BATTEN_SPLINES_DISTANCE_PIECE_H_

#include "splines/points.h"

namespace batten {

/// A stretch [low, high] of one polynomial piece of a curve, less a point: Bezier points v_i,
/// i = 0..p, whose squared distance f(s) = |sum_i v_i B_i(s)|^2, s in [0, 1], is a polynomial of
/// degree 2 p. The Bernstein coefficients of f hold it in their hull: what they say of f holds on
/// the whole stretch (Farouki & Rajan, CAGD 4, 1987: products and bounds in Bernstein form).
class DistancePiece {
 public:
  enum class Shape {
    kRises,    ///< The least f is at low.
    kFalls,    ///< At high.
    kConvex,   ///< f has one minimum.
    kUnknown,  ///< To be split.
  };

  DistancePiece() = default;  ///< Nothing: to be split into.
  /// `points` are the p + 1 Bezier points of the stretch, d coordinates each, `rounding` what a
  /// coordinate of their difference from `point` may be off.
  DistancePiece(int degree, int dimension, const double* points, const double* point, double low,
                double high, double rounding);

  double low() const { return low_; }
  double high() const { return high_; }
  /// No f on the stretch is below it, rounding taken into account.
  double lower_bound() const { return lower_bound_; }
  Shape shape() const { return shape_; }
  /// Largest distance of two of the Bezier points, bounded.
  double diameter() const { return diameter_; }
  /// The two halves, by de Casteljau's algorithm.
  void Split(DistancePiece* left, DistancePiece* right) const;

 private:
  void Look();
  /// Sizes -1 are known at run time only.
  template <int P, int D>
  void LookAt();

  int degree_ = 0;
  int dimension_ = 0;
  double low_ = 0.0;
  double high_ = 0.0;
  double rounding_ = 0.0;
  double lower_bound_ = 0.0;
  double diameter_ = 0.0;
  Shape shape_ = Shape::kUnknown;
  double v_[kMaxOrder * kMaxDimension];
};

/// Bezier points of the stretch [low, high] of span `span`: the polynomial's blossom at p - i times
/// low and i times high. `window` holds the span's p + 1 control points, d coordinates each.
void BezierPoints(int degree, int dimension, const double* knots, int span, const double* window,
                  double low, double high, double* points);

}  // namespace batten

#endif  // BATTEN_SPLINES_DISTANCE_PIECE_H_
