#ifndef BATTEN_EXPERIMENTS_AUDIT_SUMS_H_
#define BATTEN_EXPERIMENTS_AUDIT_SUMS_H_

#include <vector>

#include "experiments/audit.h"
#include "experiments/audit_curve.h"

namespace batten {

/// What the audit sums up over points and terms.
struct AuditSums {
  using Real = AuditCurve::Real;
  /// Of double: half the distance from 1 to its neighbour.
  static constexpr Real kUnitRoundoff = 0x1p-53L;
  static constexpr int kMostCoordinates = 16;

  Real energy = 0;
  Real weighted_squares = 0;  // sum of (dE / d|r|^2) |r|^2, E itself without losses
  Real squared_distance = 0;
  Real largest = 0;
  Real squared_rounding = 0;      // of the residuals: sum of w delta^2, w without losses
  std::vector<Real> gradient;     // n x d
  std::vector<Real> rounding;     // its worst case, n x d
  std::vector<int> num_summands;  // of E that each control point moves, n
  int num_places = 0;             // where terms beside the points are evaluated
  // The same of free parameters, which no two points share: their squares are summed up at once.
  Real squared_slope = 0;           // of those that move
  Real squared_pull = 0;            // of those past an end that E draws back into the domain
  Real squared_slope_rounding = 0;  // of both
  std::vector<Real> around;         // of the last points, in one with the first a period on
  bool goes_around = false;
  std::vector<std::vector<Real>> slopes;  // of each block of points that share one
  std::vector<int> inward;  // of each block: the sign of moves that stay on the curve; 0: both
  // Of the points that count, per coordinate: the run rounds in coordinates from their centre, in
  // which points near the user's origin may be far out.
  Real extent[kMostCoordinates] = {};
};

/// Adds the integrals and ends of `fit`.
void AddTermsBesidePoints(const AuditedFit& fit, AuditCurve* curve, AuditSums* sums);
/// The largest coordinates of the data that the run's own, which are centred, can come from, d.
std::vector<AuditSums::Real> DataSizes(const AuditedFit& fit, const AuditSums& sums);
/// Measures equations and conditions; turns gradient and rounding of `sums` into those in the
/// control points that the run does not eliminate, entries of the others being 0.
void AuditConstraints(const AuditedFit& fit, AuditCurve* curve, AuditSums* sums,
                      AuditReport* report);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_AUDIT_SUMS_H_
