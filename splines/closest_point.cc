#include "splines/closest_point.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <thread>
#include <utility>

#include "splines/closest_point_search.h"

namespace batten {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
// A whole span is seldom convex, a quarter mostly is.
constexpr int kPiecesPerSpan = 4;

/// Calls work(i) for i = 0..m-1, `threads` of them sharing the range.
template <typename Work>
void ForEachRow(Eigen::Index m, int threads, const Work& work) {
  const auto work_on = [&work](Eigen::Index begin, Eigen::Index end) {
    for (Eigen::Index i = begin; i < end; ++i) work(i);
  };
  const Eigen::Index num_threads = std::max(threads, 1);
  const Eigen::Index share = (m + num_threads - 1) / num_threads;
  std::vector<std::thread> others;
  for (Eigen::Index begin = share; begin < m; begin += share) {
    others.emplace_back(work_on, begin, std::min(begin + share, m));
  }
  work_on(0, std::min(share, m));
  for (std::thread& other : others) other.join();
}

}  // namespace

ClosestPoint::ClosestPoint(const BsplineCurve& curve) : curve_(curve) {
  MakePieces();
  BuildBoxes();
  FindReaches();
}

double ClosestPoint::Tolerance(double distance) const {
  return std::max(kTolerance * std::max(size_, distance),
                  4.0 * std::sqrt(curve_.dimension()) * rounding_);
}

void ClosestPoint::MakePieces() {
  const BsplineBasis& basis = curve_.basis();
  const std::vector<double>& knots = basis.knots();
  const int p = basis.degree();
  const int d = curve_.dimension();
  size_ =
      (curve_.control_points().colwise().maxCoeff() - curve_.control_points().colwise().minCoeff())
          .maxCoeff();
  rounding_ = 2.0 * basis.order() * kEpsilon * curve_.control_points().cwiseAbs().maxCoeff();
  span_places_.assign(basis.num_domain_spans(), -1);
  double window[kMaxOrder * kMaxDimension];
  for (int k = basis.first_span(); k <= basis.last_span(); ++k) {
    if (!(knots[k] < knots[k + 1])) continue;
    span_places_[k - basis.first_span()] = static_cast<int>(spans_.size());
    spans_.push_back(k);
    for (int j = 0; j <= p; ++j) {
      const int index = basis.ControlPointIndex(k - p + j);
      for (int c = 0; c < d; ++c) window[j * d + c] = curve_.control_points()(index, c);
    }
    const std::size_t first = beziers_.size();
    const int stride = (p + 1) * d;
    beziers_.resize(first + static_cast<std::size_t>(kPiecesPerSpan) * stride);
    for (int i = 0; i < kPiecesPerSpan; ++i) {
      const int piece = static_cast<int>(first / stride) + i;
      BezierPoints(p, d, knots.data(), k, window, PieceLow(piece), PieceHigh(piece),
                   &beziers_[first + static_cast<std::size_t>(i) * stride]);
    }
  }
}

double ClosestPoint::PieceLow(int piece) const {
  const double* u = &curve_.basis().knots()[spans_[piece / kPiecesPerSpan]];
  return u[0] + (piece % kPiecesPerSpan) * (u[1] - u[0]) / kPiecesPerSpan;
}

double ClosestPoint::PieceHigh(int piece) const {
  const double* u = &curve_.basis().knots()[spans_[piece / kPiecesPerSpan]];
  const int next = piece % kPiecesPerSpan + 1;
  return next == kPiecesPerSpan ? u[1] : u[0] + next * (u[1] - u[0]) / kPiecesPerSpan;
}

int ClosestPoint::PieceOf(int span, double t) const {
  const int first = span_places_[span - curve_.basis().first_span()] * kPiecesPerSpan;
  int piece = first;
  while (piece + 1 < first + kPiecesPerSpan && t >= PieceHigh(piece)) ++piece;
  return piece;
}

BezierStretch ClosestPoint::Stretch(int piece) const {
  const int p = curve_.basis().degree();
  const int d = curve_.dimension();
  return {p, d, &beziers_[static_cast<std::size_t>(piece) * (p + 1) * d], PieceLow(piece),
          PieceHigh(piece)};
}

void ClosestPoint::BuildBoxes() {
  const int d = curve_.dimension();
  const int p = curve_.basis().degree();
  std::vector<Box> boxes(spans_.size() * kPiecesPerSpan);
  for (std::size_t b = 0; b < boxes.size(); ++b) {
    const Eigen::Map<const Points> hull(&beziers_[b * (p + 1) * d], p + 1, d);
    for (int c = 0; c < d; ++c) {
      boxes[b].low[c] = hull.col(c).minCoeff() - rounding_;
      boxes[b].high[c] = hull.col(c).maxCoeff() + rounding_;
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

/// f'' / 2 = |C'|^2 + (C - Q) . C'' is positive where |C - Q| < min |C'|^2 / max |C''|, with C' and
/// C'' in the hull of their Bezier points.
double ClosestPoint::ConvexReach(const BezierStretch& stretch, double* length) const {
  const int p = stretch.degree, d = stretch.dimension;
  const double h = stretch.high - stretch.low;
  const auto at = [&](int i, int c) { return stretch.points[i * d + c]; };
  double chord[kMaxDimension], squared_chord = 0.0;
  for (int c = 0; c < d; ++c) {
    chord[c] = at(p, c) - at(0, c);
    squared_chord += chord[c] * chord[c];
  }
  double slowest = std::numeric_limits<double>::infinity(), sharpest = 0.0;
  *length = 0.0;
  for (int i = 0; i < p; ++i) {
    double along = 0.0, squared_leg = 0.0, squared_bend = 0.0;
    for (int c = 0; c < d; ++c) {
      const double leg = at(i + 1, c) - at(i, c);
      const double bend = i + 1 < p ? at(i + 2, c) - at(i + 1, c) - leg : 0.0;
      along += leg * chord[c];
      squared_leg += leg * leg;
      squared_bend += bend * bend;
    }
    *length += std::sqrt(squared_leg);
    slowest = std::min(slowest, along);
    sharpest = std::max(sharpest, std::sqrt(squared_bend));
  }
  const double least_leg = slowest / std::sqrt(squared_chord) - 4.0 * std::sqrt(d) * rounding_;
  const double speed = p * std::max(least_leg, 0.0) / h;
  const double bend = p * (p - 1) * (sharpest + 4.0 * rounding_) / (h * h);
  return speed > 0.0 ? speed * speed / bend : 0.0;
}

void ClosestPoint::FindReaches() {
  const auto count = static_cast<int>(spans_.size()) * kPiecesPerSpan;
  const BsplineBasis& basis = curve_.basis();
  std::vector<double> own(static_cast<std::size_t>(count)), lengths(own);
  for (int k = 0; k < count; ++k) own[k] = ConvexReach(Stretch(k), &lengths[k]);
  reaches_.assign(own.size(), 0.0);
  // Where a knot's multiplicity is the degree C' may jump.
  const auto is_smooth_before = [&](int piece) {
    if (piece % kPiecesPerSpan != 0) return true;
    const int span = spans_[piece / kPiecesPerSpan];
    return basis.knots()[span - basis.degree() + 1] < basis.knots()[span];
  };
  constexpr double kSafe = 1.0 - 1e-9;
  for (int k = 0; k < count; ++k) {
    double reach = own[k], length = lengths[k];
    bool smooth = true;
    for (const int near : {k - 1, k + 1}) {
      const bool is_inside = near >= 0 && near < count;
      if (!is_inside && !basis.periodic()) continue;
      const int other = (near + count) % count;
      reach = std::min(reach, own[other]);
      length += lengths[other];
      smooth = smooth && is_smooth_before(near < k ? k : other);
    }
    if (smooth) reaches_[k] = kSafe * reach - length;
  }
}

double ClosestPoint::Clearance(const double* point, int piece) const {
  switch (curve_.dimension()) {
    case 2:
      return ClearanceOf<2>(point, piece);
    case 3:
      return ClearanceOf<3>(point, piece);
    default:
      return ClearanceOf<-1>(point, piece);
  }
}

template <int D>
double ClosestPoint::ClearanceOf(const double* point, int piece) const {
  struct Visit {
    int level;
    int index;
    double squared_bound;
  };
  const int d = curve_.dimension();
  double least = std::numeric_limits<double>::infinity();
  std::array<Visit, 64> waiting;
  int num_waiting = 0;
  waiting[num_waiting++] = {static_cast<int>(levels_.size()) - 1, 0, 0.0};
  while (num_waiting > 0) {
    const Visit visit = waiting[--num_waiting];
    if (!(visit.squared_bound < least)) continue;
    if (visit.level == 0) {
      if (!AreNeighbours(piece, visit.index)) least = visit.squared_bound;
      continue;
    }
    const std::vector<Box>& boxes = levels_[visit.level - 1];
    const auto child = [&](int index) {
      return Visit{visit.level - 1, index, SquaredDistanceToBox<D>(boxes[index], point, d)};
    };
    Visit near = child(2 * visit.index);
    if (2 * visit.index + 1 < static_cast<int>(boxes.size())) {
      Visit far = child(2 * visit.index + 1);
      if (far.squared_bound < near.squared_bound) std::swap(near, far);
      waiting[num_waiting++] = far;
    }
    waiting[num_waiting++] = near;
  }
  return std::sqrt(least);
}

bool ClosestPoint::AreNeighbours(int a, int b) const {
  const int apart = std::abs(a - b);
  return apart <= 1 ||
         (curve_.basis().periodic() && apart + 1 == static_cast<int>(reaches_.size()));
}

FootPoint ClosestPoint::Find(const double* point, double start, bool look_for_tie) const {
  Search search(*this, point, start, nullptr);
  search.Run();
  if (look_for_tie) search.LookForATie();
  return search.Result();
}

std::vector<FootPoint> ClosestPoint::FindAll(const Points& points, int threads,
                                             const Eigen::VectorXd& starts,
                                             bool look_for_ties) const {
  std::vector<FootPoint> feet(static_cast<std::size_t>(points.rows()));
  ForEachRow(points.rows(), threads, [&](Eigen::Index i) {
    feet[static_cast<std::size_t>(i)] = Find(&points(i, 0), starts[i], look_for_ties);
  });
  return feet;
}

void ClosestPoint::FindAll(const Points& points, int threads, Eigen::VectorXd* parameters,
                           Eigen::VectorXd* squared_distances) const {
  if (squared_distances != nullptr) squared_distances->resize(points.rows());
  ForEachRow(points.rows(), threads, [&](Eigen::Index i) {
    const FootPoint foot = Find(&points(i, 0), (*parameters)[i]);
    (*parameters)[i] = foot.parameter;
    if (squared_distances != nullptr) (*squared_distances)[i] = foot.squared_distance;
  });
}

void ClosestPoint::FindAll(const Points& points, int threads, FootWatch* watch,
                           Eigen::VectorXd* parameters) const {
  watch->GoTo(curve_.control_points(), points.rows());
  ForEachRow(points.rows(), threads, [&](Eigen::Index i) {
    Search search(*this, &points(i, 0), (*parameters)[i], watch);
    search.RunWatched(&watch->homes_[static_cast<std::size_t>(i)]);
    (*parameters)[i] = search.Result().parameter;
  });
}

Eigen::Index FootWatch::NumStayed() const {
  return std::count_if(homes_.begin(), homes_.end(), [](const Home& home) { return home.stays; });
}

void FootWatch::GoTo(const Points& control_points, Eigen::Index num_points) {
  const bool is_known = last_.rows() == control_points.rows() &&
                        last_.cols() == control_points.cols() &&
                        static_cast<Eigen::Index>(homes_.size()) == num_points;
  if (is_known) moved_ += (control_points - last_).rowwise().norm().maxCoeff();
  if (!is_known || !std::isfinite(moved_)) {
    homes_.assign(static_cast<std::size_t>(num_points), Home());
    moved_ = 0.0;
  }
  last_ = control_points;
}

}  // namespace batten
