#include "splines/closest_point.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "splines/basis_functions.h"

namespace batten {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr int kPiecesPerRun = 8;

int PiecesPerSpan(const BsplineBasis& basis) { return 8 * basis.degree(); }

/// f = |C - Q|^2 at t, slope = f' / 2, curvature = f'' / 2.
struct DistanceAt {
  double t = 0.0;
  double squared_distance = 0.0;
  double slope = 0.0;
  double curvature = 0.0;
  double rounding = 0.0;  // differences of squared_distance below this mean nothing
};

/// About p roundings of the size of the coordinates.
double RoundingOfDifference(int degree, double size) { return (degree + 4) * kEpsilon * size; }

/// By the polynomial of `span`, also at its end, where the next one may leave at an angle.
DistanceAt Measure(const BsplineCurve& curve, int span, const double* point, double t) {
  const BsplineBasis& basis = curve.basis();
  const int p = basis.degree();
  const int d = curve.dimension();
  double basis_values[3 * kMaxOrder];
  EvaluateBasisDerivatives(p, basis.knots().data(), span, t, 2, basis_values);
  double values[3][kMaxDimension] = {};
  for (int j = 0; j <= p; ++j) {
    const auto control_point = curve.control_points().row(basis.ControlPointIndex(span - p + j));
    for (int k = 0; k < 3; ++k) {
      const double factor = basis_values[k * (p + 1) + j];
      for (int c = 0; c < d; ++c) values[k][c] += factor * control_point[c];
    }
  }
  DistanceAt at;
  at.t = t;
  double size = 0.0;
  for (int c = 0; c < d; ++c) {
    const double difference = values[0][c] - point[c];
    at.squared_distance += difference * difference;
    at.slope += difference * values[1][c];
    at.curvature += values[1][c] * values[1][c] + difference * values[2][c];
    size = std::max({size, std::abs(values[0][c]), std::abs(point[c])});
  }
  const double off = RoundingOfDifference(p, size);
  at.rounding = off * (2.0 * std::sqrt(d * at.squared_distance) + d * off);
  return at;
}

/// The lowest point of one smooth piece [low, high] that Newton's method leads to from `start`.
DistanceAt Refine(const BsplineCurve& curve, int span, const double* point, double low,
                  double start, double high) {
  // Bisection alone needs 53 steps from any bracket to neighbouring doubles.
  constexpr int kMaxSteps = 100;
  const double tolerance = 2.0 * kEpsilon * std::max(std::abs(low), std::abs(high));
  bool low_is_tried = false;
  bool high_is_tried = false;
  DistanceAt at = Measure(curve, span, point, start);
  for (int step = 0; step < kMaxSteps && at.slope != 0.0; ++step) {
    (at.slope > 0.0 ? high : low) = at.t;
    (at.slope > 0.0 ? high_is_tried : low_is_tried) = true;
    double next = at.slope > 0.0 ? low : high;
    if (at.curvature > 0.0) next = std::clamp(at.t - at.slope / at.curvature, low, high);
    if ((next == low && low_is_tried) || (next == high && high_is_tried)) {
      next = low + 0.5 * (high - low);
    }
    if (!(std::abs(next - at.t) > tolerance)) break;
    const DistanceAt tried = Measure(curve, span, point, next);
    if (tried.squared_distance <= at.squared_distance + at.rounding) {
      at = tried;
    } else {
      // A minimum lies on this side of `next`.
      (next < at.t ? low : high) = next;
      (next < at.t ? low_is_tried : high_is_tried) = true;
    }
  }
  return at;
}

/// True if `a` is the better foot. Of two that differ by rounding only and are neighbours, the one
/// with the smaller slope is: at half the digits of t the distance no longer tells them apart.
bool IsBetter(const BsplineBasis& basis, const DistanceAt& a, const DistanceAt& b) {
  double apart = std::abs(a.t - b.t);
  if (basis.periodic()) apart = std::min(apart, basis.domain_length() - apart);
  if (apart <= 1e-4 * basis.domain_length() &&
      std::abs(a.squared_distance - b.squared_distance) <= b.rounding) {
    return std::abs(a.slope) < std::abs(b.slope);
  }
  return a.squared_distance < b.squared_distance;
}

/// max |C''| on a span: of the control points of C'' there (Piegl & Tiller, eq. 3.8), whose hull
/// holds it.
double SecondDerivativeBound(const BsplineCurve& curve, int span) {
  const BsplineBasis& basis = curve.basis();
  const int p = basis.degree();
  Points points(p + 1, curve.dimension());
  for (int j = 0; j <= p; ++j) {
    points.row(j) = curve.control_points().row(basis.ControlPointIndex(span - p + j));
  }
  for (int k = 1; k <= 2; ++k) {
    for (int j = 0; j <= p - k; ++j) {
      const double* u = basis.knots().data() + span - p + j;
      points.row(j) = (p - k + 1) / (u[p + 1] - u[k]) * (points.row(j + 1) - points.row(j));
    }
  }
  return p < 2 ? 0.0 : points.topRows(p - 1).rowwise().norm().maxCoeff();
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
  SampleSpans();
  BuildBoxes();
}

void ClosestPoint::SampleSpans() {
  const BsplineBasis& basis = curve_.basis();
  const std::vector<double>& knots = basis.knots();
  const int per_span = PiecesPerSpan(basis);
  size_ = curve_.control_points().cwiseAbs().maxCoeff();
  rounding_ = 8.0 * basis.order() * kEpsilon * size_;
  for (int k = basis.first_span(); k <= basis.last_span(); ++k) {
    if (!(knots[k] < knots[k + 1])) continue;
    const double step = (knots[k + 1] - knots[k]) / per_span;
    for (int i = 0; i < per_span; ++i) {
      sample_parameters_.push_back(std::min(knots[k] + i * step, knots[k + 1]));
    }
    spans_.push_back(k);
    deviations_.push_back(step * step / 8.0 * SecondDerivativeBound(curve_, k) + rounding_);
  }
  sample_parameters_.push_back(basis.domain_end());
  samples_ = curve_.Sample(Eigen::Map<const Eigen::VectorXd>(
      sample_parameters_.data(), static_cast<Eigen::Index>(sample_parameters_.size())));
}

void ClosestPoint::BuildBoxes() {
  const int d = curve_.dimension();
  const int per_span = PiecesPerSpan(curve_.basis());
  const int num_pieces = static_cast<int>(sample_parameters_.size()) - 1;
  // Runs never reach across a span: 8 p pieces are p runs.
  std::vector<Box> boxes(num_pieces / kPiecesPerRun);
  for (int b = 0; b < static_cast<int>(boxes.size()); ++b) {
    const auto run = samples_.middleRows(b * kPiecesPerRun, kPiecesPerRun + 1);
    const double deviation = deviations_[b * kPiecesPerRun / per_span];
    for (int c = 0; c < d; ++c) {
      boxes[b].low[c] = run.col(c).minCoeff() - deviation;
      boxes[b].high[c] = run.col(c).maxCoeff() + deviation;
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

ClosestPoint::Piece ClosestPoint::MakePiece(const double* point, int index) const {
  const int d = curve_.dimension();
  const double* a = &samples_(index, 0);
  const double* b = &samples_(index + 1, 0);
  double along = 0.0;
  double squared_length = 0.0;
  for (int c = 0; c < d; ++c) {
    along += (point[c] - a[c]) * (b[c] - a[c]);
    squared_length += (b[c] - a[c]) * (b[c] - a[c]);
  }
  const double fraction = squared_length > 0.0 ? std::clamp(along / squared_length, 0.0, 1.0) : 0.0;
  double squared = 0.0;
  for (int c = 0; c < d; ++c) {
    squared += std::pow(point[c] - (a[c] + fraction * (b[c] - a[c])), 2);
  }
  const double deviation = deviations_[index / PiecesPerSpan(curve_.basis())];
  double bound = std::max(0.0, std::sqrt(squared) - deviation);
  // NaN has no place in an order.
  if (!std::isfinite(squared - deviation)) bound = std::numeric_limits<double>::infinity();
  const double low = sample_parameters_[index];
  const double high = sample_parameters_[index + 1];
  return {index, bound * bound, std::min(low + fraction * (high - low), high)};
}

/// False also where a distance is NaN: the start then is the answer.
bool ClosestPoint::CanBeNearer(int level, int index, double squared_bound,
                               double squared_distance) const {
  if (!(squared_bound < squared_distance)) return false;
  const int d = curve_.dimension();
  // The curve passes through the point, as far as its coordinates are known.
  const double off = RoundingOfDifference(curve_.basis().degree(), size_);
  if (squared_distance <= d * off * off) return false;
  const Box& box = levels_[level][index];
  double squared_width = 0.0;
  for (int c = 0; c < d; ++c) squared_width += std::pow(box.high[c] - box.low[c], 2);
  // Widened by rounding_ on all sides, a box of equal points is 2 rounding_ wide.
  constexpr double kFlat = 4.0;
  if (squared_width > d * std::pow(kFlat * rounding_, 2)) return true;
  return std::sqrt(squared_bound) + std::sqrt(squared_width) < std::sqrt(squared_distance);
}

FootPoint ClosestPoint::Find(const double* point, double start) const {
  struct Visit {
    int level;
    int index;
    double squared_bound;
  };
  const BsplineBasis& basis = curve_.basis();
  const int d = curve_.dimension();
  start = basis.Wrap(start);
  if (!std::isfinite(start)) start = basis.domain_begin();
  DistanceAt best = Measure(curve_, basis.FindSpan(start), point, start);
  // Each level leaves at most one sibling waiting, and int indices allow no more than 32 levels.
  std::array<Visit, 64> waiting;
  int num_waiting = 0;
  waiting[num_waiting++] = {static_cast<int>(levels_.size()) - 1, 0, 0.0};
  int num_pieces = 0;
  while (num_waiting > 0) {
    const Visit visit = waiting[--num_waiting];
    if (!CanBeNearer(visit.level, visit.index, visit.squared_bound, best.squared_distance)) {
      continue;
    }
    if (visit.level == 0) {
      std::array<Piece, kPiecesPerRun> pieces;
      for (int i = 0; i < kPiecesPerRun; ++i) {
        pieces[i] = MakePiece(point, visit.index * kPiecesPerRun + i);
      }
      std::sort(pieces.begin(), pieces.end(),
                [](const Piece& a, const Piece& b) { return a.squared_bound < b.squared_bound; });
      for (const Piece& piece : pieces) {
        if (!(piece.squared_bound < best.squared_distance)) continue;
        const DistanceAt found = Refine(curve_, spans_[piece.index / PiecesPerSpan(basis)], point,
                                        sample_parameters_[piece.index], piece.start,
                                        sample_parameters_[piece.index + 1]);
        if (IsBetter(basis, found, best)) best = found;
        ++num_pieces;
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
      if (far.squared_bound < near.squared_bound) std::swap(near, far);
      waiting[num_waiting++] = far;
    }
    waiting[num_waiting++] = near;
  }
  return {basis.Wrap(best.t), best.squared_distance, num_pieces};
}

}  // namespace batten
