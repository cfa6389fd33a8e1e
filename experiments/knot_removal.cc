#include "experiments/knot_removal.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "experiments/curve_window.h"
#include "splines/schoenberg_whitney.h"

namespace batten {
namespace {

// Knots on either side of a gap that move to close it.
constexpr int kReach = 3;

class KnotRemoval {
 public:
  KnotRemoval(TrackedCurve curve, double bound, const SearchWatch& watch)
      : curve_(std::move(curve)), bound_(bound), watch_(watch), first_count_(Count()) {}

  /// False if the watch ended it.
  bool Run() {
    constexpr int kMostRounds = 6;
    for (int round = 0; round < kMostRounds && !stopped_; ++round) {
      const int before = Count();
      // The first sweep leaves the knots where greed put them: only the second one is worth more.
      const int sweeps = round == 0 ? 2 : 1;
      for (int sweep = 0; sweep < sweeps; ++sweep) {
        Sweep();
        Relax();
      }
      RemoveInBatches();
      // A round that takes less than one in a hundred is the last.
      if (before - Count() <= Count() / 100) break;
    }
    return !stopped_;
  }
  const TrackedCurve& curve() const { return curve_; }

 private:
  int Count() const { return curve_.num_control_points(); }
  bool IsFewest() const { return Count() <= FewestControlPoints(curve_.degree(), curve_.closed()); }

  bool Watch() {
    if (!stopped_) {
      const double fraction = 1.0 - static_cast<double>(Count()) / (first_count_ + 1);
      stopped_ = !watch_(Count(), fraction);
    }
    return !stopped_;
  }

  /// The part of the curve around the place of the knot that was `knot` and is gone.
  CurveWindow Gap(int knot) {
    // A closed curve counts its knots from the gap on.
    const int right = curve_.closed() ? Count() : knot;
    return CurveWindow(&curve_, bound_, right - kReach, right - 1 + kReach);
  }
  CurveWindow All(double stray_limit) {
    return CurveWindow(&curve_, bound_, curve_.first_free_knot(), curve_.last_free_knot(),
                       stray_limit);
  }

  /// Every knot once, each alone, its neighbourhood moving.
  void Sweep() {
    int knot = curve_.first_free_knot();
    const int num_knots = curve_.last_free_knot() - knot + 1;
    for (int tried = 0; tried < num_knots && !IsFewest() && Watch(); ++tried) {
      if (knot > curve_.last_free_knot()) knot = curve_.first_free_knot();
      if (!Remove(knot)) {
        ++knot;
      } else if (curve_.closed()) {
        knot = 0;
      }
    }
  }

  bool Remove(int knot) {
    TrackedCurve start = curve_;
    curve_.RemoveKnot(knot);
    CurveWindow gap = Gap(knot);
    gap.SolveAtParameters();
    if (CloseGap(&gap) && IsDetermined(curve_)) return true;
    curve_ = std::move(start);
    return false;
  }

  /// Powers of the distance that grow toward the largest one, as long as there is hope.
  static bool CloseGap(CurveWindow* gap) {
    struct Stage {
      int power;
      int steps;
      double hope;  // s at the start of the stage
    };
    constexpr Stage kStages[] = {{2, 4, 1e4}, {4, 6, 40.0}, {8, 10, 6.0}, {20, 12, 2.0}};
    for (const Stage& stage : kStages) {
      if (gap->LargestRatio() > stage.hope) return false;
      if (gap->Lower(stage.power, stage.steps, 1.0)) return true;
    }
    return false;
  }

  /// All distances evened out, so that knots can go where none could before.
  void Relax() {
    if (stopped_) return;
    TrackedCurve start = curve_;
    CurveWindow all = All(1.0);
    const double stray = std::max(1.0, all.Stray());
    all.Lower(8, 10, 0.0);
    const bool holds = curve_.squared_distances().maxCoeff() <= bound_ * bound_;
    if (!holds || all.Stray() > stray || !IsDetermined(curve_)) curve_ = std::move(start);
  }

  /// Several knots at once, then the whole curve moves; half as many where that fails.
  void RemoveInBatches() {
    const int least = std::max(1, Count() / 128);
    for (int size = std::max(least, Count() / 16); !IsFewest() && Watch();) {
      if (RemoveBatch(size, size == least)) continue;
      if (size == least) return;
      size = std::max(least, size / 2);
    }
  }

  bool RemoveBatch(int size, bool is_last_size) {
    const std::vector<int> knots = KnotsByCost();
    if (stopped_) return false;
    const TrackedCurve start = curve_;
    const double stray_limit = std::max(1.0, All(1.0).Stray());
    // Small curves are quick to try: the cheapest knot alone is a guess.
    constexpr int kMostTries = 10;
    constexpr int kWork = 600;
    const int tries = is_last_size ? std::clamp(kWork / Count(), 1, kMostTries) : 1;
    for (int attempt = 0; attempt < tries && Watch(); ++attempt) {
      if (attempt >= static_cast<int>(knots.size())) break;
      OpenGaps(ChooseApart(knots, attempt, size));
      if (MoveAll(stray_limit) && IsDetermined(curve_)) return true;
      curve_ = start;
    }
    return false;
  }

  /// From the knot whose absence costs the least: largest s after a short repair.
  std::vector<int> KnotsByCost() {
    std::vector<std::pair<double, int>> costs;
    const TrackedCurve start = curve_;
    for (int knot = curve_.first_free_knot(); knot <= curve_.last_free_knot() && Watch(); ++knot) {
      curve_.RemoveKnot(knot);
      CurveWindow gap = Gap(knot);
      gap.SolveAtParameters();
      gap.Lower(4, 2, 1e-3);
      costs.emplace_back(gap.LargestRatio(), knot);
      curve_ = start;
    }
    std::sort(costs.begin(), costs.end());
    std::vector<int> knots;
    for (const auto& cost : costs) knots.push_back(cost.second);
    return knots;
  }

  /// Up to `size` of them from `first` on, so far apart that their gaps do not overlap; the last
  /// along the curve comes first.
  std::vector<int> ChooseApart(const std::vector<int>& knots, int first, int size) const {
    std::vector<int> chosen;
    const auto is_apart = [&](int knot) {
      return std::all_of(chosen.begin(), chosen.end(), [&](int other) {
        int distance = std::abs(other - knot);
        if (curve_.closed()) distance = std::min(distance, Count() - distance);
        return distance >= 2 * kReach;
      });
    };
    for (std::size_t i = static_cast<std::size_t>(first); i < knots.size(); ++i) {
      if (static_cast<int>(chosen.size()) >= size) break;
      if (is_apart(knots[i])) chosen.push_back(knots[i]);
    }
    std::sort(chosen.rbegin(), chosen.rend());
    return chosen;
  }

  void OpenGaps(std::vector<int> knots) {
    for (std::size_t i = 0; i < knots.size() && !IsFewest(); ++i) {
      const int count = Count();
      curve_.RemoveKnot(knots[i]);
      CurveWindow gap = Gap(knots[i]);
      gap.SolveAtParameters();
      gap.Lower(4, 4, 1.0);
      if (!curve_.closed()) continue;
      for (std::size_t j = i + 1; j < knots.size(); ++j) {
        knots[j] = ((knots[j] - knots[i] - 1) % count + count) % count;
      }
    }
  }

  bool MoveAll(double stray_limit) {
    CurveWindow all = All(stray_limit);
    if (all.Lower(4, 6, 1.0) || all.Lower(8, 10, 1.0) || all.Lower(20, 20, 1.0)) return true;
    constexpr double kNearly = 1.2;
    return all.LargestRatio() < kNearly && all.Lower(60, 20, 1.0);
  }

  TrackedCurve curve_;
  double bound_;
  const SearchWatch& watch_;
  int first_count_;
  bool stopped_ = false;
};

}  // namespace

bool IsDetermined(const TrackedCurve& curve) {
  const auto basis = BsplineBasis::Make(curve.degree(), curve.closed(), curve.AllKnots(), nullptr);
  if (!basis.has_value()) return false;
  std::vector<double> parameters;
  for (const double t : curve.parameters()) parameters.push_back(basis->Wrap(t));
  return LargestDataShortage(*basis, std::move(parameters)).num_control_points == 0;
}

bool RemoveKnots(double bound, const SearchWatch& watch, TrackedCurve* curve) {
  KnotRemoval removal(*curve, bound, watch);
  if (!removal.Run()) return false;
  *curve = removal.curve();
  return true;
}

}  // namespace batten
