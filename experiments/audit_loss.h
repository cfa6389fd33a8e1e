#ifndef BATTEN_EXPERIMENTS_AUDIT_LOSS_H_
#define BATTEN_EXPERIMENTS_AUDIT_LOSS_H_

#include <cstddef>

#include "experiments/audit.h"

namespace batten {

/// rho(s) and rho'(s) of an AuditedLoss, s >= 0 or no number.
struct AuditedRho {
  long double value = 0;
  long double slope = 0;
};
AuditedRho EvaluateRho(const AuditedLoss& loss, long double s);

/// What a data point is worth in E: the sum over the distances of factor * rho(w |r|^2).
struct PointEnergy {
  long double energy = 0;
  long double slope = 0;    ///< dE / d|r|^2.
  long double largest = 0;  ///< The slope without losses, which no loss exceeds.
  bool has_loss = false;
};
PointEnergy EnergyOfPoint(const AuditedFit& fit, std::size_t i, long double squared_distance);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_AUDIT_LOSS_H_
