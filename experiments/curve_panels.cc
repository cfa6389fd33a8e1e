#include "experiments/curve_panels.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "splines/basis_functions.h"

namespace batten {
namespace {

/// Gauss and Legendre's rule with 4 points on [-1, 1]; the other two are mirrored.
constexpr double kNodes[] = {0.33998104358485626, 0.86113631159405258};
constexpr double kWeights[] = {0.65214515486254614, 0.34785484513745386};

constexpr double kLengthTolerance = 1e-9;  // of a panel's length, of which it is halved again
constexpr double kMostTurning = 0.05;      // of a panel's tangent, in radians
/// Of the curve's length: shorter panels are not halved again, so that cusps, at which a tangent
/// turns at once, end somewhere.
constexpr double kShortest = 1e-6;
/// Of the control polygon's length: what is shorter is noise. Control points of floating knots may
/// be many lengths of the curve away, so that by kShortest of theirs nothing would be halved.
constexpr double kNoise = 64.0 * std::numeric_limits<double>::epsilon();
constexpr int kPanelsPerSpan = 4;   // to begin with: a span may bend both ways
constexpr int kMostPanels = 40000;  // to begin with: a million spans are short enough

}  // namespace

double AngleBetween(const double* u, const double* v, int dimension) {
  double difference = 0.0;
  double sum = 0.0;
  for (int c = 0; c < dimension; ++c) {
    difference += (u[c] - v[c]) * (u[c] - v[c]);
    sum += (u[c] + v[c]) * (u[c] + v[c]);
  }
  return 2.0 * std::atan2(std::sqrt(difference), std::sqrt(sum));
}

CurvePanels::CurvePanels(const BsplineCurve& curve)
    : curve_(curve),
      dimension_(curve.dimension()),
      rounding_(16.0 * std::numeric_limits<double>::epsilon() *
                curve.control_points().cwiseAbs().maxCoeff()) {
  const BsplineBasis& basis = curve.basis();
  const Points& control_points = curve.control_points();
  const auto n = control_points.rows();
  double polygon_length = 0.0;
  for (Eigen::Index j = 1; j < n; ++j) {
    polygon_length += (control_points.row(j) - control_points.row(j - 1)).norm();
  }
  if (basis.periodic()) {
    polygon_length += (control_points.row(0) - control_points.row(n - 1)).norm();
  }
  std::vector<int> spans;
  double rough_length = 0.0;
  for (int span = basis.first_span(); span <= basis.last_span(); ++span) {
    if (!(basis.knots()[span] < basis.knots()[span + 1])) continue;
    spans.push_back(span);
    rough_length += Length(span, basis.knots()[span], basis.knots()[span + 1]);
  }
  shortest_ = std::max(kShortest * rough_length, kNoise * polygon_length);
  const int most = std::clamp(kMostPanels / basis.num_domain_spans(), 1, kPanelsPerSpan);
  for (const int span : spans) AddSpan(span, basis.degree() == 1 ? 1 : most);
}

void CurvePanels::AddSpan(int span, int num_panels) {
  const double begin = curve_.basis().knots()[span];
  const double end = curve_.basis().knots()[span + 1];
  Panel panel;
  panel.span = span;
  panel.end = begin;
  for (int k = 1; k <= num_panels; ++k) {
    panel.begin = panel.end;
    panel.end = k == num_panels ? end : begin + (end - begin) * k / num_panels;
    if (panel.begin < panel.end) Split(panel);
  }
}

void CurvePanels::Split(const Panel& whole) {
  const double middle = whole.begin + 0.5 * (whole.end - whole.begin);
  Panel left = whole;
  Panel right = whole;
  left.end = right.begin = middle;
  const double length =
      Length(whole.span, whole.begin, middle) + Length(whole.span, middle, whole.end);
  const double roughly = Length(whole.span, whole.begin, whole.end);
  const bool can_split = whole.begin < middle && middle < whole.end;
  // Written so that what is not finite is not halved.
  const bool is_long = length > shortest_;
  const bool is_inexact = std::abs(roughly - length) > kLengthTolerance * length;
  if (can_split && is_long && (is_inexact || !IsStraight(whole))) {
    Split(left);
    Split(right);
    return;
  }
  const double before = panels_.empty() ? 0.0 : this->length();
  panels_.push_back({whole.span, whole.begin, whole.end, length, before});
}

bool CurvePanels::IsStraight(const Panel& panel) const {
  double tangents[2][kMaxDimension];
  double* last = nullptr;
  double turning = 0.0;
  int next = 0;
  const double middle = panel.begin + 0.5 * (panel.end - panel.begin);
  for (const double t : {panel.begin, middle, panel.end}) {
    double* const tangent = tangents[next];
    if (!Tangent(panel, t, tangent)) continue;
    if (last != nullptr) turning += AngleBetween(last, tangent, dimension_);
    last = tangent;
    next = 1 - next;
  }
  return turning <= kMostTurning;
}

double CurvePanels::LengthUpTo(double t) const {
  const auto above = std::upper_bound(panels_.begin(), panels_.end(), t,
                                      [](double value, const Panel& p) { return value < p.begin; });
  const Panel& panel = above == panels_.begin() ? panels_.front() : *(above - 1);
  if (t >= panel.end) return panel.before + panel.length;
  return panel.before + std::min(Length(panel.span, panel.begin, t), panel.length);
}

void CurvePanels::Evaluate(int span, double t, int k, double* result) const {
  const BsplineBasis& basis = curve_.basis();
  double values[2 * kMaxOrder];
  EvaluateBasisDerivatives(basis.degree(), basis.knots().data(), span, t, k, values);
  const double* const row = values + k * basis.order();
  // From a control point near by, as basis functions add up to 1: far from the origin rounding
  // would else be all that small curves have, and C' would be noise to be cut up without end.
  const double* const origin = ControlPoint(span, 0);
  for (int c = 0; c < dimension_; ++c) {
    double sum = 0.0;
    for (int j = 1; j <= basis.degree(); ++j) {
      sum += row[j] * (ControlPoint(span, j)[c] - origin[c]);
    }
    result[c] = k == 0 ? origin[c] + sum : sum;
  }
}

const double* CurvePanels::ControlPoint(int span, int j) const {
  const BsplineBasis& basis = curve_.basis();
  const Eigen::Index index = basis.ControlPointIndex(span - basis.degree() + j);
  return curve_.control_points().data() + index * dimension_;
}

double CurvePanels::SpeedNoise(int span) const {
  // C' is a mean of the p (P_j - P_(j-1)) / (u_(j+p) - u_j). At a cusp it is a sum of p terms of
  // opposite sign, none larger than the largest of these times p. The control points themselves are
  // known to some roundings of their coordinates: far from the origin, or where the curve is but a
  // point, these are all that the differences are.
  constexpr double kRoundings = 16.0 * kMaxDegree * std::numeric_limits<double>::epsilon();
  const BsplineBasis& basis = curve_.basis();
  const int p = basis.degree();
  double top = 0.0;
  for (int j = 1; j <= p; ++j) {
    const int i = span - p + j;
    double squared = 0.0;
    for (int c = 0; c < dimension_; ++c) {
      const double step = ControlPoint(span, j)[c] - ControlPoint(span, j - 1)[c];
      squared += step * step;
    }
    const double noise = kRoundings * std::sqrt(squared) + rounding_;
    top = std::max(top, p * noise / (basis.knots()[i + p] - basis.knots()[i]));
  }
  return top;
}

bool CurvePanels::UnitDerivative(int span, double t, double* result) const {
  Evaluate(span, t, 1, result);
  double squared = 0.0;
  for (int c = 0; c < dimension_; ++c) squared += result[c] * result[c];
  const double speed = std::sqrt(squared);
  if (!(speed > SpeedNoise(span))) return false;
  for (int c = 0; c < dimension_; ++c) result[c] /= speed;
  return true;
}

bool CurvePanels::Tangent(const Panel& panel, double t, double* result) const {
  constexpr double kBeside = 1e-6;
  if (UnitDerivative(panel.span, t, result)) return true;
  const double middle = panel.begin + 0.5 * (panel.end - panel.begin);
  return UnitDerivative(panel.span, t + kBeside * (middle - t), result);
}

double CurvePanels::Speed(int span, double t) const {
  double derivative[kMaxDimension];
  Evaluate(span, t, 1, derivative);
  double squared = 0.0;
  for (int c = 0; c < dimension_; ++c) squared += derivative[c] * derivative[c];
  return std::sqrt(squared);
}

double CurvePanels::Length(int span, double begin, double end) const {
  const double half = 0.5 * (end - begin);
  const double middle = begin + half;
  double sum = 0.0;
  for (int k = 0; k < 2; ++k) {
    sum += kWeights[k] *
           (Speed(span, middle - half * kNodes[k]) + Speed(span, middle + half * kNodes[k]));
  }
  return half * sum;
}

}  // namespace batten
