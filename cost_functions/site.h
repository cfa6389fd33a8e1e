#ifndef BATTEN_COST_FUNCTIONS_SITE_H_
#define BATTEN_COST_FUNCTIONS_SITE_H_

#include "cost_functions/affine_form.h"
#include "splines/points.h"

namespace batten {

/// What a residual functor sees of its block: the curve near one parameter t, and the data there.
/// Real is a double, or a Pack of several sites at once. kDegree and kDimension are -1 where the
/// sizes are known at run time only. kDerivatives: highest derivative of C that is filled in.
template <typename Real, int kDegree, int kDimension, int kDerivatives>
class Site {
 public:
  static constexpr int kOrderStorage = kDegree >= 0 ? kDegree + 1 : kMaxOrder;
  static constexpr int kDimensionStorage = kDimension >= 0 ? kDimension : kMaxDimension;

  Site(int degree, int dimension) : degree_(degree), dimension_(dimension) {}

  int degree() const { return kDegree >= 0 ? kDegree : degree_; }
  int dimension() const { return kDimension >= 0 ? kDimension : dimension_; }
  const Real& point(int coordinate) const { return point_[coordinate]; }  ///< Q, scaled.
  const Real& root_weight() const { return root_weight_; }  ///< Root of the site's weight.

  /// Coordinate of C(t) = sum_j N_j(t) P_j; control_points[j] is P_j of the span, j = 0..degree().
  template <typename T>
  T Curve(const T* const* control_points, int coordinate) const {
    return Derivative(0, control_points, coordinate);
  }
  /// Coordinate of C^(k)(t), k = 0..kDerivatives.
  template <typename T>
  T Derivative(int k, const T* const* control_points, int coordinate) const {
    const Real* values = basis_ + k * (degree() + 1);
    T sum = values[0] * control_points[0][coordinate];
    for (int j = 1; j <= degree(); ++j) sum += values[j] * control_points[j][coordinate];
    return sum;
  }
  /// The same when rows are compiled: the span's own control points are the variables x_j then, and
  /// products with the zeros and ones of their forms would be most of the work.
  template <int kVariables>
  AffineForm<Real, kVariables> Derivative(int k,
                                          const AffineForm<Real, kVariables>* const* control_points,
                                          int coordinate) const {
    const Real* values = basis_ + k * (degree() + 1);
    if (control_points == variables_) {
      return AffineForm<Real, kVariables>::Combination(values, degree() + 1);
    }
    return CombinationOf(values, control_points, coordinate);
  }

  Real* mutable_basis() { return basis_; }
  Real* mutable_point() { return point_; }
  /// The pointers handed to the functor while rows are compiled, where x_j is control point j.
  void set_variables(const void* variables) { variables_ = variables; }
  void set_root_weight(const Real& root) { root_weight_ = root; }

 private:
  /// Kept out of line: the loop over sites is to stay small.
  template <int kVariables>
  __attribute__((noinline)) AffineForm<Real, kVariables> CombinationOf(
      const Real* values, const AffineForm<Real, kVariables>* const* control_points,
      int coordinate) const {
    AffineForm<Real, kVariables> sum = values[0] * control_points[0][coordinate];
    for (int j = 1; j <= degree(); ++j) sum += values[j] * control_points[j][coordinate];
    return sum;
  }

  int degree_;
  int dimension_;
  Real basis_[(kDerivatives + 1) * kOrderStorage];
  Real point_[kDimensionStorage];
  Real root_weight_;
  const void* variables_ = nullptr;
};

}  // namespace batten

#endif  // BATTEN_COST_FUNCTIONS_SITE_H_
