#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "experiments/audit.h"
#include "experiments/audit_curve.h"
#include "experiments/audit_loss.h"

namespace batten {
namespace {

/// Points of the curve, equally spaced in each span that is not empty: rows of d numbers.
std::vector<double> SampleSpans(const AuditedFit& fit, int per_span, AuditCurve* curve) {
  std::vector<double> samples;
  const auto first = static_cast<std::size_t>(fit.degree);
  for (std::size_t k = first; fit.knots[k] < curve->domain_end(); ++k) {
    const double low = fit.knots[k];
    const double length = fit.knots[k + 1] - low;
    for (int s = 0; s < per_span && length > 0.0; ++s) {
      curve->MoveTo(low + length * s / per_span);
      for (int c = 0; c < fit.dimension; ++c) {
        samples.push_back(static_cast<double>(curve->Coordinate(c)));
      }
    }
  }
  curve->MoveTo(static_cast<double>(curve->domain_end()));
  for (int c = 0; c < fit.dimension; ++c) {
    samples.push_back(static_cast<double>(curve->Coordinate(c)));
  }
  return samples;
}

double NearestDistance(const std::vector<double>& samples, const double* point, int d) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t s = 0; s < samples.size(); s += static_cast<std::size_t>(d)) {
    double squared = 0.0;
    for (int c = 0; c < d; ++c) {
      const double difference = samples[s + static_cast<std::size_t>(c)] - point[c];
      squared += difference * difference;
    }
    nearest = std::min(nearest, squared);
  }
  return std::sqrt(nearest);
}

using Real = AuditCurve::Real;

/// One point compared at t: r = C(t) - Q, C' and r . C'.
struct AtParameter {
  AtParameter(const AuditedFit& fit, const double* point, double t, AuditCurve* curve) {
    curve->MoveTo(t);
    for (int c = 0; c < fit.dimension; ++c) {
      residual.push_back(curve->Coordinate(c) - point[c]);
      squared_distance += residual.back() * residual.back();
    }
    basis = curve->BasisValues();
    weights = curve->DerivativeWeights();
    for (int c = 0; c < fit.dimension; ++c) {
      Real sum = 0;
      for (int j = 1; j <= fit.degree; ++j) {
        sum += weights[j] * (Real(fit.control_points[curve->ControlPoint(j) * fit.dimension + c]) -
                             fit.control_points[curve->ControlPoint(j - 1) * fit.dimension + c]);
      }
      velocity.push_back(sum);
      slope += residual[c] * sum;
    }
  }
  std::vector<Real> residual, velocity, basis, weights;
  Real squared_distance = 0;
  Real slope = 0;
};

/// |dE/dt| |dt/dP| of one point of this weight: dt/dP_jc = -(B_j' r_c + B_j C_c') / (d slope / dt),
/// the latter by a difference.
Real RoundingOfFoot(const AuditedFit& fit, const double* point, double t, Real weight,
                    AuditCurve* curve) {
  const AtParameter here(fit, point, t, curve);
  const double step = 1e-6 * static_cast<double>(curve->domain_end() - curve->domain_begin());
  if (!fit.periodic && (t - step < curve->domain_begin() || t + step > curve->domain_end())) {
    return 0;
  }
  const Real change = (AtParameter(fit, point, t + step, curve).slope -
                       AtParameter(fit, point, t - step, curve).slope) /
                      (2 * step);
  Real squared = 0;
  for (int j = 0; j <= fit.degree; ++j) {
    const Real derivative = here.weights[j] - (j < fit.degree ? here.weights[j + 1] : 0);
    for (int c = 0; c < fit.dimension; ++c) {
      const Real entry = derivative * here.residual[c] + here.basis[j] * here.velocity[c];
      squared += entry * entry;
    }
  }
  // Where the slope hardly changes (a centre of curvature) t does not follow.
  return change > 0 ? 2 * weight * std::abs(here.slope) * std::sqrt(squared) / change : 0;
}

}  // namespace

void AuditFeet(const AuditedFit& fit, AuditReport* report) {
  // A feature of the curve narrower than 1 / 32 of a span can be overlooked.
  constexpr double kMostPerSpan = 32.0;
  constexpr double kMostComparisons = 1e9;
  // Feet are certified to 1e-12 of the larger of size and distance.
  constexpr double kAllowed = 2e-12;
  AuditCurve curve(fit);
  const auto m = static_cast<double>(fit.parameters.size());
  const double affordable = kMostComparisons / (m * curve.num_control_points());
  const auto per_span = static_cast<int>(std::clamp(affordable, 1.0, kMostPerSpan));
  const std::vector<double> samples = SampleSpans(fit, per_span, &curve);
  double largest = 0.0;
  for (const double coordinate : samples) largest = std::max(largest, std::abs(coordinate));
  for (const double coordinate : fit.points) largest = std::max(largest, std::abs(coordinate));
  for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
    const double* const point = &fit.points[i * static_cast<std::size_t>(fit.dimension)];
    const AtParameter here(fit, point, fit.parameters[i], &curve);
    const auto distance = static_cast<double>(std::sqrt(here.squared_distance));
    const Real weight = EnergyOfPoint(fit, i, here.squared_distance).largest;
    report->foot_rounding +=
        static_cast<double>(RoundingOfFoot(fit, point, fit.parameters[i], weight, &curve));
    // Of a point on the curve, to what feet are certified to, any residual may be left.
    if (distance <= kAllowed * largest) {
      report->foot_rounding += 2.0 * static_cast<double>(weight) * kAllowed * largest;
    }
    const double excess = distance - NearestDistance(samples, point, fit.dimension);
    // Written so that NaN is not lost.
    if (!(excess <= report->foot_excess)) report->foot_excess = excess;
  }
  report->foot_allowed = kAllowed * largest;
}

}  // namespace batten
