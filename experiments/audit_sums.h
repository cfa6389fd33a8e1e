#ifndef BATTEN_EXPERIMENTS_AUDIT_SUMS_H_
#define BATTEN_EXPERIMENTS_AUDIT_SUMS_H_

#include <glog/logging.h>

#include <cmath>
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

/// visit(begin, length, factor) for every span of the domain that is not empty: `factor` times that
/// one's own, of which there are none or as many as spans.
template <typename Visitor>
void VisitSpans(const AuditedFit& fit, const AuditCurve& curve, AuditSums::Real factor,
                const std::vector<double>& span_factors, const Visitor& visit) {
  std::size_t num_spans = 0;
  for (auto s = static_cast<std::size_t>(fit.degree); fit.knots[s] < curve.domain_end(); ++s) {
    const AuditSums::Real begin = fit.knots[s];
    const AuditSums::Real length = fit.knots[s + 1] - begin;
    if (!(length > 0)) continue;
    visit(begin, length, span_factors.empty() ? factor : factor * span_factors.at(num_spans));
    ++num_spans;
  }
  CHECK(span_factors.empty() || span_factors.size() == num_spans);
}

/// By this part of a span the run moves the nodes in it, which it rounds to double.
inline AuditSums::Real NodeRounding(AuditSums::Real begin, AuditSums::Real length) {
  return (std::abs(begin) + length) / length;
}

/// Adds a bending of `fit`; `data_sizes` as DataSizes().
void AddBending(const AuditedFit& fit, const AuditedBending& bending,
                const std::vector<AuditSums::Real>& data_sizes, AuditCurve* curve, AuditSums* sums);
/// Adds the integrals, bendings and ends of `fit`.
void AddTermsBesidePoints(const AuditedFit& fit, AuditCurve* curve, AuditSums* sums);
/// The largest coordinates of the data that the run's own, which are centred, can come from, d.
std::vector<AuditSums::Real> DataSizes(const AuditedFit& fit, const AuditSums& sums);
/// Measures equations and conditions; turns gradient and rounding of `sums` into those in the
/// control points that the run does not eliminate, entries of the others being 0.
void AuditConstraints(const AuditedFit& fit, AuditCurve* curve, AuditSums* sums,
                      AuditReport* report);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_AUDIT_SUMS_H_
