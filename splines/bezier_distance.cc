#include "splines/bezier_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "splines/bezier_measures.h"

namespace batten {
namespace {

constexpr int kMostHalvings = 40;

/// Halves a curve depth first; what waits are the second halves, at most one per depth.
class SegmentSearch {
 public:
  SegmentSearch(int degree, int dimension, const double* a, const double* b)
      : n_(degree), d_(dimension), a_(a), b_(b) {}

  DistanceBounds Bound(const double* points, double factor, double ignored) {
    squared_factor_ = factor * factor;
    lower_ = 0.0;
    upper_ = 0.0;
    squared_ignored_ = ignored * ignored;
    Visit(points, 0, 0.0, 1.0);
    return {std::sqrt(lower_), std::sqrt(std::max(lower_, upper_)), t_};
  }

 private:
  double SquaredDistance(const double* point) const {
    return SquaredSegmentDistance(d_, point, a_, b_);
  }

  void Meet(const double* point, double t) {
    const double distance = SquaredDistance(point);
    if (distance <= lower_) return;
    lower_ = distance;
    t_ = t;
  }

  void Visit(const double* points, int depth, double begin, double end) {
    Meet(points, begin);
    Meet(points + n_ * d_, end);
    double farthest = 0.0;
    for (int i = 0; i <= n_; ++i) {
      farthest = std::max(farthest, SquaredDistance(points + i * d_));
    }
    if (farthest <= std::max(squared_factor_ * lower_, squared_ignored_) ||
        depth == kMostHalvings) {
      upper_ = std::max(upper_, farthest);
      return;
    }
    std::array<double, kMaxBezierNumbers> first, second;
    constexpr double kHalf = 0.5;
    CutBezier(n_, d_, kHalf, points, first.data(), second.data());
    const double middle = begin + kHalf * (end - begin);
    Visit(first.data(), depth + 1, begin, middle);
    Visit(second.data(), depth + 1, middle, end);
  }

  const int n_;
  const int d_;
  const double* const a_;
  const double* const b_;
  double squared_factor_ = 1.0;
  double squared_ignored_ = 0.0;
  double lower_ = 0.0;  // squared, as is upper_
  double upper_ = 0.0;
  double t_ = 0.0;
};

double DistanceFromPolyline(const double* point, const Points& vertices) {
  const auto d = static_cast<int>(vertices.cols());
  double nearest = std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 0; i + 1 < vertices.rows(); ++i) {
    const double* a = vertices.data() + i * d;
    nearest = std::min(nearest, SquaredSegmentDistance(d, point, a, a + d));
  }
  return std::sqrt(nearest);
}

void CheckPolyline(const BezierCurve& curve, const Eigen::VectorXd& parameters,
                   const Points& vertices) {
  const Eigen::Index k = parameters.size();
  if (k < 2 || vertices.rows() != k || vertices.cols() != curve.dimension()) {
    throw std::logic_error("a polyline needs a vertex for each of two parameters or more");
  }
  bool increases = parameters[0] == 0.0 && parameters[k - 1] == 1.0;
  for (Eigen::Index i = 0; i + 1 < k; ++i) increases &= parameters[i] < parameters[i + 1];
  if (!increases) throw std::logic_error("parameters must increase from 0 to 1");
}

DistanceBounds BoundScaled(const BezierCurve& curve, const Eigen::VectorXd& parameters,
                           const Points& vertices) {
  constexpr double kAccuracy = 1e-3;
  const int d = curve.dimension();
  DistanceBounds bounds;
  double own = 0.0;  // the largest distance from an own segment that was met
  for (Eigen::Index i = 0; i + 1 < parameters.size(); ++i) {
    const double begin = parameters[i], length = parameters[i + 1] - parameters[i];
    const BezierCurve part = curve.Part(begin, parameters[i + 1]);
    const double* a = vertices.data() + i * d;
    const DistanceBounds here =
        BoundSegmentDistance(curve.degree(), d, part.control_points().data(), a, a + d, kAccuracy,
                             std::max(own, bounds.upper));
    bounds.upper = std::max(bounds.upper, here.upper);
    if (here.lower <= own) continue;
    own = here.lower;
    bounds.t = begin + here.t * length;
  }
  std::array<double, kMaxDimension> point;
  curve.Evaluate(bounds.t, point.data());
  const double rounding = std::sqrt(static_cast<double>(d)) *
                          BezierRounding(curve.degree(), d, curve.control_points().data());
  bounds.upper += rounding;
  bounds.lower = std::max(0.0, DistanceFromPolyline(point.data(), vertices) - rounding);
  return bounds;
}

}  // namespace

double BezierRounding(int degree, int dimension, const double* points) {
  double largest = 0.0;
  for (int k = 0; k < (degree + 1) * dimension; ++k) {
    largest = std::max(largest, std::abs(points[k]));
  }
  // Three roundings per level and cut; sums of convex combinations do not add up over the cuts.
  constexpr double kRoundings = 4.0;
  return kRoundings * (degree + 1) * std::numeric_limits<double>::epsilon() * largest;
}

DistanceBounds BoundSegmentDistance(int degree, int dimension, const double* points,
                                    const double* a, const double* b, double accuracy,
                                    double ignored) {
  return SegmentSearch(degree, dimension, a, b).Bound(points, 1.0 + accuracy, ignored);
}

DistanceBounds BoundHausdorffDistance(const BezierCurve& curve, const Eigen::VectorXd& parameters,
                                      const Points& vertices) {
  CheckPolyline(curve, parameters, vertices);
  const double unit = UnitOf(curve.control_points());
  const BezierCurve scaled = *BezierCurve::Make(curve.control_points() / unit, nullptr);
  DistanceBounds bounds = BoundScaled(scaled, parameters, vertices / unit);
  bounds.lower *= unit;
  bounds.upper *= unit;
  return bounds;
}

}  // namespace batten
