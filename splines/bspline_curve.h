#ifndef BATTEN_SPLINES_BSPLINE_CURVE_H_
#define BATTEN_SPLINES_BSPLINE_CURVE_H_

#include "splines/bspline_basis.h"

namespace batten {

/// C(t) = sum_j P_j N_j(t) in R^d, d = 1..kMaxDimension.
class BsplineCurve {
 public:
  /// `control_points` is n x d; n must be basis.num_control_points(). Another size, or a negative
  /// derivative below, is our bug: std::logic_error.
  BsplineCurve(BsplineBasis basis, Points control_points);

  const BsplineBasis& basis() const { return basis_; }
  const Points& control_points() const { return control_points_; }
  int dimension() const { return static_cast<int>(control_points_.cols()); }

  /// C^(k)(t) into result[0..d-1]; t is wrapped (periodic) or clamped (open) to the domain.
  /// Zero for k > p. At a knot where C^(k) jumps: its value to the right (at domain_end: left).
  void Evaluate(double t, int derivative, double* result) const;
  /// C, C', ..., C^(max_derivative), result[k * d + c].
  void EvaluateUpTo(double t, int max_derivative, double* result) const;
  /// Evaluate(t, 0) for every t: one point a row.
  Points Sample(const Eigen::VectorXd& parameters) const;

 private:
  BsplineBasis basis_;
  Points control_points_;
};

}  // namespace batten

#endif  // BATTEN_SPLINES_BSPLINE_CURVE_H_
