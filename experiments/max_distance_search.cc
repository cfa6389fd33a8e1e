#include "experiments/max_distance_search.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "experiments/curve_window.h"
#include "experiments/max_distance_growth.h"

namespace batten {
namespace {

// A descent that needs more control points is given up.
constexpr int kFewEnough = 32;

/// From one bound to a smaller one: a curve whose knots and feet are good for the larger bound is a
/// better start than any rule for parameters.
class Descent {
 public:
  Descent(TrackedCurve* curve, double bound, const SearchWatch& watch)
      : curve_(curve), bound_(bound), watch_(watch) {}

  /// False if knots inserted where it is too far do not lead below the bound.
  bool Run() {
    constexpr int kMostRounds = 12;
    for (int round = 0; round < kMostRounds; ++round) {
      if (!watch_(curve_->num_control_points(), 0.0)) return false;
      if (Lower(round == 0)) return IsDetermined(*curve_);
      if (!Insert() || curve_->num_control_points() > 3 * kFewEnough) return false;
    }
    return false;
  }

 private:
  bool Lower(bool is_first) {
    CurveWindow all(curve_, bound_, curve_->first_free_knot(), curve_->last_free_knot());
    // A curve that is exact but for its parameters gets there without any new knot.
    const int steps = is_first ? 40 : 8;
    return all.Lower(2, steps, 1.0) || all.Lower(6, 8, 1.0);
  }

  /// One knot in each span with a point too far, between its data points.
  bool Insert() {
    curve_->FollowAll(4);
    struct Place {
      double t;
      bool is_far;
    };
    std::vector<Place> places;
    const double begin = curve_->domain_begin();
    for (int i = 0; i < curve_->num_points(); ++i) {
      double t = curve_->parameter(i);
      if (curve_->closed()) t -= curve_->period() * std::floor((t - begin) / curve_->period());
      places.push_back({t, curve_->squared_distance(i) > bound_ * bound_});
    }
    std::sort(places.begin(), places.end(),
              [](const Place& a, const Place& b) { return a.t < b.t; });
    std::vector<double> knots;
    for (std::size_t first = 0; first < places.size();) {
      const int span = curve_->SpanOf(places[first].t);
      std::size_t end = first;
      bool is_far = false;
      for (; end < places.size() && curve_->SpanOf(places[end].t) == span; ++end) {
        is_far = is_far || places[end].is_far;
      }
      const std::size_t middle = first + (end - first) / 2;
      const bool has_room = end - first >= 2 && places[middle - 1].t < places[middle].t;
      if (is_far && has_room) knots.push_back(0.5 * (places[middle - 1].t + places[middle].t));
      first = end;
    }
    bool inserted = false;
    for (const double t : knots) {
      TrackedCurve before = *curve_;
      curve_->InsertKnot(t);
      if (IsDetermined(*curve_)) {
        inserted = true;
      } else {
        *curve_ = std::move(before);
      }
    }
    return inserted;
  }

  TrackedCurve* curve_;
  double bound_;
  const SearchWatch& watch_;
};

std::optional<TrackedCurve> GrowWatched(int degree, bool closed, const Points& points,
                                        const Eigen::VectorXd& parameters, double bound,
                                        const SearchWatch& watch) {
  const auto stop = [&](int num_control_points) { return !watch(num_control_points, 0.0); };
  return GrowCurve(degree, closed, points, parameters, bound, stop);
}

/// Few control points for a large bound, then for smaller ones. It finds the spline that the points
/// come from where there is one; nothing where the curve needs many control points, for which it
/// takes several times as long as the direct way and finds no fewer.
std::optional<TrackedCurve> DescendFromCoarse(int degree, bool closed, const Points& points,
                                              const Eigen::VectorXd& parameters, double bound,
                                              const SearchWatch& watch) {
  // Bounds that fall by this factor, the first about a fiftieth of the box.
  constexpr double kFactor = 8.0;
  constexpr double kCoarsest = 0.02;
  const int levels = static_cast<int>(std::ceil(std::log(kCoarsest / bound) / std::log(kFactor)));
  if (levels < 1) return std::nullopt;
  const double coarse = bound * std::pow(kFactor, levels);
  std::optional<TrackedCurve> curve =
      GrowWatched(degree, closed, points, parameters, coarse, watch);
  if (!curve.has_value() || !RemoveKnots(coarse, watch, &*curve)) return std::nullopt;
  for (int level = levels - 1; level >= 0; --level) {
    const double level_bound = bound * std::pow(kFactor, level);
    if (curve->num_control_points() > kFewEnough) return std::nullopt;
    if (!Descent(&*curve, level_bound, watch).Run()) return std::nullopt;
    if (!RemoveKnots(level_bound, watch, &*curve)) return std::nullopt;
  }
  return curve;
}

}  // namespace

std::optional<TrackedCurve> SearchFewControlPoints(int degree, bool closed, const Points& points,
                                                   const Eigen::VectorXd& parameters, double bound,
                                                   const SearchWatch& watch) {
  bool went_on = true;
  const SearchWatch ask = [&](int num_control_points, double fraction) {
    return went_on = went_on && watch(num_control_points, fraction);
  };
  const std::optional<TrackedCurve> descended =
      DescendFromCoarse(degree, closed, points, parameters, bound, ask);
  if (!went_on) return std::nullopt;
  std::optional<TrackedCurve> direct = GrowWatched(degree, closed, points, parameters, bound, ask);
  if (direct.has_value() && !RemoveKnots(bound, ask, &*direct)) return std::nullopt;
  if (!went_on) return std::nullopt;
  const bool is_fewer =
      descended.has_value() &&
      (!direct.has_value() || descended->num_control_points() <= direct->num_control_points());
  return is_fewer ? descended : direct;
}

}  // namespace batten
