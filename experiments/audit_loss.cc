#include "experiments/audit_loss.h"

#include <cmath>

namespace batten {

// Small s keep their digits: no difference of nearly equal numbers is taken.
AuditedRho EvaluateRho(const AuditedLoss& loss, long double s) {
  const long double b = static_cast<long double>(loss.scale) * loss.scale;
  // No number stays none, which a loss that is flat far out would make one of.
  if (!std::isfinite(s)) return {s, 1};
  switch (loss.kind) {
    case AuditedLoss::Kind::kNone:
      break;
    case AuditedLoss::Kind::kHuber:
      if (s > b) return {2 * std::sqrt(b * s) - b, std::sqrt(b / s)};
      break;
    case AuditedLoss::Kind::kCauchy:
      return {b * std::log1p(s / b), b / (b + s)};
    case AuditedLoss::Kind::kTukey: {
      if (s > b) return {b / 3, 0};
      const long double rest = 1 - s / b;
      return {s * (1 + rest + rest * rest) / 3, rest * rest};
    }
    case AuditedLoss::Kind::kSoftL1: {
      const long double root = std::sqrt(1 + s / b);
      return {2 * s / (root + 1), 1 / root};
    }
  }
  return {s, 1};
}

PointEnergy EnergyOfPoint(const AuditedFit& fit, std::size_t i, long double squared_distance) {
  const long double weight = fit.weights.empty() ? 1.0 : fit.weights[i];
  PointEnergy point;
  for (const AuditedDistance& distance : fit.distances) {
    const AuditedRho rho = EvaluateRho(distance.loss, weight * squared_distance);
    point.energy += distance.factor * rho.value;
    point.slope += distance.factor * weight * rho.slope;
    point.largest += distance.factor * weight;
    point.has_loss = point.has_loss || distance.loss.kind != AuditedLoss::Kind::kNone;
  }
  return point;
}

}  // namespace batten
