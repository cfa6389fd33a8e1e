#include "experiments/curve_fairness.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "splines/gauss_legendre.h"

namespace batten {
namespace {

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

/// Eight Gauss points between two breaks: kappa^2 |C'| is no polynomial, but smooth there.
double BendingEnergy(const CurvatureReader& reader, int span, const std::vector<double>& breaks) {
  constexpr int kPoints = 8;
  static const GaussRule kRule = GaussLegendreRule(kPoints);
  double energy = 0.0;
  for (std::size_t b = 1; b < breaks.size(); ++b) {
    const double length = breaks[b] - breaks[b - 1];
    for (std::size_t k = 0; k < kPoints; ++k) {
      double speed = 0.0;
      const CurvatureSample sample =
          reader.Read(span, breaks[b - 1] + 0.5 * (1.0 + kRule.nodes[k]) * length, &speed);
      if (!std::isfinite(sample.kappa)) continue;
      energy += 0.5 * length * kRule.weights[k] * sample.kappa * sample.kappa * speed;
    }
  }
  return energy;
}

/// What MeasureFairness reads: samples, of each its span, and the bending energy.
struct GentleSamples {
  GentleSamples(const CurvatureReader& reader, const BsplineBasis& basis) {
    constexpr int kMostSamples = 2'000'000;
    const int per_span = std::clamp(kMostSamples / std::max(1, NumSpans(basis)), 4, 32);
    for (int span = basis.first_span(); span <= basis.last_span(); ++span) {
      const auto k = static_cast<std::size_t>(span);
      if (!(basis.knots()[k] < basis.knots()[k + 1])) continue;
      const std::vector<double> breaks = reader.GentleBreaks(span);
      bending_energy += BendingEnergy(reader, span, breaks);
      AddSamples(reader, span, breaks, per_span);
    }
  }
  void AddSamples(const CurvatureReader& reader, int span, const std::vector<double>& breaks,
                  int per_span) {
    const int least = per_span == 32 ? 4 : 1;  // between two breaks
    const double whole = breaks.back() - breaks.front();
    for (std::size_t b = 1; b < breaks.size(); ++b) {
      const double length = breaks[b] - breaks[b - 1];
      const int count =
          std::clamp(static_cast<int>(std::ceil(per_span * length / whole)), least, per_span);
      for (int i = b == 1 ? 0 : 1; i <= count; ++i) {
        double speed = 0.0;
        const double t = i == count ? breaks[b] : breaks[b - 1] + i * length / count;
        samples.push_back(reader.Read(span, t, &speed));
        spans.push_back(span);
      }
    }
  }
  std::vector<CurvatureSample> samples;
  std::vector<int> spans;
  double bending_energy = 0.0;
};

/// The largest |kappa|: of the samples, and between the neighbours of that one by golden sections.
void FindLargest(const CurvatureReader& reader, const GentleSamples& all, CurveFairness* fairness) {
  std::size_t largest = all.samples.size();
  for (std::size_t i = 0; i < all.samples.size(); ++i) {
    if (!(std::abs(all.samples[i].kappa) > fairness->max_curvature)) continue;
    largest = i;
    fairness->max_curvature = std::abs(all.samples[i].kappa);
    fairness->max_curvature_at = all.samples[i].t;
  }
  if (largest == all.samples.size()) return;
  const int span = all.spans[largest];
  const auto neighbour = [&](std::size_t i) {
    return i < all.samples.size() && all.spans[i] == span ? all.samples[i].t
                                                          : all.samples[largest].t;
  };
  double low = neighbour(largest - 1), high = neighbour(largest + 1);
  constexpr int kSections = 30;  // 1e-6 of the way between samples
  constexpr double kGolden = 0.6180339887498949;
  for (int section = 0; section < kSections && low < high; ++section) {
    const double places[] = {high - kGolden * (high - low), low + kGolden * (high - low)};
    double sizes[2];
    for (int k = 0; k < 2; ++k) {
      double speed = 0.0;
      sizes[k] = std::abs(reader.Read(span, places[k], &speed).kappa);
      if (!(sizes[k] > fairness->max_curvature)) continue;
      fairness->max_curvature = sizes[k];
      fairness->max_curvature_at = places[k];
    }
    (sizes[0] < sizes[1] ? low : high) = places[sizes[0] < sizes[1] ? 0 : 1];
  }
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
    std::vector<double> places;
    for (int i = 0; i <= per_span; ++i) places.push_back(i == per_span ? end : begin + i * step);
    for (const double slow : reader.SlowPlaces(span)) {
      if (reader.WidthAt(span, slow) < step) places.push_back(slow);
    }
    std::sort(places.begin(), places.end());
    for (std::size_t i = 0; i < places.size(); ++i) {
      double speed = 0.0;
      CurvatureSample sample = reader.Read(span, places[i], &speed);
      if (i > 0) {
        // Simpson's rule for the arc.
        const double length = places[i] - places[i - 1];
        double middle = 0.0;
        reader.Read(span, places[i] - 0.5 * length, &middle);
        s += length / 6.0 * (before + 4.0 * middle + speed);
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
  const std::size_t size = samples.size();
  const auto steps = static_cast<std::size_t>(std::max(most - 1, 1));
  if (size <= steps + 1) return samples;
  for (std::size_t i = 0; i <= steps; ++i) samples[i] = samples[i * (size - 1) / steps];
  samples.resize(steps + 1);
  return samples;
}

CurveFairness MeasureFairness(const BsplineCurve& curve) {
  constexpr double kOfCurvature = 0.5e-6;  // of either sample that is compared
  const BsplineBasis& basis = curve.basis();
  const CurvatureReader reader(curve);
  const GentleSamples all(reader, basis);
  const std::vector<CurvatureSample>& samples = all.samples;
  CurveFairness fairness;
  fairness.bending_energy = all.bending_energy;
  FindLargest(reader, all, &fairness);
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
