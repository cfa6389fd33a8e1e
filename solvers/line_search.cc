#include "solvers/line_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace batten {
namespace {

/// Minimiser of the cubic through both points' values and slopes; NaN where it has none.
double CubicMinimizer(const LinePoint& a, const LinePoint& b) {
  const double width = b.step - a.step;
  const double d1 = a.slope + b.slope - 3.0 * (b.change - a.change) / width;
  const double discriminant = d1 * d1 - a.slope * b.slope;
  if (!(discriminant >= 0.0)) return std::numeric_limits<double>::quiet_NaN();
  const double d2 = std::copysign(std::sqrt(discriminant), width);
  return b.step - width * (b.slope + d2 - d1) / (b.slope - a.slope + 2.0 * d2);
}

double SecantStep(const LinePoint& a, const LinePoint& b) {
  return a.step - a.slope * (b.step - a.step) / (b.slope - a.slope);
}

class Bracket {
 public:
  Bracket(const WolfeOptions& options, double slope_at_zero)
      : options_(options), slope_at_zero_(slope_at_zero) {
    low_.slope = slope_at_zero;
  }

  bool Accepts(const LinePoint& p) const { return !TooFar(p) && !TooShort(p); }

  /// Narrows the bracket around p and returns the next step to try.
  double Update(const LinePoint& p, bool finite) {
    if (!finite) {
      high_.step = p.step;
      has_high_ = true;
      high_is_finite_ = false;
      return low_.step + 0.1 * (p.step - low_.step);
    }
    if (TooFar(p)) {
      high_ = p;
      has_high_ = high_is_finite_ = true;
    } else {
      const LinePoint before = low_;
      low_ = p;
      if (!has_high_) return Extrapolate(before);
    }
    return Interpolate();
  }

  bool Exhausted() const {
    constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
    return has_high_ && high_.step - low_.step <= 4.0 * kEpsilon * high_.step;
  }
  const LinePoint& low() const { return low_; }

 private:
  bool TooFar(const LinePoint& p) const {
    const double c1 = options_.sufficient_decrease;
    const bool decreased = p.change <= c1 * p.step * slope_at_zero_;
    const bool approximately =
        std::abs(p.change) <= options_.noise && p.slope <= (2.0 * c1 - 1.0) * slope_at_zero_;
    if (!decreased && !approximately) return true;
    return options_.strong && p.slope > -options_.curvature * slope_at_zero_;
  }
  bool TooShort(const LinePoint& p) const { return p.slope < options_.curvature * slope_at_zero_; }

  double Extrapolate(const LinePoint& before) const {
    // Between twice and ten times as far: the secant of the slopes where it points forward.
    const double secant = SecantStep(before, low_);
    const double nearest = 2.0 * low_.step;
    const double farthest = 10.0 * low_.step;
    return secant > nearest ? std::min(secant, farthest) : nearest;
  }
  double Interpolate() const {
    const double width = high_.step - low_.step;
    // Towards an end without a value by halves: in smaller steps a barrier is never reached.
    double step = std::numeric_limits<double>::quiet_NaN();
    if (high_is_finite_) {
      step = CubicMinimizer(low_, high_);
      const bool noisy = std::abs(high_.change - low_.change) <= options_.noise;
      if ((noisy || !std::isfinite(step)) && high_.slope > low_.slope) {
        step = SecantStep(low_, high_);
      }
    }
    if (!std::isfinite(step)) step = low_.step + 0.5 * width;
    return std::clamp(step, low_.step + 0.05 * width, low_.step + 0.95 * width);
  }

  const WolfeOptions& options_;
  double slope_at_zero_;
  LinePoint low_;  // decreases enough, slope still steep; the origin at first
  LinePoint high_;
  bool has_high_ = false;
  bool high_is_finite_ = false;
};

}  // namespace

LineSearchEnd SearchWolfe(const WolfeOptions& options, double slope_at_zero, double first_step,
                          LineFunction* function, LinePoint* found) {
  if (!(slope_at_zero < 0.0)) return LineSearchEnd::kNoStep;
  Bracket bracket(options, slope_at_zero);
  LinePoint point;
  point.step = first_step;
  for (int i = 0; i < options.max_evaluations && !bracket.Exhausted(); ++i) {
    const Status status = function->Evaluate(&point);
    if (status == Status::kStop) return LineSearchEnd::kStopped;
    const bool finite = status == Status::kOk;
    if (finite && bracket.Accepts(point)) {
      *found = point;
      return LineSearchEnd::kFound;
    }
    const double next = bracket.Update(point, finite);
    if (!std::isfinite(next)) break;
    point.step = next;
  }
  // A step that decreases E enough but leaves the slope steep is still one to take.
  if (bracket.low().step > 0.0) {
    *found = bracket.low();
    return LineSearchEnd::kFound;
  }
  return LineSearchEnd::kNoStep;
}

}  // namespace batten
