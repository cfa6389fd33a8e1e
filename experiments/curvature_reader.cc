#include "experiments/curvature_reader.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "splines/basis_functions.h"

namespace batten {

CurvatureReader::CurvatureReader(const BsplineCurve& curve)
    : curve_(curve),
      rounding_(8.0 * curve.basis().order() * std::numeric_limits<double>::epsilon() *
                std::sqrt(curve.dimension()) * curve.control_points().cwiseAbs().maxCoeff()) {}

CurvatureReader::SpanValues CurvatureReader::Evaluate(int span, double t) const {
  const BsplineBasis& basis = curve_.basis();
  double functions[(kMostDerivatives + 1) * kMaxOrder];
  EvaluateBasisDerivatives(basis.degree(), basis.knots().data(), span, t, kMostDerivatives,
                           functions);
  const Points& points = curve_.control_points();
  const int origin = basis.ControlPointIndex(span - basis.degree());
  SpanValues values;
  for (int k = 0; k <= kMostDerivatives; ++k) {
    for (int j = 0; j <= basis.degree(); ++j) {
      const double function = functions[k * basis.order() + j];
      const int point = basis.ControlPointIndex(span - basis.degree() + j);
      // From a control point near by, so that only the rounding of these is left far from 0.
      for (int c = 0; c < curve_.dimension(); ++c) {
        values.c[k][c] += function * (points(point, c) - points(origin, c));
      }
      values.error[k] += rounding_ * std::abs(function);
    }
  }
  for (int c = 0; c < curve_.dimension(); ++c) values.c[0][c] += points(origin, c);
  return values;
}

CurvatureSample CurvatureReader::Read(int span, double t, double* speed) const {
  const SpanValues values = Evaluate(span, t);
  const int d = curve_.dimension();
  CurvatureSample sample;
  sample.t = t;
  std::copy_n(values.c[0], d, sample.point);
  *speed = std::hypot(std::hypot(values.c[1][0], values.c[1][1]),
                      std::hypot(values.c[1][2], values.c[1][3]));
  const double first = values.error[1] / *speed;
  if (!(first < 1.0)) {
    sample.kappa = std::numeric_limits<double>::quiet_NaN();
    sample.noise = std::numeric_limits<double>::infinity();
    return sample;
  }
  // Over |C'|, so that products of very small lengths do not vanish.
  double tangent[kMaxDimension], second[kMaxDimension];
  double along = 0.0, length = 0.0, bend = 0.0;
  for (int k = 0; k < d; ++k) {
    tangent[k] = values.c[1][k] / *speed;
    second[k] = values.c[2][k] / *speed;
    along += tangent[k] * second[k];
    length = std::hypot(length, second[k]);
  }
  for (int k = 0; k < d; ++k) {
    sample.normal[k] = second[k] - along * tangent[k];
    bend = std::hypot(bend, sample.normal[k]);
  }
  // The cross product itself does not lose digits where the curve is nearly straight.
  sample.kappa = (d == 2 ? tangent[0] * second[1] - tangent[1] * second[0] : bend) / *speed;
  // The cross product may be off by across, |C'|^3 by a factor of slowest.
  const double across = values.error[2] / *speed * (1.0 + first) + length * first;
  const double slowest = 1.0 / ((1.0 - first) * (1.0 - first) * (1.0 - first));
  sample.noise = across * slowest / *speed + std::abs(sample.kappa) * (slowest - 1.0);
  if (std::abs(sample.kappa) <= sample.noise) {
    sample.noise += std::abs(sample.kappa);
    sample.kappa = bend = 0.0;
  }
  for (int k = 0; k < d; ++k) sample.normal[k] = bend > 0.0 ? sample.normal[k] / bend : 0.0;
  return sample;
}

double CurvatureReader::SpeedSlope(int span, double t) const {
  const SpanValues values = Evaluate(span, t);
  double slope = 0.0;
  for (int k = 0; k < curve_.dimension(); ++k) slope += values.c[1][k] * values.c[2][k];
  return slope;
}

std::vector<double> CurvatureReader::SlowPlaces(int span) const {
  // |C'|^2 has degree 2 p - 2, and so at most p - 1 minima, which are seldom nearer to each other.
  const int places = 4 * curve_.basis().order();
  const std::vector<double>& knots = curve_.basis().knots();
  const double begin = knots[static_cast<std::size_t>(span)];
  const double step = (knots[static_cast<std::size_t>(span) + 1] - begin) / places;
  std::vector<double> slow;
  double before = SpeedSlope(span, begin);
  for (int i = 1; i <= places; ++i) {
    double low = begin + (i - 1) * step, high = begin + i * step;
    const double after = SpeedSlope(span, high);
    if (before < 0.0 && after > 0.0) {
      // Until low and high are neighbours.
      for (double middle = 0.5 * (low + high); low < middle && middle < high;
           middle = 0.5 * (low + high)) {
        (SpeedSlope(span, middle) < 0.0 ? low : high) = middle;
      }
      slow.push_back(low);
    }
    before = after;
  }
  return slow;
}

double CurvatureReader::WidthAt(int span, double t) const {
  const SpanValues values = Evaluate(span, t);
  double first = 0.0, second = 0.0;
  for (int k = 0; k < curve_.dimension(); ++k) {
    first = std::hypot(first, values.c[1][k]);
    second = std::hypot(second, values.c[2][k]);
  }
  return second > 0.0 ? first / second : std::numeric_limits<double>::infinity();
}

std::vector<double> CurvatureReader::GentleBreaks(int span) const {
  constexpr double kLeastWidth = 1e-12;  // of the span: at a cusp nothing is gentle
  const std::vector<double>& knots = curve_.basis().knots();
  const double begin = knots[static_cast<std::size_t>(span)];
  const double end = knots[static_cast<std::size_t>(span) + 1];
  std::vector<double> centres = SlowPlaces(span);
  centres.insert(centres.begin(), begin);
  centres.push_back(end);
  std::vector<double> breaks = centres;
  for (std::size_t c = 0; c < centres.size(); ++c) {
    const double width = std::max(WidthAt(span, centres[c]), kLeastWidth * (end - begin));
    for (const int side : {-1, 1}) {
      if ((side < 0 && c == 0) || (side > 0 && c + 1 == centres.size())) continue;
      const double half = 0.5 * std::abs(centres[side < 0 ? c - 1 : c + 1] - centres[c]);
      double away = width;
      while (away < half) {
        breaks.push_back(centres[c] + side * away);
        away *= 2.0;
      }
    }
  }
  std::sort(breaks.begin(), breaks.end());
  breaks.erase(std::unique(breaks.begin(), breaks.end()), breaks.end());
  return breaks;
}

}  // namespace batten
