#include "experiments/tracked_curve.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "splines/basis_functions.h"

namespace batten {

TrackedCurve::TrackedCurve(const BsplineCurve& curve, const Points& points,
                           const Eigen::VectorXd& parameters)
    : degree_(curve.basis().degree()),
      closed_(curve.basis().periodic()),
      period_(curve.basis().domain_length()),
      knots_(curve.basis().knots()),
      control_points_(curve.control_points()),
      points_(&points),
      parameters_(parameters),
      squared_distances_(parameters.size()) {
  if (closed_) knots_.resize(static_cast<std::size_t>(control_points_.rows()));
}

void TrackedCurve::RemoveKnot(int i) {
  const int n = num_control_points();
  const int p = degree_;
  // Control point j sits near the middle of its knots U(j + 1)..U(j + p): the one of knot i goes.
  const int gone = Index(closed_ ? i - (p + 1) / 2 : std::clamp(i - (p + 1) / 2, 1, n - 2));
  if (closed_) {
    // Control points keep their places beside the knots: the indices of both are shifted alike.
    Points points(n - 1, dimension());
    std::vector<double> knots;
    const int first = i + 1;
    for (int k = 0; k < n - 1; ++k) knots.push_back(Knot(first + k));
    for (int k = 0; k < n - 1; ++k) {
      // New control point k has knots new U(k + 1)..; those before the gap keep their own.
      const int j = first + k;
      const bool after = (n - 1) - k <= (p + 1) / 2;
      for (int c = 0; c < dimension(); ++c) points(k, c) = ControlPoint(after ? j + 1 : j)[c];
    }
    knots_ = std::move(knots);
    control_points_ = std::move(points);
    return;
  }
  knots_.erase(knots_.begin() + i);
  Points points(n - 1, dimension());
  points.topRows(gone) = control_points_.topRows(gone);
  points.bottomRows(n - 1 - gone) = control_points_.bottomRows(n - 1 - gone);
  control_points_ = std::move(points);
}

void TrackedCurve::InsertKnot(double t) {
  // Boehm: new P_i = a_i P_i + (1 - a_i) P_(i-1), a_i = (t - U(i)) / (U(i + p) - U(i)), for i =
  // k-p+1..k; P_i before, P_(i-1) after.
  const int n = num_control_points();
  const int p = degree_;
  const int span = SpanOf(t);
  const int first = closed_ ? span - p + 1 : 0;
  Points points(n + 1, dimension());
  for (int j = 0; j <= n; ++j) {
    const int i = first + j;
    double share = i <= span - p ? 1.0 : 0.0;
    if (i > span - p && i <= span) share = (t - Knot(i)) / (Knot(i + p) - Knot(i));
    for (int c = 0; c < dimension(); ++c) {
      points(j, c) = (share > 0.0 ? share * ControlPoint(i)[c] : 0.0) +
                     (share < 1.0 ? (1.0 - share) * ControlPoint(i - 1)[c] : 0.0);
    }
  }
  if (closed_) {
    std::vector<double> knots;
    for (int j = 0; j <= n; ++j) {
      const int i = first + j;
      knots.push_back(i <= span ? Knot(i) : i == span + 1 ? t : Knot(i - 1));
    }
    knots_ = std::move(knots);
  } else {
    knots_.insert(knots_.begin() + span + 1, t);
  }
  control_points_ = std::move(points);
}

int TrackedCurve::SpanOf(double t) const {
  const int p = degree_;
  if (!closed_) {
    const int n = num_control_points();
    const auto end = knots_.begin() + n;
    const auto above = std::upper_bound(knots_.begin() + p + 1, end, t);
    return static_cast<int>(above - knots_.begin()) - 1;
  }
  const double turns = std::floor((t - knots_.front()) / period_);
  const auto above = std::upper_bound(knots_.begin() + 1, knots_.end(), t - turns * period_);
  const int span = static_cast<int>(above - knots_.begin()) - 1;
  return span + static_cast<int>(turns) * num_control_points();
}

void TrackedCurve::CopySpanKnots(int span, double* knots) const {
  const int first = span - degree_ + 1;
  for (int r = 0; r < 2 * degree_; ++r) knots[r] = Knot(first + r);
}

void TrackedCurve::Evaluate(int span, double t, int max_derivative, double* result) const {
  constexpr int kMost = 3;
  const int p = degree_;
  const int d = dimension();
  double knots[2 * kMaxDegree];
  double basis[kMost * kMaxOrder];
  CopySpanKnots(span, knots);
  EvaluateBasisDerivatives(p, knots, p - 1, t, max_derivative, basis);
  std::fill(result, result + (max_derivative + 1) * d, 0.0);
  for (int j = 0; j <= p; ++j) {
    const double* const control_point = ControlPoint(span - p + j);
    for (int k = 0; k <= max_derivative; ++k) {
      for (int c = 0; c < d; ++c) result[k * d + c] += basis[k * (p + 1) + j] * control_point[c];
    }
  }
}

void TrackedCurve::Follow(int point_index, int iterations, double low, double high) {
  const int d = dimension();
  const double* const q = point(point_index);
  double values[3 * kMaxDimension];
  const auto squared_distance = [&](const double* value) {
    double sum = 0.0;
    for (int c = 0; c < d; ++c) sum += (value[c] - q[c]) * (value[c] - q[c]);
    return sum;
  };
  double t = std::clamp(parameters_[point_index], low, high);
  if (!closed_ && (point_index == 0 || point_index == num_points() - 1)) {
    // An open curve ends where its data do: no tail without data.
    t = point_index == 0 ? domain_begin() : domain_end();
    iterations = 0;
  }
  Evaluate(SpanOf(t), t, 2, values);
  double best = squared_distance(values);
  for (int i = 0; i < iterations; ++i) {
    double slope = 0.0;
    double speed = 0.0;
    double bend = 0.0;
    for (int c = 0; c < d; ++c) {
      const double r = values[c] - q[c];
      slope += r * values[d + c];
      speed += values[d + c] * values[d + c];
      bend += r * values[2 * d + c];
    }
    if (!(speed > 0.0)) break;
    // Where the distance is not convex, the step to the foot on the tangent.
    double step = -slope / (speed + bend > 0.1 * speed ? speed + bend : speed);
    bool moved = false;
    for (int halving = 0; halving < 4 && !moved; ++halving, step *= 0.25) {
      const double next = std::clamp(t + step, low, high);
      if (next == t) break;
      double there[3 * kMaxDimension];
      Evaluate(SpanOf(next), next, 2, there);
      const double distance = squared_distance(there);
      if (!(distance < best)) continue;
      moved = true;
      t = next;
      best = distance;
      std::copy(there, there + 3 * d, values);
    }
    if (!moved) break;
  }
  SetFoot(point_index, t, best);
}

void TrackedCurve::FollowAll(int iterations) {
  for (int i = 0; i < num_points(); ++i) {
    const double t = parameters_[i];
    // Closed: half a turn either way.
    const double low = closed_ ? t - 0.5 * period_ : domain_begin();
    const double high = closed_ ? t + 0.5 * period_ : domain_end();
    Follow(i, iterations, low, high);
  }
}

std::vector<double> TrackedCurve::AllKnots() const {
  if (!closed_) return knots_;
  std::vector<double> knots;
  for (int i = 0; i <= num_control_points() + 2 * degree_; ++i) knots.push_back(Knot(i));
  return knots;
}

std::optional<BsplineCurve> TrackedCurve::ToCurve() const {
  auto basis = BsplineBasis::Make(degree_, closed_, AllKnots(), nullptr);
  if (!basis.has_value()) return std::nullopt;
  return BsplineCurve(*std::move(basis), control_points_);
}

}  // namespace batten
