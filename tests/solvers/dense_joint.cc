#include "tests/solvers/dense_joint.h"

#include <glog/logging.h>

#include <Eigen/Dense>
#include <algorithm>
#include <limits>

#include "problems/fit_problem.h"
#include "splines/bspline_curve.h"

namespace batten {

namespace {

double SquaredSpeed(const BsplineCurve& curve, double t) {
  double derivative[kMaxDimension];
  curve.Evaluate(t, 1, derivative);
  return Eigen::Map<const Eigen::VectorXd>(derivative, curve.dimension()).squaredNorm();
}

/// A thousandth of the mean in the middles of the spans.
double LeastSquaredSpeed(const BsplineCurve& curve) {
  const BsplineBasis& basis = curve.basis();
  double sum = 0.0;
  for (int s = 0; s < basis.num_domain_spans(); ++s) {
    const auto k = static_cast<std::size_t>(basis.first_span() + s);
    sum += SquaredSpeed(curve, 0.5 * (basis.knots()[k] + basis.knots()[k + 1]));
  }
  return 1e-3 * sum / basis.num_domain_spans();
}

}  // namespace

DenseJoint::DenseJoint(const Problem& problem, const Eigen::VectorXd& x) : free_(x.size()) {
  const CurveFit& fit = *problem.curve_fit();
  const BsplineBasis& basis = fit.basis();
  points_ = static_cast<Eigen::Index>(basis.num_control_points()) * fit.dimension();
  Objective objective(&problem, nullptr, {false});
  Eigen::VectorXd residuals;
  SparseRows sparse;
  CHECK(objective.Jacobian(x, &residuals, &sparse) == Status::kOk);
  const Eigen::MatrixXd jacobian = sparse;
  const Eigen::VectorXd gradient = jacobian.transpose() * residuals;
  std::vector<Eigen::Index> kept;
  for (Eigen::Index k = 0; k < points_; ++k) kept.push_back(k);
  for (Eigen::Index k = points_; k < free_; ++k) {
    if (jacobian.col(k).isZero(0.0)) continue;
    const bool at_begin = !basis.periodic() && x[k] == basis.domain_begin();
    const bool at_end = !basis.periodic() && x[k] == basis.domain_end();
    if ((at_begin && gradient[k] > 0.0) || (at_end && gradient[k] < 0.0)) {
      ++num_pressed_;
      continue;
    }
    if (at_begin || at_end) ++num_leaving_;
    kept.push_back(k);
    moving_.push_back(k);
  }
  const auto size = static_cast<Eigen::Index>(kept.size());
  Eigen::MatrixXd columns(jacobian.rows(), size);
  newton_.resize(size, size);
  gradient_.resize(size);
  for (Eigen::Index a = 0; a < size; ++a) {
    const Eigen::Index place = kept[static_cast<std::size_t>(a)];
    columns.col(a) = jacobian.col(place);
    gradient_[a] = gradient[place];
    Eigen::VectorXd product;
    CHECK(objective.HessianTimes(x, Eigen::VectorXd::Unit(free_, place), &product) == Status::kOk);
    for (Eigen::Index b = 0; b < size; ++b) {
      newton_(b, a) = 0.5 * product[kept[static_cast<std::size_t>(b)]];
    }
  }
  gauss_newton_ = columns.transpose() * columns;
  const BsplineCurve curve(basis, fit.ControlPoints(objective.Expand(x)));
  slow_.resize(static_cast<Eigen::Index>(moving_.size()));
  for (Eigen::Index k = 0; k < slow_.size(); ++k) {
    const double speed = SquaredSpeed(curve, x[moving_[static_cast<std::size_t>(k)]]);
    slow_[k] = std::max(1.0, LeastSquaredSpeed(curve) / speed);
  }
}

double DenseJoint::Denominator(FootModelKind kind, double damping, Eigen::Index k) const {
  const double speed = gauss_newton_(k, k);  // times w
  switch (kind) {
    case FootModelKind::kPoint:
      return std::numeric_limits<double>::infinity();
    case FootModelKind::kTangent:
      return speed + damping * slow_[k - points_] * speed;
    case FootModelKind::kCurvature:
      return std::max(speed, newton_(k, k));
    case FootModelKind::kNewton:
      return newton_(k, k) + damping * slow_[k - points_] * speed;
  }
  return 0.0;
}

DenseJoint::Reduced DenseJoint::Reduce(FootModelKind kind, double damping) const {
  const Eigen::MatrixXd& h = HalfHessian(kind);
  Reduced reduced = {h.topLeftCorner(points_, points_), gradient_.head(points_)};
  for (Eigen::Index k = points_; k < h.rows(); ++k) {
    const double a = 1.0 / Denominator(kind, damping, k);
    const Eigen::VectorXd border = h.col(k).head(points_);
    reduced.half_hessian -= a * border * border.transpose();
    reduced.half_gradient -= a * gradient_[k] * border;
  }
  return reduced;
}

Eigen::VectorXd DenseJoint::Step(FootModelKind kind, double damping) const {
  Eigen::MatrixXd h = HalfHessian(kind);
  Eigen::VectorXd added = gauss_newton_.diagonal();
  added.head(points_) = added.head(points_).cwiseMax(1e-3 * added.head(points_).mean());
  added.tail(slow_.size()).array() *= slow_.array();
  h.diagonal() += damping * added;
  const Eigen::VectorXd solution = h.ldlt().solve(-gradient_);
  Eigen::VectorXd step = Eigen::VectorXd::Zero(free_);
  step.head(points_) = solution.head(points_);
  for (std::size_t k = 0; k < moving_.size(); ++k) {
    step[moving_[k]] = solution[points_ + static_cast<Eigen::Index>(k)];
  }
  return step;
}

double DenseJoint::Fall(FootModelKind kind, const Eigen::VectorXd& step) const {
  Eigen::VectorXd part(gradient_.size());
  part.head(points_) = step.head(points_);
  for (std::size_t k = 0; k < moving_.size(); ++k) {
    part[points_ + static_cast<Eigen::Index>(k)] = step[moving_[k]];
  }
  return -2.0 * gradient_.dot(part) - part.dot(HalfHessian(kind) * part);
}

double DenseJoint::least_curvature() const {
  double least = std::numeric_limits<double>::infinity();
  for (Eigen::Index k = points_; k < newton_.rows(); ++k) {
    least = std::min(least, newton_(k, k) / gauss_newton_(k, k));
  }
  return least;
}

}  // namespace batten
