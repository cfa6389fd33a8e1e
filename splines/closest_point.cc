#include "splines/closest_point.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace batten {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr int kSamplesPerRun = 8;

/// Half the squared distance's derivatives at t: f = |C - Q|^2, slope = f' / 2, curvature = f''
/// / 2.
struct DistanceAt {
  double t = 0.0;
  double squared_distance = 0.0;
  double slope = 0.0;
  double curvature = 0.0;
  double rounding = 0.0;  // differences of squared_distance below this mean nothing
};

DistanceAt Measure(const BsplineCurve& curve, const double* point, double t) {
  const int d = curve.dimension();
  double values[3 * kMaxDimension];
  curve.EvaluateUpTo(t, 2, values);
  DistanceAt at;
  at.t = t;
  double size = 0.0;
  for (int c = 0; c < d; ++c) {
    const double difference = values[c] - point[c];
    at.squared_distance += difference * difference;
    at.slope += difference * values[d + c];
    at.curvature += values[d + c] * values[d + c] + difference * values[2 * d + c];
    size = std::max({size, std::abs(values[c]), std::abs(point[c])});
  }
  // About p roundings of the size of the coordinates in each difference.
  const double coordinate_rounding = (curve.basis().degree() + 4) * kEpsilon * size;
  at.rounding =
      coordinate_rounding * (2.0 * std::sqrt(d * at.squared_distance) + d * coordinate_rounding);
  return at;
}

double SquaredDistanceBetween(const double* a, const double* b, int dimension) {
  double sum = 0.0;
  for (int c = 0; c < dimension; ++c) sum += (a[c] - b[c]) * (a[c] - b[c]);
  return sum;
}

template <typename Box>
double SquaredDistanceToBox(const Box& box, const double* point, int dimension) {
  double sum = 0.0;
  for (int c = 0; c < dimension; ++c) {
    const double outside = std::max({box.low[c] - point[c], point[c] - box.high[c], 0.0});
    sum += outside * outside;
  }
  return sum;
}

}  // namespace

ClosestPoint::ClosestPoint(const BsplineCurve& curve) : curve_(curve) {
  const BsplineBasis& basis = curve.basis();
  const std::vector<double>& knots = basis.knots();
  const int per_span = 8 * basis.degree();
  for (int k = basis.first_span(); k <= basis.last_span(); ++k) {
    if (!(knots[k] < knots[k + 1])) continue;
    const double step = (knots[k + 1] - knots[k]) / per_span;
    for (int i = 0; i < per_span; ++i) sample_parameters_.push_back(knots[k] + i * step);
  }
  if (!basis.periodic()) sample_parameters_.push_back(basis.domain_end());
  samples_ = curve.Sample(Eigen::Map<const Eigen::VectorXd>(
      sample_parameters_.data(), static_cast<Eigen::Index>(sample_parameters_.size())));

  const int d = curve.dimension();
  const int num_samples = static_cast<int>(sample_parameters_.size());
  std::vector<Box> boxes((num_samples + kSamplesPerRun - 1) / kSamplesPerRun);
  for (int b = 0; b < static_cast<int>(boxes.size()); ++b) {
    const int first = b * kSamplesPerRun;
    const auto run = samples_.middleRows(first, std::min(kSamplesPerRun, num_samples - first));
    for (int c = 0; c < d; ++c) {
      boxes[b].low[c] = run.col(c).minCoeff();
      boxes[b].high[c] = run.col(c).maxCoeff();
    }
  }
  levels_.push_back(std::move(boxes));
  while (levels_.back().size() > 1) {
    const std::vector<Box>& lower = levels_.back();
    std::vector<Box> upper((lower.size() + 1) / 2);
    for (std::size_t b = 0; b < upper.size(); ++b) {
      const Box& left = lower[2 * b];
      const Box& right = lower[std::min(2 * b + 1, lower.size() - 1)];
      for (int c = 0; c < d; ++c) {
        upper[b].low[c] = std::min(left.low[c], right.low[c]);
        upper[b].high[c] = std::max(left.high[c], right.high[c]);
      }
    }
    levels_.push_back(std::move(upper));
  }
}

int ClosestPoint::NearestSample(const double* point) const {
  struct Visit {
    int level;
    int index;
    double bound;
  };
  const int d = curve_.dimension();
  const int num_samples = static_cast<int>(samples_.rows());
  int nearest = 0;
  double smallest = std::numeric_limits<double>::infinity();
  // Each level leaves at most one sibling waiting, and int indices allow no more than 32 levels.
  std::array<Visit, 64> waiting;
  int num_waiting = 0;
  waiting[num_waiting++] = {static_cast<int>(levels_.size()) - 1, 0, 0.0};
  while (num_waiting > 0) {
    const Visit visit = waiting[--num_waiting];
    if (visit.bound >= smallest) continue;
    if (visit.level == 0) {
      const int first = visit.index * kSamplesPerRun;
      for (int i = first; i < std::min(first + kSamplesPerRun, num_samples); ++i) {
        const double distance = SquaredDistanceBetween(&samples_(i, 0), point, d);
        if (distance < smallest) {
          smallest = distance;
          nearest = i;
        }
      }
      continue;
    }
    const std::vector<Box>& boxes = levels_[visit.level - 1];
    const auto child = [&](int index) {
      return Visit{visit.level - 1, index, SquaredDistanceToBox(boxes[index], point, d)};
    };
    Visit near = child(2 * visit.index);
    if (2 * visit.index + 1 < static_cast<int>(boxes.size())) {
      Visit far = child(2 * visit.index + 1);
      if (far.bound < near.bound) std::swap(near, far);
      waiting[num_waiting++] = far;
    }
    waiting[num_waiting++] = near;
  }
  return nearest;
}

double ClosestPoint::SquaredDistance(const double* point, double t) const {
  double value[kMaxDimension];
  curve_.Evaluate(t, 0, value);
  return SquaredDistanceBetween(value, point, curve_.dimension());
}

FootPoint ClosestPoint::Refine(const double* point, double low, double start, double high) const {
  // Bisection alone needs 53 steps from any bracket to neighbouring doubles.
  constexpr int kMaxSteps = 100;
  const double tolerance = 2.0 * kEpsilon * std::max(std::abs(low), std::abs(high));
  DistanceAt at = Measure(curve_, point, start);
  const DistanceAt first = at;
  for (int step = 0; step < kMaxSteps && at.slope != 0.0; ++step) {
    (at.slope > 0.0 ? high : low) = at.t;
    double next = at.t - at.slope / at.curvature;
    if (!(at.curvature > 0.0 && next > low && next < high)) next = low + 0.5 * (high - low);
    if (!(std::abs(next - at.t) > tolerance)) break;
    const DistanceAt tried = Measure(curve_, point, next);
    if (tried.squared_distance <= at.squared_distance + at.rounding) {
      at = tried;
    } else {
      // A minimum lies on this side of `next`; Newton's step is now outside, bisection follows.
      (next < at.t ? low : high) = next;
    }
  }
  if (!(at.squared_distance <= first.squared_distance + first.rounding)) at = first;
  return {curve_.basis().Wrap(at.t), at.squared_distance};
}

FootPoint ClosestPoint::Find(const double* point, double start) const {
  const BsplineBasis& basis = curve_.basis();
  const int last = static_cast<int>(sample_parameters_.size()) - 1;
  // The neighbours of the samples at the ends; beyond the seam for periodic curves.
  const auto parameter = [&](int i) {
    if (i >= 0 && i <= last) return sample_parameters_[i];
    if (!basis.periodic()) return sample_parameters_[std::clamp(i, 0, last)];
    return i < 0 ? sample_parameters_[last] - basis.domain_length()
                 : sample_parameters_[0] + basis.domain_length();
  };
  const int nearest = NearestSample(point);
  start = basis.Wrap(start);
  if (SquaredDistance(point, start) < SquaredDistance(point, parameter(nearest))) {
    const auto after =
        std::upper_bound(sample_parameters_.begin(), sample_parameters_.end(), start);
    const int above = static_cast<int>(after - sample_parameters_.begin());
    return Refine(point, parameter(above - 1), start, parameter(above));
  }
  return Refine(point, parameter(nearest - 1), parameter(nearest), parameter(nearest + 1));
}

}  // namespace batten
