#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <thread>

#include "problems/fit_problem.h"
#include "splines/closest_point.h"
#include "splines/dense_eigenvalues.h"

namespace batten {
namespace {

constexpr const char* kCircle = "circle";
constexpr const char* kEllipse = "ellipse";

/// Control points whose curve winds once around the data's mean in the plane of their two widest
/// principal axes; half-axes are sqrt(2) deviations, as a circle's own points spread.
Points AroundTheData(const BsplineBasis& basis, const Points& data, bool circle) {
  const auto d = data.cols();
  const Eigen::RowVectorXd mean = data.colwise().mean();
  const Points centred = data.rowwise() - mean;
  const Eigen::MatrixXd covariance =
      centred.transpose() * centred / static_cast<double>(data.rows());
  const SymmetricEigen axes = DecomposeSymmetric(covariance);
  const double wide = std::sqrt(2.0 * std::max(axes.values[d - 1], 0.0));
  const double narrow = std::sqrt(2.0 * std::max(axes.values[d - 2], 0.0));
  const double mid = std::sqrt(0.5 * (wide * wide + narrow * narrow));
  const int n = basis.num_control_points();
  Points unit(n, 2);
  for (int j = 0; j < n; ++j) {
    const double a =
        2.0 * M_PI * (basis.Greville(j) - basis.domain_begin()) / basis.domain_length();
    unit.row(j) << std::cos(a), std::sin(a);
  }
  // A curve runs inside its control polygon: enlarged to the radius 1 in the mean.
  constexpr int kSamples = 256;
  const Eigen::VectorXd t =
      Eigen::VectorXd::LinSpaced(kSamples, basis.domain_begin(), basis.domain_end());
  const double radius = BsplineCurve(basis, unit).Sample(t).rowwise().norm().mean();
  // Too few control points to go around make a point of the curve.
  constexpr double kSmallest = 1e-3;
  if (radius > kSmallest) unit /= radius;
  Points start(n, d);
  for (int j = 0; j < n; ++j) {
    start.row(j) = mean + unit(j, 0) * (circle ? mid : wide) * axes.vectors.col(d - 1).transpose() +
                   unit(j, 1) * (circle ? mid : narrow) * axes.vectors.col(d - 2).transpose();
  }
  return start;
}

constexpr char kNoFeet[] =
    "the start is a single point, to which every parameter leads, so that no foot says where the "
    "curve is to go; projected parameters need a curve to start from: data, circle or ellipse";

/// Whether a start has all control points at one place, to rounding, and the data are elsewhere.
bool IsOnePlace(const Points& start, const Points& data) {
  constexpr double kRounding = 1e-14;
  const auto size = [](const Points& points) {
    return (points.colwise().maxCoeff() - points.colwise().minCoeff()).maxCoeff();
  };
  const double of_data = size(data);
  return start.rows() > 1 && of_data > 0.0 &&
         size(start) <= kRounding * (of_data + data.cwiseAbs().maxCoeff());
}

}  // namespace

bool CurveFit::CheckStart(std::string* error) const {
  if (spec_.start_points.size() > 0) {
    const int n = basis_->num_control_points();
    if (spec_.start_points.rows() == n && spec_.start_points.cols() == dimension() &&
        (spec_.start_points.array().abs() <= kLargestNumber).all()) {
      if (!is_projected() || !IsOnePlace(spec_.start_points, data_.points)) return true;
      *error = kNoFeet;
      return false;
    }
    *error = "the start has " + std::to_string(spec_.start_points.rows()) +
             " control points of dimension " + std::to_string(spec_.start_points.cols()) +
             "; allowed: " + std::to_string(n) + " finite ones of dimension " +
             std::to_string(dimension()) + ", of coordinates from -1e150 to 1e150";
    return false;
  }
  const bool is_round = spec_.start == kCircle || spec_.start == kEllipse;
  if (!is_round && spec_.start != "data" && spec_.start != "centroid") {
    *error = "start is " + spec_.start + "; allowed: data, centroid, circle, ellipse";
    return false;
  }
  if (is_round && dimension() < 2) {
    *error = "start is " + spec_.start + ", which needs points of dimension 2 or more";
    return false;
  }
  if (is_projected() && spec_.start == "centroid" && IsOnePlace(StartPoints(), data_.points)) {
    *error = kNoFeet;
    return false;
  }
  return true;
}

Points CurveFit::StartPoints() const {
  if (spec_.start_points.size() > 0) return spec_.start_points;
  if (spec_.start == "data") return StartOnPolyline();
  if (spec_.start == "centroid") {
    Points start(basis_->num_control_points(), dimension());
    start.rowwise() = data_.points.colwise().mean();
    return start;
  }
  return AroundTheData(*basis_, data_.points, spec_.start == kCircle);
}

void CurveFit::StartParameters(const Points& start) {
  if (spec_.start_points.size() == 0 && (spec_.start == "data" || spec_.start == "centroid"))
    return;
  const BsplineCurve curve(*basis_, start);
  const int threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  ClosestPoint(curve).FindAll(data_.points, threads, &parameters_, nullptr);
  sorted_ = IsNondecreasing(parameters_.data(), parameters_.size());
}

/// Each control point starts on the polyline through the data in the order of their parameters, at
/// the Greville abscissa of its basis function.
Points CurveFit::StartOnPolyline() const {
  const int n = basis_->num_control_points();
  Points start(n, dimension());
  const auto m = static_cast<int>(parameters_.size());
  // Empty while the data already are in the order of their parameters, as they mostly are.
  std::vector<int> order;
  Eigen::VectorXd reordered;
  if (!sorted_) {
    order.resize(static_cast<std::size_t>(m));
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [this](int a, int b) { return parameters_[a] < parameters_[b]; });
    reordered.resize(m);
    for (int k = 0; k < m; ++k) reordered[k] = parameters_[order[static_cast<std::size_t>(k)]];
  }
  const Eigen::VectorXd& sorted = order.empty() ? parameters_ : reordered;
  const auto item = [&order](int k) {
    return order.empty() ? k : order[static_cast<std::size_t>(k)];
  };
  // Abscissae mostly grow from one control point to the next, by about as much as before.
  std::ptrdiff_t near = 0;
  std::ptrdiff_t last_step = 0;
  const std::ptrdiff_t ahead = std::ptrdiff_t(8) * m / n;
  const auto first_above = [&](double t) {
    if (sorted[near] > t) near = 0;
    const double above = std::nextafter(t, std::numeric_limits<double>::infinity());
    const std::ptrdiff_t found = FirstNotBelow(sorted.data(), near, m, above, near + last_step);
    last_step = found - near;
    near = std::min<std::ptrdiff_t>(found, m - 1);
    // What comes a few control points later is probably there.
    __builtin_prefetch(sorted.data() + near + ahead);
    __builtin_prefetch(data_.points.data() + (near + ahead) * dimension());
    return static_cast<int>(found);
  };
  const double period = basis_->domain_length();
  for (int j = 0; j < n; ++j) {
    const double t = basis_->Greville(j);
    const int next = first_above(t);
    int left = next - 1;
    int right = next;
    double shift_left = 0.0;
    double shift_right = 0.0;
    if (spec_.closed) {
      if (left < 0) left = m - 1, shift_left = -period;
      if (right == m) right = 0, shift_right = period;
    } else {
      left = std::max(left, 0);
      right = std::min(right, m - 1);
    }
    const int a = item(left);
    const int b = item(right);
    const double begin = parameters_[a] + shift_left;
    const double length = parameters_[b] + shift_right - begin;
    const double part = length > 0.0 ? (t - begin) / length : 0.0;
    start.row(j) = data_.points.row(a);
    // Exactly the data point where the abscissa hits its parameter.
    if (part > 0.0) start.row(j) += part * (data_.points.row(b) - data_.points.row(a));
  }
  return start;
}

}  // namespace batten
