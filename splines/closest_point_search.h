#ifndef BATTEN_SPLINES_CLOSEST_POINT_SEARCH_H_
#define BATTEN_SPLINES_CLOSEST_POINT_SEARCH_H_

// Included by closest_point.cc alone.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "splines/closest_point.h"
#include "splines/curve_distance.h"

namespace batten {

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

/// One point's search.
class ClosestPoint::Search {
 public:
  /// Looks around `start` only.
  Search(const ClosestPoint& all, const double* point, double start, const FootWatch* watch)
      : all_(all), curve_(all.curve_), point_(point), watch_(watch) {
    const BsplineBasis& basis = curve_.basis();
    start = basis.Wrap(start);
    if (!std::isfinite(start)) start = basis.domain_begin();
    const int piece = all.PieceOf(basis.FindSpan(start), start);
    const BezierStretch stretch = all.Stretch(piece);
    // No farther than the start itself; a good one excludes nearly all the rest.
    best_ = FindFoot(stretch, point, stretch.low, start, stretch.high);
    if (!std::isfinite(best_.squared_distance)) return;
    SetThreshold();
    home_ = HomeOf(piece);
  }

  void Run() {
    if (std::isfinite(best_.squared_distance)) VisitBoxes();
  }

  /// Finds what Run finds, to the bit, from what is known of an earlier search for the same point.
  void RunWatched(FootWatch::Home* home) {
    if (!std::isfinite(best_.squared_distance)) return;
    const double distance = std::sqrt(best_.squared_distance);
    const double away = distance + all_.Tolerance(distance) + watch_->moved_;
    home->stays = home_ >= 0 && home->piece == home_ && away <= home->budget;
    if (home->stays) return;
    VisitBoxes();
    const BsplineBasis& basis = curve_.basis();
    const double t = basis.Wrap(best_.t);
    home->piece = HomeOf(all_.PieceOf(basis.FindSpan(t), t));
    if (home->piece >= 0) home->budget = watch_->moved_ + all_.Clearance(point_, home->piece);
  }

  /// Whether another stretch is as near: everything within the tolerance is looked at again.
  void LookForATie() {
    if (!std::isfinite(best_.squared_distance)) return;
    const double distance = std::sqrt(best_.squared_distance);
    farthest_tie_ = distance + all_.Tolerance(distance);
    limit_ = farthest_tie_ * farthest_tie_;
    home_ = -1;  // close ties are within it
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
  /// `piece` if the best is a foot inside of it and f is convex there and on the pieces beside it,
  /// which therefore need not be looked at. Else -1.
  int HomeOf(int piece) const {
    const bool is_inside = all_.PieceLow(piece) < best_.t && best_.t < all_.PieceHigh(piece);
    const bool is_alone = std::sqrt(best_.squared_distance) < all_.reaches_[piece];
    return best_.is_foot && is_inside && is_alone ? piece : -1;
  }

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
    if (home_ >= 0 && all_.AreNeighbours(home_, index)) return;
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
  const FootWatch* watch_;  // may be null
  CurveDistance best_;
  int home_ = -1;                                                // of the start, by HomeOf
  double certified_ = std::numeric_limits<double>::quiet_NaN();  // squared
  double limit_ = certified_;  // what is nowhere below it is left out
  double farthest_tie_ = std::numeric_limits<double>::infinity();  // finite: looking for ties
  double left_open_ = std::numeric_limits<double>::infinity();  // bound of what could not be split
  bool tie_ = false;
  double other_ = 0.0;
  int num_pieces_ = 0;
};

}  // namespace batten

#endif  // BATTEN_SPLINES_CLOSEST_POINT_SEARCH_H_
