#include "experiments/curve_window.h"

#include <algorithm>
#include <cmath>

namespace batten {
CurveWindow::CurveWindow(TrackedCurve* curve, double bound, int first_knot, int last_knot,
                         double stray_limit)
    : curve_(curve), squared_bound_(bound * bound), stray_limit_(stray_limit) {
  const int p = curve->degree();
  const int n = curve->num_control_points();
  int first = first_knot - p;
  int last = last_knot - 1;
  if (curve->closed()) {
    holds_all_ = last - first + 1 + p > n;
    if (holds_all_) {
      first = 0;
      last = n - 1;
      first_knot = 0;
      last_knot = n - 1;
    }
    low_ = curve->Knot(first);
    high_ = holds_all_ ? low_ + curve->period() : curve->Knot(last + p + 1);
  } else {
    // A window with the first or last knot that moves has the end of the curve in it: its control
    // point stands under no such knot.
    first = first_knot <= curve->first_free_knot() ? 0 : first;
    last = last_knot >= curve->last_free_knot() ? n - 1 : last;
    first_knot = std::max(first_knot, curve->first_free_knot());
    last_knot = std::min(last_knot, curve->last_free_knot());
    low_ = curve->Knot(std::max(first, p));
    high_ = curve->Knot(std::min(last + p + 1, n));
  }
  first_ = first;
  count_ = last - first + 1;
  first_knot_ = first_knot;
  num_knots_ = std::max(0, last_knot - first_knot + 1);
  CollectPoints();
  mean_span_ = (high_ - low_) / std::max(1, count_);
  CollectGaps();
  ChoosePoints();
}

void CurveWindow::CollectPoints() {
  const bool closed = curve_->closed();
  const double period = curve_->period();
  for (int i = 0; i < curve_->num_points(); ++i) {
    double t = curve_->parameter(i);
    if (closed) {
      const double moved = t - period * std::floor((t - low_) / period);
      if (!holds_all_ && moved > high_) continue;
      curve_->SetFoot(i, moved, curve_->squared_distance(i));
    } else if (t < low_ || t > high_) {
      continue;
    }
    points_.push_back(i);
  }
}

void CurveWindow::CollectGaps() {
  const int m = curve_->num_points();
  int last = -1;
  for (const int i : points_) {
    for (const int gap : {i - 1, i}) {
      if (gap <= last || (!curve_->closed() && gap == m - 1)) continue;
      gaps_.push_back(gap);
      last = gap;
    }
  }
}

void CurveWindow::AddSamples(int gap, std::vector<Sample>* samples) const {
  constexpr double kBulge = 0.25;
  constexpr int kMostSamples = 4;
  const int m = curve_->num_points();
  const bool closed = curve_->closed();
  const int right = (gap + 1) % m;
  const double begin = curve_->parameter(gap);
  double step = curve_->parameter(right) - begin;
  if (closed) step -= curve_->period() * std::round(step / curve_->period());
  if (std::abs(step) < 0.02 * mean_span_) return;
  const int span = curve_->SpanOf(begin + 0.5 * step);
  const double share = std::abs(step) / (curve_->Knot(span + 1) - curve_->Knot(span));
  constexpr double kSmallShare = 0.1;
  if (share < kSmallShare) return;
  const int count = std::clamp(static_cast<int>(std::ceil(6.0 * share)), 1, kMostSamples);
  const int d = curve_->dimension();
  const double* const a = curve_->point(gap);
  const double* const b = curve_->point(right);
  double squared_length = 0.0;
  for (int c = 0; c < d; ++c) squared_length += (b[c] - a[c]) * (b[c] - a[c]);
  const double allowed = std::sqrt(squared_bound_) + kBulge * std::sqrt(squared_length);
  for (int k = 1; k <= count; ++k) {
    Sample sample;
    sample.t = begin + step * k / (count + 1);
    if (closed) sample.t -= curve_->period() * std::floor((sample.t - low_) / curve_->period());
    if (sample.t < low_ || sample.t > high_) continue;
    double value[kMaxDimension];
    curve_->Evaluate(curve_->SpanOf(sample.t), sample.t, 0, value);
    double along = 0.0;
    for (int c = 0; c < d; ++c) along += (value[c] - a[c]) * (b[c] - a[c]);
    const double place = squared_length > 0.0 ? std::clamp(along / squared_length, 0.0, 1.0) : 0.0;
    for (int c = 0; c < d; ++c) sample.target[c] = a[c] + place * (b[c] - a[c]);
    sample.squared_bound = allowed * allowed;
    double squared = 0.0;
    for (int c = 0; c < d; ++c)
      squared += (value[c] - sample.target[c]) * (value[c] - sample.target[c]);
    sample.ratio = squared / sample.squared_bound;
    samples->push_back(sample);
  }
}

std::vector<CurveWindow::Sample> CurveWindow::Samples() const {
  std::vector<Sample> samples;
  for (const int gap : gaps_) AddSamples(gap, &samples);
  return samples;
}

double CurveWindow::Stray() const {
  double largest = 0.0;
  for (const Sample& sample : Samples()) largest = std::max(largest, sample.ratio);
  return largest;
}

void CurveWindow::ChoosePoints() {
  // So many for each control point say where it belongs, with those that are far out.
  constexpr int kPerControlPoint = 10;
  constexpr double kFar = 0.6;
  const auto wanted = static_cast<std::size_t>(count_) * kPerControlPoint;
  const std::size_t stride = points_.size() / wanted;
  if (stride < 2) return;
  std::vector<int> chosen;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const bool is_far = curve_->squared_distance(points_[i]) > kFar * squared_bound_;
    (is_far || i % stride == 0 || i + 1 == points_.size() ? chosen : others_).push_back(points_[i]);
  }
  points_ = std::move(chosen);
}

bool CurveWindow::JoinPointsAbove(double limit) {
  FollowPoints(others_, 3);
  const auto joins = [&](int i) { return curve_->squared_distance(i) > limit * squared_bound_; };
  const std::size_t before = points_.size();
  std::copy_if(others_.begin(), others_.end(), std::back_inserter(points_), joins);
  others_.erase(std::remove_if(others_.begin(), others_.end(), joins), others_.end());
  return points_.size() > before;
}

CurveWindow::State CurveWindow::Save() const {
  State state;
  const int d = curve_->dimension();
  for (int j = 0; j < count_; ++j) {
    const double* const point = curve_->ControlPoint(first_ + j);
    state.control_points.insert(state.control_points.end(), point, point + d);
  }
  for (int k = 0; k < num_knots_; ++k)
    state.knots.push_back(curve_->Knot(curve_->Index(first_knot_ + k)));
  for (const int i : points_) {
    state.parameters.push_back(curve_->parameter(i));
    state.squared_distances.push_back(curve_->squared_distance(i));
  }
  return state;
}

void CurveWindow::Restore(const State& state) {
  const int d = curve_->dimension();
  for (int j = 0; j < count_; ++j) {
    std::copy_n(state.control_points.data() + static_cast<std::ptrdiff_t>(j) * d, d,
                curve_->MutableControlPoint(first_ + j));
  }
  for (int k = 0; k < num_knots_; ++k) {
    curve_->SetKnot(curve_->Index(first_knot_ + k), state.knots[static_cast<std::size_t>(k)]);
  }
  for (std::size_t i = 0; i < points_.size(); ++i) {
    curve_->SetFoot(points_[i], state.parameters[i], state.squared_distances[i]);
  }
}

double CurveWindow::LargestRatio() const {
  double largest = 0.0;
  for (const int i : points_) largest = std::max(largest, curve_->squared_distance(i));
  return std::max(largest / squared_bound_, Stray() / stray_limit_);
}

double CurveWindow::Raised(double ratio, int power) {
  double result = 1.0;
  int exponent = power / 2;
  for (double factor = ratio + kFloor; exponent > 0; exponent /= 2, factor *= factor) {
    if (exponent % 2 == 1) result *= factor;
  }
  return result;
}

double CurveWindow::Value(int power) const {
  double sum = 0.0;
  for (const int i : points_) {
    sum += Raised(curve_->squared_distance(i) / squared_bound_, power);
  }
  for (const Sample& sample : Samples()) sum += Raised(sample.ratio, power);
  return sum;
}

void CurveWindow::FollowPoints(const std::vector<int>& points, int iterations) {
  for (const int i : points) {
    const double t = curve_->parameter(i);
    const double low = holds_all_ ? t - 0.5 * curve_->period() : low_;
    const double high = holds_all_ ? t + 0.5 * curve_->period() : high_;
    curve_->Follow(i, iterations, low, high);
  }
}

void CurveWindow::SolveAtParameters() {
  Assemble(2, true);
  Eigen::VectorXd step;
  if (SolveDamped(1e-9, {}, &step)) Apply(step);
  FollowPoints(points_, 3);
}

bool CurveWindow::Descend(int power, int most_steps, double goal) {
  double damping = 1e-3;
  double value = Value(power);
  for (int step_number = 0; step_number < most_steps; ++step_number) {
    if (LargestRatio() <= goal) return true;
    Assemble(power, false);
    const State before = Save();
    bool lowered = false;
    double next = value;
    for (int attempt = 0; attempt < 6 && !lowered; ++attempt) {
      Eigen::VectorXd step;
      if (FindStep(damping, &step)) {
        Apply(step);
        FollowPoints(points_, 2);
        next = Value(power);
        lowered = next < value;
        if (!lowered) Restore(before);
      }
      damping = lowered ? std::max(damping * 0.2, 1e-9) : damping * 8.0;
    }
    if (!lowered) break;
    const double change = value - next;
    value = next;
    if (change < 1e-3 * value) break;
  }
  return LargestRatio() <= goal;
}

bool CurveWindow::Lower(int power, int most_steps, double goal) {
  constexpr int kMostRounds = 4;
  for (int round = 0; round < kMostRounds; ++round) {
    if (!Descend(power, most_steps, goal) && goal > 0.0) return false;
    if (!JoinPointsAbove(goal > 0.0 ? goal : LargestRatio())) return goal > 0.0;
  }
  return false;
}

}  // namespace batten
