#include "experiments/curve_fairness.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "splines/basis_functions.h"
#include "splines/gauss_legendre.h"

namespace batten {
namespace {

constexpr int kMostDerivatives = 2;

/// C, C', C'' at t by the polynomials of one span, also at its right end.
void EvaluateInSpan(const BsplineCurve& curve, int span, double t,
                    double values[kMostDerivatives + 1][kMaxDimension]) {
  const BsplineBasis& basis = curve.basis();
  double functions[(kMostDerivatives + 1) * kMaxOrder];
  EvaluateBasisDerivatives(basis.degree(), basis.knots().data(), span, t, kMostDerivatives,
                           functions);
  for (int k = 0; k <= kMostDerivatives; ++k) {
    for (int c = 0; c < kMaxDimension; ++c) values[k][c] = 0.0;
    for (int j = 0; j <= basis.degree(); ++j) {
      const int point = basis.ControlPointIndex(span - basis.degree() + j);
      for (int c = 0; c < curve.dimension(); ++c) {
        values[k][c] += functions[k * basis.order() + j] * curve.control_points()(point, c);
      }
    }
  }
}

CurvatureSample MakeSample(const BsplineCurve& curve, int span, double t, double* speed) {
  double c[kMostDerivatives + 1][kMaxDimension];
  EvaluateInSpan(curve, span, t, c);
  const int d = curve.dimension();
  double squared_speed = 0.0, along = 0.0;
  for (int k = 0; k < d; ++k) {
    squared_speed += c[1][k] * c[1][k];
    along += c[1][k] * c[2][k];
  }
  CurvatureSample sample;
  sample.t = t;
  *speed = std::sqrt(squared_speed);
  double bend = 0.0;  // squared norm of C'' across C'
  for (int k = 0; k < d; ++k) {
    sample.point[k] = c[0][k];
    sample.normal[k] = c[2][k] - along / squared_speed * c[1][k];
    bend += sample.normal[k] * sample.normal[k];
  }
  bend = std::sqrt(bend);
  for (int k = 0; k < d && bend > 0.0; ++k) sample.normal[k] /= bend;
  sample.kappa = bend / squared_speed;
  if (d == 2) {
    // The cross product itself, which does not lose digits where the curve is nearly straight.
    sample.kappa = (c[1][0] * c[2][1] - c[1][1] * c[2][0]) / (squared_speed * *speed);
  }
  return sample;
}

/// Counts events along the curve and keeps the places of the first ones.
class PlaceList {
 public:
  void Add(double t) {
    if (count_++ < CurveFairness::kMostPlaces) places.push_back(t);
  }
  int count() const { return count_; }
  std::vector<double> places;

 private:
  int count_ = 0;
};

/// Turns of a sequence that go back by more than a threshold.
class TurnCounter {
 public:
  explicit TurnCounter(double threshold) : threshold_(threshold) {}
  void Add(const CurvatureSample& sample) {
    const double value = sample.kappa;
    if (!has_value_) low_ = high_ = sample;
    has_value_ = true;
    if (value < low_.kappa) low_ = sample;
    if (value > high_.kappa) high_ = sample;
    if (direction_ <= 0 && value > low_.kappa + threshold_) Turn(1, low_.t, sample);
    if (direction_ >= 0 && value < high_.kappa - threshold_) Turn(-1, high_.t, sample);
  }
  PlaceList turns;

 private:
  void Turn(int direction, double extremum, const CurvatureSample& sample) {
    if (direction_ != 0) turns.Add(extremum);
    direction_ = direction;
    low_ = high_ = sample;
  }

  double threshold_;
  bool has_value_ = false;
  CurvatureSample low_;
  CurvatureSample high_;
  int direction_ = 0;
};

PlaceList SignChanges(const std::vector<CurvatureSample>& samples, double threshold) {
  PlaceList changes;
  const CurvatureSample* last = nullptr;  // the last one that has a sign
  for (const CurvatureSample& sample : samples) {
    if (!(std::abs(sample.kappa) > threshold)) continue;
    if (last != nullptr && (last->kappa > 0.0) != (sample.kappa > 0.0)) {
      const double share = last->kappa / (last->kappa - sample.kappa);
      changes.Add(last->t + share * (sample.t - last->t));
    }
    last = &sample;
  }
  return changes;
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
  double energy = 0.0;
  for (int span = basis.first_span(); span <= basis.last_span(); ++span) {
    const double begin = basis.knots()[static_cast<std::size_t>(span)];
    const double length = basis.knots()[static_cast<std::size_t>(span) + 1] - begin;
    for (int g = 0; g < kPoints && length > 0.0; ++g) {
      const auto k = static_cast<std::size_t>(g);
      double speed = 0.0;
      const CurvatureSample sample =
          MakeSample(curve, span, begin + 0.5 * (1.0 + rule.nodes[k]) * length, &speed);
      energy += 0.5 * length * rule.weights[k] * sample.kappa * sample.kappa * speed;
    }
  }
  return energy;
}

}  // namespace

std::vector<CurvatureSample> SampleCurvature(const BsplineCurve& curve, int per_span) {
  const BsplineBasis& basis = curve.basis();
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
      CurvatureSample sample = MakeSample(curve, span, t, &speed);
      if (i > 0) {
        // Simpson's rule for the arc.
        double middle = 0.0;
        MakeSample(curve, span, t - 0.5 * step, &middle);
        s += step / 6.0 * (before + 4.0 * middle + speed);
      }
      sample.s = s;
      samples.push_back(sample);
      before = speed;
    }
  }
  return samples;
}

CurveFairness MeasureFairness(const BsplineCurve& curve) {
  constexpr int kMostSamples = 2'000'000;
  const int per_span = std::clamp(kMostSamples / std::max(1, NumSpans(curve.basis())), 4, 32);
  const std::vector<CurvatureSample> samples = SampleCurvature(curve, per_span);
  CurveFairness fairness;
  fairness.bending_energy = BendingEnergy(curve);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double size = std::abs(samples[i].kappa);
    if (!(size <= fairness.max_curvature)) {
      fairness.max_curvature = size;
      fairness.max_curvature_at = samples[i].t;
    }
    if (i > 0) fairness.curvature_variation += std::abs(samples[i].kappa - samples[i - 1].kappa);
  }
  if (curve.basis().periodic()) {
    fairness.curvature_variation += std::abs(samples.front().kappa - samples.back().kappa);
  }
  const double threshold = 1e-6 * fairness.max_curvature;
  TurnCounter counter(threshold);
  for (const CurvatureSample& sample : samples) counter.Add(sample);
  fairness.num_curvature_extrema = counter.turns.count();
  fairness.curvature_extrema = std::move(counter.turns.places);
  if (curve.dimension() == 2) {
    PlaceList changes = SignChanges(samples, threshold);
    fairness.num_inflections = changes.count();
    fairness.inflections = std::move(changes.places);
  }
  return fairness;
}

}  // namespace batten
