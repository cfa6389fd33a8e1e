#include "splines/bezier_conversion.h"

#include <algorithm>
#include <utility>

#include "splines/bezier_distance.h"
#include "splines/distance_piece.h"

namespace batten {
namespace {

int HighestDegree(const std::vector<BezierSpan>& spans) {
  int degree = 0;
  for (const BezierSpan& span : spans) degree = std::max(degree, span.curve.degree());
  return degree;
}

double RoundingOf(const Points& points) {
  return BezierRounding(static_cast<int>(points.rows()) - 1, static_cast<int>(points.cols()),
                        points.data());
}

/// The end of one curve is the begin of the next, to the rounding of both.
bool Meet(const Points& a, const Points& b) {
  return (a.row(a.rows() - 1) - b.row(0)).cwiseAbs().maxCoeff() <= RoundingOf(a) + RoundingOf(b);
}

/// Both sides of a joint are rounded by themselves; where the curve jumps they are left alone.
void ShareEnd(Points* points, const Points& next) {
  if (Meet(*points, next)) points->row(points->rows() - 1) = next.row(0);
}

bool CanBeJoined(const std::vector<BezierSpan>& spans, bool periodic, std::string* error) {
  if (spans.empty()) return FailWith("found no Bezier curve; allowed: one or more", error);
  const int degree = HighestDegree(spans);
  if (degree < 1 || degree > kMaxDegree) {
    return FailWith("found degree " + std::to_string(degree) +
                        "; allowed in a B-spline curve: 1 to " + std::to_string(kMaxDegree),
                    error);
  }
  for (std::size_t i = 0; i < spans.size(); ++i) {
    const bool is_last = i + 1 == spans.size();
    const BezierSpan& next = spans[is_last ? 0 : i + 1];
    if (spans[i].curve.dimension() != next.curve.dimension()) {
      return FailWith("curve " + std::to_string(i) + " has another dimension than the next", error);
    }
    if (!(spans[i].begin < spans[i].end) || (!is_last && spans[i].end != next.begin)) {
      return FailWith("the interval of curve " + std::to_string(i) + " does not lead to the next",
                      error);
    }
    if ((!is_last || periodic) &&
        !Meet(spans[i].curve.control_points(), next.curve.control_points())) {
      return FailWith("curve " + std::to_string(i) + " does not end where the next begins", error);
    }
  }
  return true;
}

/// b_0, ..., b_k p-fold; at an end p + 1 times, or going on with the period.
std::vector<double> JointKnots(const std::vector<double>& breaks, int p, bool periodic) {
  std::vector<double> knots;
  const double period = breaks.back() - breaks.front();
  knots.push_back(periodic ? breaks[breaks.size() - 2] - period : breaks.front());
  for (const double joint : breaks) knots.insert(knots.end(), p, joint);
  if (periodic) {
    knots.insert(knots.end(), p, breaks[1] + period);
  } else {
    knots.push_back(breaks.back());
  }
  return knots;
}

}  // namespace

std::vector<BezierSpan> BezierSpansOf(const BsplineCurve& curve) {
  const BsplineBasis& basis = curve.basis();
  const int p = basis.degree();
  const std::vector<double>& knots = basis.knots();
  std::vector<double> breaks = {basis.domain_begin()};
  std::vector<Points> pieces;
  for (int span = basis.first_span(); span <= basis.last_span(); ++span) {
    if (!(knots[span] < knots[span + 1])) continue;
    Points window(p + 1, curve.dimension());
    for (int j = 0; j <= p; ++j) {
      window.row(j) = curve.control_points().row(basis.ControlPointIndex(span - p + j));
    }
    pieces.push_back(window);
    BezierPoints(p, curve.dimension(), knots.data(), span, window.data(), knots[span],
                 knots[span + 1], pieces.back().data());
    breaks.push_back(knots[span + 1]);
  }
  std::vector<BezierSpan> spans;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const bool is_last = i + 1 == pieces.size();
    if (!is_last || basis.periodic()) ShareEnd(&pieces[i], pieces[is_last ? 0 : i + 1]);
    spans.push_back({BezierCurve::Make(pieces[i], nullptr).value(), breaks[i], breaks[i + 1]});
  }
  return spans;
}

std::optional<BsplineCurve> BsplineThrough(const std::vector<BezierSpan>& spans, bool periodic,
                                           std::string* error) {
  if (!CanBeJoined(spans, periodic, error)) return std::nullopt;
  const int p = HighestDegree(spans);
  const auto num_spans = static_cast<int>(spans.size());
  Points points(num_spans * p + (periodic ? 0 : 1), spans[0].curve.dimension());
  std::vector<double> breaks = {spans[0].begin};
  for (int i = 0; i < num_spans; ++i) {
    const BezierCurve raised = spans[i].curve.Raised(p - spans[i].curve.degree());
    const bool has_end = i + 1 == num_spans && !periodic;
    points.middleRows(i * p, has_end ? p + 1 : p) =
        raised.control_points().topRows(has_end ? p + 1 : p);
    breaks.push_back(spans[i].end);
  }
  std::optional<BsplineBasis> basis =
      BsplineBasis::Make(p, periodic, JointKnots(breaks, p, periodic), error);
  if (!basis) return std::nullopt;
  return BsplineCurve(std::move(*basis), std::move(points));
}

}  // namespace batten
