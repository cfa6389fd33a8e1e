#include "splines/closest_point.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <thread>
#include <utility>

#include "splines/curve_distance.h"

namespace batten {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
// A whole span is seldom convex, a quarter mostly is.
constexpr int kPiecesPerSpan = 4;

/// D is -1 where it is known at run time only.
template <int D, typename Box>
double SquaredDistanceToBox(const Box& box, const double* point, int dimension) {
  double sum = 0.0;
  for (int c = 0; c < (D >= 0 ? D : dimension); ++c) {
    const double outside = std::max({box.low[c] - point[c], point[c] - box.high[c], 0.0});
    sum += outside * outside;
  }
  return sum;
}

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

/// One point's search.
class ClosestPoint::Search {
 public:
  Search(const ClosestPoint& all, const double* point, double start)
      : all_(all), curve_(all.curve_), point_(point) {
    const BsplineBasis& basis = curve_.basis();
    start = basis.Wrap(start);
    if (!std::isfinite(start)) start = basis.domain_begin();
    const BezierStretch stretch = all.Stretch(all.PieceOf(basis.FindSpan(start), start));
    // No farther than the start itself; a good one excludes nearly all the rest.
    best_ = FindFoot(stretch, point, stretch.low, start, stretch.high);
    if (!std::isfinite(best_.squared_distance)) return;
    SetThreshold();
    VisitBoxes();
  }

  /// Whether another stretch is as near: everything within the tolerance is looked at again.
  void LookForATie() {
    if (!std::isfinite(best_.squared_distance)) return;
    const double distance = std::sqrt(best_.squared_distance);
    farthest_tie_ = distance + all_.Tolerance(distance);
    limit_ = farthest_tie_ * farthest_tie_;
    VisitBoxes();
  }

  FootPoint Result() const {
    const BsplineBasis& basis = curve_.basis();
    FootPoint foot;
    foot.parameter = basis.Wrap(best_.t);
    foot.squared_distance = best_.squared_distance;
    foot.lower_bound = std::sqrt(std::min(certified_, left_open_));
    foot.tie = tie_;
    foot.other = basis.Wrap(other_);
    foot.num_pieces = num_pieces_;
    return foot;
  }

 private:
  bool IsNeighbour(const CurveDistance& a, const CurveDistance& b) const {
    constexpr double kNeighbours = 1e-6;
    double apart = std::abs(a.t - b.t);
    const double length = curve_.basis().domain_length();
    if (curve_.basis().periodic()) apart = std::min(apart, length - apart);
    return apart <= kNeighbours * length;
  }

  /// Of two that differ by rounding only and are neighbours, the better one has the smaller slope:
  /// at half the digits of t the distance no longer tells them apart.
  bool IsBetter(const CurveDistance& a, const CurveDistance& b) const {
    if (IsNeighbour(a, b) && std::abs(a.squared_distance - b.squared_distance) <= b.rounding) {
      return std::abs(a.slope) < std::abs(b.slope);
    }
    // Nor do feet at one distance take turns: the first one, the start's, stays.
    return a.squared_distance < b.squared_distance - b.rounding;
  }

  /// Stretches that are nowhere below it are not looked at.
  void SetThreshold() {
    const double distance = std::sqrt(best_.squared_distance);
    const double lowest = std::max(0.0, distance - all_.Tolerance(distance));
    certified_ = limit_ = lowest * lowest;
  }

  void Consider(const CurveDistance& found) {
    if (std::isfinite(farthest_tie_)) {
      if (IsNeighbour(found, best_) || std::sqrt(found.squared_distance) > farthest_tie_) return;
      tie_ = true;
      other_ = found.t;
      limit_ = -1.0;  // one is enough
    } else if (IsBetter(found, best_)) {
      best_ = found;
      SetThreshold();
    }
  }

  void VisitBoxes() {
    switch (curve_.dimension()) {
      case 2:
        return VisitBoxesOf<2>();
      case 3:
        return VisitBoxesOf<3>();
      default:
        return VisitBoxesOf<-1>();
    }
  }

  template <int D>
  void VisitBoxesOf() {
    struct Visit {
      int level;
      int index;
      double squared_bound;
    };
    const auto& levels = all_.levels_;
    const int d = curve_.dimension();
    // Each level leaves at most one sibling waiting, and int indices allow no more than 32 levels.
    std::array<Visit, 64> waiting;
    int num_waiting = 0;
    waiting[num_waiting++] = {static_cast<int>(levels.size()) - 1, 0, 0.0};
    while (num_waiting > 0) {
      const Visit visit = waiting[--num_waiting];
      if (!(visit.squared_bound < limit_)) continue;
      if (visit.level == 0) {
        VisitPiece(visit.index);
        continue;
      }
      const std::vector<Box>& boxes = levels[visit.level - 1];
      const auto child = [&](int index) {
        return Visit{visit.level - 1, index, SquaredDistanceToBox<D>(boxes[index], point_, d)};
      };
      Visit near = child(2 * visit.index);
      if (2 * visit.index + 1 < static_cast<int>(boxes.size())) {
        Visit far = child(2 * visit.index + 1);
        if (far.squared_bound < near.squared_bound) std::swap(near, far);
        waiting[num_waiting++] = far;
      }
      waiting[num_waiting++] = near;
    }
  }

  void VisitPiece(int index) {
    const BezierStretch stretch = all_.Stretch(index);
    VisitPart(DistancePiece(stretch.degree, stretch.dimension, stretch.points, point_, stretch.low,
                            stretch.high, all_.rounding_),
              stretch);
  }

  void VisitPart(const DistancePiece& piece, const BezierStretch& stretch) {
    if (!(piece.lower_bound() < limit_)) return;
    ++num_pieces_;
    const double low = piece.low();
    const double high = piece.high();
    const double middle = low + 0.5 * (high - low);
    switch (piece.shape()) {
      case DistancePiece::Shape::kRises:
        return Consider(MeasureDistance(stretch, point_, low));
      case DistancePiece::Shape::kFalls:
        return Consider(MeasureDistance(stretch, point_, high));
      case DistancePiece::Shape::kConvex:
        // Where the best foot is in it, there is no other one.
        if (low < best_.t && best_.t < high && best_.is_foot) return;
        return Consider(FindFoot(stretch, point_, low, middle, high));
      case DistancePiece::Shape::kUnknown:
        break;
    }
    const bool cannot_be_split = !(low < middle && middle < high);
    if (cannot_be_split || piece.diameter() <= all_.Tolerance(0.0)) {
      Consider(MeasureDistance(stretch, point_, middle));
      if (cannot_be_split) left_open_ = std::min(left_open_, piece.lower_bound());
      return;
    }
    // At most 53 levels deep: then its ends are neighbours.
    DistancePiece left, right;
    piece.Split(&left, &right);
    const bool left_first = left.lower_bound() <= right.lower_bound();
    VisitPart(left_first ? left : right, stretch);
    VisitPart(left_first ? right : left, stretch);
  }

  const ClosestPoint& all_;
  const BsplineCurve& curve_;
  const double* point_;
  CurveDistance best_;
  double certified_ = std::numeric_limits<double>::quiet_NaN();  // squared
  double limit_ = certified_;  // what is nowhere below it is left out
  double farthest_tie_ = std::numeric_limits<double>::infinity();  // finite: looking for ties
  double left_open_ = std::numeric_limits<double>::infinity();  // bound of what could not be split
  bool tie_ = false;
  double other_ = 0.0;
  int num_pieces_ = 0;
};

FootPoint ClosestPoint::Find(const double* point, double start, bool look_for_tie) const {
  Search search(*this, point, start);
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

}  // namespace batten
