#include "experiments/curve_fairness.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "splines/basis_functions.h"
#include "splines/gauss_legendre.h"

namespace batten {
namespace {

constexpr int kMostDerivatives = 2;

/// C, C', C'' and by how much the lengths of these may be off.
struct SpanValues {
  double c[kMostDerivatives + 1][kMaxDimension] = {};
  double error[kMostDerivatives + 1] = {};
};

/// Reads curvature and how much of it may be rounding. A basis function has some 2 p roundings, the
/// product and the sum p + 1: fewer than 4 (p + 1), of the largest control point, for each
/// coordinate; the solution that control points come from is granted as many.
class CurvatureReader {
 public:
  explicit CurvatureReader(const BsplineCurve& curve)
      : curve_(curve),
        rounding_(8.0 * curve.basis().order() * std::numeric_limits<double>::epsilon() *
                  std::sqrt(curve.dimension()) * curve.control_points().cwiseAbs().maxCoeff()) {}

  /// By the polynomials of one span, also at its right end.
  CurvatureSample Read(int span, double t, double* speed) const;

 private:
  SpanValues Evaluate(int span, double t) const;

  const BsplineCurve& curve_;
  double rounding_;
};

SpanValues CurvatureReader::Evaluate(int span, double t) const {
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

/// Turns of the curvature, each between samples of which it is certain that one is higher.
class TurnCounter {
 public:
  /// Besides noise, samples count as uncertain by this part of themselves.
  explicit TurnCounter(double relative) : relative_(relative) {}

  void Add(const CurvatureSample& sample) {
    if (!std::isfinite(sample.kappa)) return;
    if (!has_value_) low_ = high_ = sample;
    has_value_ = true;
    if (Top(sample) < Top(low_)) low_ = sample;
    if (Bottom(sample) > Bottom(high_)) high_ = sample;
    if (direction_ <= 0 && Bottom(sample) > Top(low_)) Turn(1, low_, sample);
    if (direction_ >= 0 && Top(sample) < Bottom(high_)) Turn(-1, high_, sample);
  }
  /// All were added. Those of a closed curve began at its highest sample, and ended there.
  void Finish(bool is_closed) {
    if (direction_ == 0) return;
    const CurvatureSample& last = direction_ > 0 ? high_ : low_;
    variation_ += std::abs(last.kappa - extremum_.kappa);
    if (is_closed) turns_.push_back({last.t, last.kappa});
  }
  double variation() const { return variation_; }
  std::vector<CurvaturePlace>* turns() { return &turns_; }

 private:
  double Uncertain(const CurvatureSample& sample) const {
    return sample.noise + relative_ * std::abs(sample.kappa);
  }
  double Top(const CurvatureSample& sample) const { return sample.kappa + Uncertain(sample); }
  double Bottom(const CurvatureSample& sample) const { return sample.kappa - Uncertain(sample); }
  void Turn(int direction, CurvatureSample extremum, const CurvatureSample& sample) {
    if (direction_ != 0) {
      turns_.push_back({extremum.t, extremum.kappa});
      variation_ += std::abs(extremum.kappa - extremum_.kappa);
    }
    direction_ = direction;
    extremum_ = extremum;
    low_ = high_ = sample;
  }

  double relative_;
  bool has_value_ = false;
  CurvatureSample low_;
  CurvatureSample high_;
  CurvatureSample extremum_;  // the last one, or the begin
  int direction_ = 0;
  double variation_ = 0.0;
  std::vector<CurvaturePlace> turns_;
};

TurnCounter CountTurns(const std::vector<CurvatureSample>& samples, bool is_closed,
                       double relative) {
  TurnCounter counter(relative);
  std::size_t begin = 0;
  for (std::size_t i = 0; is_closed && i < samples.size(); ++i) {
    const double here = samples[i].kappa - samples[i].noise;
    if (!(here <= samples[begin].kappa - samples[begin].noise)) {
      if (std::isfinite(here)) begin = i;
    }
  }
  for (std::size_t i = 0; i < samples.size(); ++i) {
    counter.Add(samples[(begin + i) % samples.size()]);
  }
  if (is_closed) counter.Add(samples[begin]);
  counter.Finish(is_closed);
  return counter;
}

std::vector<double> SignChanges(const std::vector<CurvatureSample>& samples,
                                const BsplineBasis& basis) {
  std::vector<double> changes;
  const CurvatureSample* first = nullptr;  // that have a sign
  const CurvatureSample* last = nullptr;
  const auto add = [&](const CurvatureSample& next, double t) {
    if ((last->kappa > 0.0) == (next.kappa > 0.0)) return;
    const double share = last->kappa / (last->kappa - next.kappa);
    changes.push_back(basis.Wrap(last->t + share * (t - last->t)));
  };
  for (const CurvatureSample& sample : samples) {
    if (!(std::abs(sample.kappa) > 0.0)) continue;
    if (first == nullptr) first = &sample;
    if (last != nullptr) add(sample, sample.t);
    last = &sample;
  }
  if (basis.periodic() && last != nullptr) {
    add(*first, first->t + basis.domain_end() - basis.domain_begin());
  }
  std::sort(changes.begin(), changes.end());
  return changes;
}

template <typename Place>
void KeepTheFirst(std::vector<Place>* places) {
  const auto most = static_cast<std::size_t>(CurveFairness::kMostPlaces);
  if (places->size() > most) places->resize(most);
}

int NumSpans(const BsplineBasis& basis) {
  int count = 0;
  for (int span = basis.first_span(); span <= basis.last_span(); ++span) {
    const auto k = static_cast<std::size_t>(span);
    if (basis.knots()[k] < basis.knots()[k + 1]) ++count;
  }
  return count;
}

/// Eight Gauss points a span: kappa^2 |C'| is no polynomial, but smooth there.
double BendingEnergy(const BsplineCurve& curve) {
  constexpr int kPoints = 8;
  const GaussRule rule = GaussLegendreRule(kPoints);
  const BsplineBasis& basis = curve.basis();
  const CurvatureReader reader(curve);
  double energy = 0.0;
  for (int span = basis.first_span(); span <= basis.last_span(); ++span) {
    const double begin = basis.knots()[static_cast<std::size_t>(span)];
    const double length = basis.knots()[static_cast<std::size_t>(span) + 1] - begin;
    for (int g = 0; g < kPoints && length > 0.0; ++g) {
      const auto k = static_cast<std::size_t>(g);
      double speed = 0.0;
      const CurvatureSample sample =
          reader.Read(span, begin + 0.5 * (1.0 + rule.nodes[k]) * length, &speed);
      if (!std::isfinite(sample.kappa)) continue;
      energy += 0.5 * length * rule.weights[k] * sample.kappa * sample.kappa * speed;
    }
  }
  return energy;
}

}  // namespace

std::vector<CurvatureSample> SampleCurvature(const BsplineCurve& curve, int per_span) {
  const BsplineBasis& basis = curve.basis();
  const CurvatureReader reader(curve);
  std::vector<CurvatureSample> samples;
  double s = 0.0;
  for (int span = basis.first_span(); span <= basis.last_span(); ++span) {
    const double begin = basis.knots()[static_cast<std::size_t>(span)];
    const double end = basis.knots()[static_cast<std::size_t>(span) + 1];
    if (!(begin < end)) continue;
    double before = 0.0;
    const double step = (end - begin) / per_span;
    for (int i = 0; i <= per_span; ++i) {
      const double t = i == per_span ? end : begin + i * step;
      double speed = 0.0;
      CurvatureSample sample = reader.Read(span, t, &speed);
      if (i > 0) {
        // Simpson's rule for the arc.
        double middle = 0.0;
        reader.Read(span, t - 0.5 * step, &middle);
        s += step / 6.0 * (before + 4.0 * middle + speed);
      }
      sample.s = s;
      samples.push_back(sample);
      before = speed;
    }
  }
  return samples;
}

std::vector<CurvatureSample> SampleCurvatureUpTo(const BsplineCurve& curve, int most) {
  constexpr int kMostPerSpan = 24;
  const int spans = std::max(1, NumSpans(curve.basis()));
  std::vector<CurvatureSample> samples =
      SampleCurvature(curve, std::clamp(most / spans - 1, 1, kMostPerSpan));
  const std::size_t size = samples.size(), kept = static_cast<std::size_t>(most);
  if (size <= kept) return samples;
  for (std::size_t i = 0; i < kept; ++i) samples[i] = samples[i * (size - 1) / (kept - 1)];
  samples.resize(kept);
  return samples;
}

CurveFairness MeasureFairness(const BsplineCurve& curve) {
  constexpr int kMostSamples = 2'000'000;
  constexpr double kOfCurvature = 0.5e-6;  // of either sample that is compared
  const BsplineBasis& basis = curve.basis();
  const int per_span = std::clamp(kMostSamples / std::max(1, NumSpans(basis)), 4, 32);
  const std::vector<CurvatureSample> samples = SampleCurvature(curve, per_span);
  CurveFairness fairness;
  fairness.bending_energy = BendingEnergy(curve);
  for (const CurvatureSample& sample : samples) {
    if (!(std::abs(sample.kappa) > fairness.max_curvature)) continue;
    fairness.max_curvature = std::abs(sample.kappa);
    fairness.max_curvature_at = sample.t;
  }
  fairness.curvature_variation = CountTurns(samples, basis.periodic(), 0.0).variation();
  std::vector<CurvaturePlace> turns =
      std::move(*CountTurns(samples, basis.periodic(), kOfCurvature).turns());
  std::sort(turns.begin(), turns.end(),
            [](const CurvaturePlace& a, const CurvaturePlace& b) { return a.t < b.t; });
  fairness.num_curvature_extrema = static_cast<int>(turns.size());
  KeepTheFirst(&turns);
  fairness.curvature_extrema = std::move(turns);
  if (curve.dimension() == 2) {
    fairness.inflections = SignChanges(samples, basis);
    fairness.num_inflections = static_cast<int>(fairness.inflections.size());
    KeepTheFirst(&fairness.inflections);
  }
  return fairness;
}

}  // namespace batten
