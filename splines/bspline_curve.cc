#include "splines/bspline_curve.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "splines/basis_functions.h"

namespace batten {
namespace {

void Combine(const BsplineBasis& basis, const Points& control_points, int span,
             const double* values, double* result) {
  const int d = static_cast<int>(control_points.cols());
  std::fill(result, result + d, 0.0);
  for (int j = 0; j <= basis.degree(); ++j) {
    const int index = basis.ControlPointIndex(span - basis.degree() + j);
    const double* point = control_points.data() + static_cast<Eigen::Index>(index) * d;
    for (int c = 0; c < d; ++c) result[c] += values[j] * point[c];
  }
}

void RefuseNegative(int derivative) {
  if (derivative >= 0) return;
  throw std::logic_error("derivative is " + std::to_string(derivative) + ", must be >= 0");
}

}  // namespace

BsplineCurve::BsplineCurve(BsplineBasis basis, Points control_points)
    : basis_(std::move(basis)), control_points_(std::move(control_points)) {
  if (control_points_.rows() != basis_.num_control_points() || control_points_.cols() < 1 ||
      control_points_.cols() > kMaxDimension) {
    throw std::logic_error("control points are " + std::to_string(control_points_.rows()) + " x " +
                           std::to_string(control_points_.cols()) + ", must be " +
                           std::to_string(basis_.num_control_points()) + " x 1 to " +
                           std::to_string(kMaxDimension));
  }
}

void BsplineCurve::Evaluate(double t, int derivative, double* result) const {
  RefuseNegative(derivative);
  const int p = basis_.degree();
  if (derivative > p) {
    std::fill(result, result + dimension(), 0.0);
    return;
  }
  t = basis_.Wrap(t);
  const int span = basis_.FindSpan(t);
  double values[kMaxOrder * kMaxOrder];
  EvaluateBasisDerivatives(p, basis_.knots().data(), span, t, derivative, values);
  Combine(basis_, control_points_, span, values + derivative * (p + 1), result);
}

void BsplineCurve::EvaluateUpTo(double t, int max_derivative, double* result) const {
  RefuseNegative(max_derivative);
  const int p = basis_.degree();
  const int d = dimension();
  t = basis_.Wrap(t);
  const int span = basis_.FindSpan(t);
  const int highest = std::min(max_derivative, p);
  double values[kMaxOrder * kMaxOrder];
  EvaluateBasisDerivatives(p, basis_.knots().data(), span, t, highest, values);
  for (int k = 0; k <= highest; ++k) {
    Combine(basis_, control_points_, span, values + k * (p + 1), result + k * d);
  }
  std::fill(result + (highest + 1) * d, result + (max_derivative + 1) * d, 0.0);
}

Points BsplineCurve::Sample(const Eigen::VectorXd& parameters) const {
  Points points(parameters.size(), dimension());
  for (Eigen::Index i = 0; i < parameters.size(); ++i) {
    Evaluate(parameters[i], 0, points.data() + i * dimension());
  }
  return points;
}

}  // namespace batten
