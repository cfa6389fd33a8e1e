#include "experiments/audit.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "experiments/audit_curve.h"
#include "experiments/audit_sums.h"

namespace batten {
namespace {

using Real = AuditCurve::Real;
using Sums = AuditSums;
constexpr int kMostCoordinates = AuditSums::kMostCoordinates;
constexpr Real kUnitRoundoff = AuditSums::kUnitRoundoff;

/// Root of |v|^2 + more_squares, without overflow where single squares do not overflow in long
/// double.
double Norm(const std::vector<Real>& v, Real more_squares) {
  Real sum = more_squares;
  for (const Real value : v) sum += value * value;
  return static_cast<double>(std::sqrt(sum));
}

void MeasureExtent(const AuditedFit& fit, Sums* sums) {
  for (int c = 0; c < fit.dimension; ++c) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
      if (!fit.weights.empty() && fit.weights[i] == 0.0) continue;
      low = std::min(low, fit.points[i * fit.dimension + c]);
      high = std::max(high, fit.points[i * fit.dimension + c]);
    }
    if (low < high) sums->extent[c] = static_cast<Real>(high) - low;
  }
}

/// One data point where the curve now is.
struct Residual {
  Real weight = 1;
  Real value[kMostCoordinates];  // C(t) - Q
  Real data[kMostCoordinates];   // size of the data, the centre of the run's coordinates included
  Real size[kMostCoordinates];   // what one rounding of all numbers in `value` is relative to
};

Residual MeasureResidual(const AuditedFit& fit, int i, const Sums& sums, AuditCurve* curve) {
  const int d = fit.dimension;
  const std::size_t first = static_cast<std::size_t>(i) * d;
  Residual residual;
  if (!fit.weights.empty()) residual.weight = fit.weights[i];
  for (int c = 0; c < d; ++c) residual.value[c] = curve->Coordinate(c) - fit.points[first + c];
  const std::vector<Real>& basis = curve->BasisValues();
  for (int c = 0; c < d; ++c) {
    residual.data[c] = std::abs(static_cast<Real>(fit.points[first + c])) + sums.extent[c];
    residual.size[c] = residual.data[c];
    for (int j = 0; j <= fit.degree; ++j) {
      residual.size[c] += basis[j] * std::abs(fit.control_points[curve->ControlPoint(j) * d + c]);
    }
  }
  return residual;
}

void AddPoint(const AuditedFit& fit, const Residual& residual, AuditCurve* curve, Sums* sums) {
  const int d = fit.dimension;
  const Real weight = residual.weight;
  const std::vector<Real>& basis = curve->BasisValues();
  for (int j = 0; j <= fit.degree; ++j) ++sums->num_summands[curve->ControlPoint(j)];
  Real squared = 0;
  for (int c = 0; c < d; ++c) {
    squared += residual.value[c] * residual.value[c];
    const Real rounding = kUnitRoundoff * residual.size[c];
    sums->squared_rounding += weight * rounding * rounding;
    for (int j = 0; j <= fit.degree; ++j) {
      const int entry = curve->ControlPoint(j) * d + c;
      sums->gradient[entry] += 2 * weight * basis[j] * residual.value[c];
      sums->rounding[entry] += 2 * weight * basis[j] * rounding;
    }
  }
  sums->energy += weight * squared;
  sums->squared_distance += squared;
  // Written so that NaN is not lost.
  if (!(squared <= sums->largest)) sums->largest = squared;
}

/// dE/d(length t_i) = 2 w C'(t_i) . r_i / length. Run and audit have the same t, so that roundings
/// are those of r and C'; in the latter W_j (P_j - P_(j-1)) may be a small difference of large
/// numbers, in coordinates from a centre no farther from the user's origin than data + extent.
void AddParameter(const AuditedFit& fit, int i, const Residual& residual, AuditCurve* curve,
                  Sums* sums) {
  const ParameterState state = fit.parameter_states[i];
  if (state == ParameterState::kHeld) return;
  const int d = fit.dimension;
  const std::vector<Real>& weights = curve->DerivativeWeights();
  const Real factor = 2 * residual.weight / fit.length;
  Real slope = 0;
  Real rounding = 0;
  for (int c = 0; c < d; ++c) {
    Real derivative = 0;
    Real derivative_size = 0;
    for (int j = 1; j <= fit.degree; ++j) {
      const Real before = fit.control_points[curve->ControlPoint(j - 1) * d + c];
      const Real after = fit.control_points[curve->ControlPoint(j) * d + c];
      derivative += weights[j] * (after - before);
      derivative_size += weights[j] * (std::abs(before) + std::abs(after) + 2 * residual.data[c]);
    }
    slope += factor * derivative * residual.value[c];
    rounding +=
        factor * kUnitRoundoff *
        (std::abs(derivative) * residual.size[c] + std::abs(residual.value[c]) * derivative_size);
  }
  sums->squared_slope_rounding += rounding * rounding;
  if (state == ParameterState::kMoves) {
    if (fit.parameter_blocks.empty()) {
      sums->squared_slope += slope * slope;
    } else {
      // Held ends have block 0 as well, but come to no place here.
      const auto place = static_cast<std::size_t>(i);
      sums->goes_around = sums->goes_around || (i > 0 && fit.parameter_blocks[place] == 0 &&
                                                fit.parameter_blocks[place - 1] != 0);
      (sums->goes_around ? sums->around
                         : sums->slopes[static_cast<std::size_t>(fit.parameter_blocks[i])])
          .push_back(slope);
    }
    return;
  }
  const double t = fit.parameters[i];
  const bool at_begin = t <= curve->domain_begin();
  CHECK(!fit.periodic && (at_begin || t >= curve->domain_end())) << "t is inside the domain";
  if (at_begin ? slope < 0 : slope > 0) sums->squared_pull += slope * slope;
}

/// Squared length of the steepest descent of points that share one parameter and may part in their
/// order only: of the isotonic regression of -slopes, the slopes of the greatest convex function
/// below their sums.
Real SquaredSlopeInOrder(const std::vector<Real>& slopes) {
  const std::size_t n = slopes.size();
  std::vector<Real> sums(n + 1, 0);
  for (std::size_t i = 0; i < n; ++i) sums[i + 1] = sums[i] - slopes[i];
  const auto rise = [&sums](std::size_t a, std::size_t b) {
    return (sums[b] - sums[a]) / static_cast<Real>(b - a);
  };
  std::vector<std::size_t> corners = {0};
  for (std::size_t i = 1; i <= n; ++i) {
    while (corners.size() > 1 &&
           rise(corners[corners.size() - 2], corners.back()) >= rise(corners.back(), i)) {
      corners.pop_back();
    }
    corners.push_back(i);
  }
  Real squared = 0;
  for (std::size_t k = 0; k + 1 < corners.size(); ++k) {
    const Real slope = rise(corners[k], corners[k + 1]);
    squared += slope * slope * static_cast<Real>(corners[k + 1] - corners[k]);
  }
  return squared;
}

void AddBlocks(Sums* sums, AuditReport* report) {
  if (sums->slopes.empty()) return;
  // A period on, the last points come before those of the first block.
  sums->slopes[0].insert(sums->slopes[0].begin(), sums->around.begin(), sums->around.end());
  for (const std::vector<Real>& slopes : sums->slopes) {
    sums->squared_slope += SquaredSlopeInOrder(slopes);
    if (slopes.size() > 1) report->num_sharing += static_cast<int>(slopes.size());
  }
}

std::string Number(double value) {
  std::ostringstream text;
  text.precision(10);
  text << value;
  return text.str();
}

Verdict Fails(const std::string& quantity, double claimed, double found, double allowed) {
  return {false, "claims " + quantity + " " + Number(claimed) + ", but the audit finds " +
                     Number(found) + " (allowed difference " + Number(allowed) + ")"};
}

}  // namespace

AuditReport Audit(const AuditedFit& fit) {
  CHECK(fit.dimension >= 1 && fit.dimension <= kMostCoordinates);
  const int m = static_cast<int>(fit.parameters.size());
  CHECK_EQ(fit.points.size(), static_cast<std::size_t>(m) * fit.dimension);
  CHECK(fit.weights.empty() || fit.weights.size() == fit.parameters.size());
  const bool is_free = !fit.parameter_states.empty();
  CHECK(!is_free || fit.parameter_states.size() == fit.parameters.size());
  AuditCurve curve(fit);
  Sums sums;
  sums.gradient.assign(fit.control_points.size(), 0);
  sums.rounding.assign(fit.control_points.size(), 0);
  sums.num_summands.assign(curve.num_control_points(), 0);
  if (!fit.parameter_blocks.empty()) sums.slopes.resize(fit.parameter_blocks.size());
  MeasureExtent(fit, &sums);
  for (int i = 0; i < m; ++i) {
    curve.MoveTo(fit.parameters[i]);
    const Residual residual = MeasureResidual(fit, i, sums, &curve);
    AddPoint(fit, residual, &curve, &sums);
    if (is_free) AddParameter(fit, i, residual, &curve, &sums);
  }
  AddTermsBesidePoints(fit, &curve, &sums);

  AuditReport report;
  AddBlocks(&sums, &report);
  report.num_summands = m + sums.num_places;
  report.most_summands = *std::max_element(sums.num_summands.begin(), sums.num_summands.end());
  report.energy = static_cast<double>(sums.energy);
  report.gradient_norm = Norm(sums.gradient, sums.squared_slope);
  report.pull_norm = static_cast<double>(std::sqrt(sums.squared_pull));
  report.gradient_floor = Norm(sums.rounding, sums.squared_slope_rounding);
  // E(r + delta) - E(r) = 2 r'W delta + delta'W delta <= 2 |r| |delta| + |delta|^2 in W's norm.
  const Real delta = std::sqrt(sums.squared_rounding);
  report.energy_floor = static_cast<double>(2 * std::sqrt(sums.energy) * delta + delta * delta);
  if (fit.at_foot_points) AuditFeet(fit, &report);
  report.rms_distance = m == 0 ? 0.0 : static_cast<double>(std::sqrt(sums.squared_distance / m));
  report.max_distance = static_cast<double>(std::sqrt(sums.largest));
  return report;
}

// The run computed in double what the audit computes from control points and data rounded once.
// A term B_j(t) P_j costs the run at most kRoundings: 4 for each of the p <= 9 levels of the basis
// recursion (a difference of knots, a quotient, a product, a sum), and at most 12 more for
// centring, the products and the p + 2 sums of C(t) - Q, and the weight. All of them in the worst
// direction. Sums over points add a rounding for each. The derivative by a free parameter has one
// level of the recursion less, and instead of it a quotient, a product and a difference.
Verdict Verify(const Claim& claim, const AuditReport& report) {
  constexpr double kRoundings = 4 * 9 + 12;
  const bool nothing_finite = !std::isfinite(claim.energy) && !std::isfinite(report.energy);
  if (nothing_finite && !claim.minimum) return {true, ""};
  if (!std::isfinite(report.energy) || !std::isfinite(report.gradient_norm)) {
    return {false, "claims energy " + Number(claim.energy) +
                       ", but the audit finds no finite energy and gradient"};
  }
  if (!std::isfinite(claim.energy) || !std::isfinite(claim.gradient_norm)) {
    return {false, "claims energy " + Number(claim.energy) + " and |g| " +
                       Number(claim.gradient_norm) + ", which is no result"};
  }
  const double sum_rounding = report.num_summands * static_cast<double>(kUnitRoundoff);
  const double energy_allowed =
      kRoundings * (report.energy_floor + static_cast<double>(kUnitRoundoff) * report.energy) +
      sum_rounding * report.energy;
  if (!(std::abs(claim.energy - report.energy) <= energy_allowed)) {
    return Fails("energy", claim.energy, report.energy, energy_allowed);
  }
  // A gradient entry is a sum over the points that its control point moves, of terms no larger
  // than the 2 w B (|P| + |Q|) that the floor sums up.
  const double gradient_allowed =
      (kRoundings + report.most_summands) * report.gradient_floor + report.foot_rounding;
  if (!(std::abs(claim.gradient_norm - report.gradient_norm) <= gradient_allowed)) {
    return Fails("|g|", claim.gradient_norm, report.gradient_norm, gradient_allowed);
  }
  if (!(report.foot_excess <= report.foot_allowed)) {
    return {false, "says that points are compared at their feet, but the audit finds one that is " +
                       Number(report.foot_excess) + " nearer to another point of the curve" +
                       " (allowed: " + Number(report.foot_allowed) + ")"};
  }
  if (!claim.minimum) return {true, ""};
  const double target =
      claim.gradient_target + kRoundings * report.gradient_floor + report.foot_rounding;
  if (!(report.gradient_norm <= target)) {
    return {false, "claims a minimum with |g| at most " + Number(claim.gradient_target) +
                       ", but the audit finds " + Number(report.gradient_norm) +
                       " (allowed with rounding: " + Number(target) + ")"};
  }
  if (!(std::hypot(report.gradient_norm, report.pull_norm) <= target)) {
    return {false,
            "claims a minimum, but E falls where parameters that are past an end of the "
            "curve move back into it: |g| of these is " +
                Number(report.pull_norm) + " (allowed: " + Number(target) + ")"};
  }
  if (report.energy - energy_allowed > claim.start_energy) {
    return {false, "claims a minimum, but its energy " + Number(report.energy) +
                       " is above the start's " + Number(claim.start_energy)};
  }
  return {true, ""};
}

}  // namespace batten
