#ifndef BATTEN_TESTS_EXPERIMENTS_BEZIER_SEGMENT_H_
#define BATTEN_TESTS_EXPERIMENTS_BEZIER_SEGMENT_H_

#include "experiments/audit.h"
#include "tests/roundoff.h"

namespace batten {

/// The audit computes in long double and rounds once; the expected values have a few roundings
/// more.
inline constexpr double kFewRoundings = 8 * kEpsilon;

/// One cubic Bezier segment, no data: P = (0, 0), (1, 2), (3, 3), (4, 0), so that
/// C(1/2) = (P0 + 3 P1 + 3 P2 + P3) / 8 = (2, 15/8), C' = (9/2, 3/4), C'' = (0, -15).
inline AuditedFit BezierSegment() {
  AuditedFit fit;
  fit.degree = 3;
  fit.dimension = 2;
  fit.knots = {0, 0, 0, 0, 1, 1, 1, 1};
  fit.control_points = {0, 0, 1, 2, 3, 3, 4, 0};
  return fit;
}

/// The same beside the point (2, 2) at t = 1/2.
inline AuditedFit BezierSegmentAndPoint() {
  AuditedFit fit = BezierSegment();
  fit.points = {2, 2};
  fit.parameters = {0.5};
  return fit;
}

}  // namespace batten

#endif  // BATTEN_TESTS_EXPERIMENTS_BEZIER_SEGMENT_H_
