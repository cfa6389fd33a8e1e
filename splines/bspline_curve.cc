#include "splines/bspline_curve.h"

#include <glog/logging.h>

#include <algorithm>
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

}  // namespace

BsplineCurve::BsplineCurve(BsplineBasis basis, Points control_points)
    : basis_(std::move(basis)), control_points_(std::move(control_points)) {
  CHECK_EQ(control_points_.rows(), basis_.num_control_points());
  CHECK_GE(control_points_.cols(), 1);
  CHECK_LE(control_points_.cols(), kMaxDimension);
}

void BsplineCurve::Evaluate(double t, int derivative, double* result) const {
  CHECK_GE(derivative, 0);
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
  CHECK_GE(max_derivative, 0);
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
