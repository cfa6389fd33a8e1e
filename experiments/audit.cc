#include "experiments/audit.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "experiments/audit_curve.h"
#include "experiments/audit_loss.h"
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
  PointEnergy worth;
  Real squared = 0;
  Real value[kMostCoordinates];  // C(t) - Q
  Real data[kMostCoordinates];   // size of the data, the centre of the run's coordinates included
  Real size[kMostCoordinates];   // what one rounding of all numbers in `value` is relative to
};

Residual MeasureResidual(const AuditedFit& fit, int i, const Sums& sums, AuditCurve* curve) {
  const int d = fit.dimension;
  const std::size_t first = static_cast<std::size_t>(i) * d;
  Residual residual;
  for (int c = 0; c < d; ++c) {
    residual.value[c] = curve->Coordinate(c) - fit.points[first + c];
    residual.squared += residual.value[c] * residual.value[c];
  }
  residual.worth = EnergyOfPoint(fit, static_cast<std::size_t>(i), residual.squared);
  const std::vector<Real>& basis = curve->BasisValues();
  for (int c = 0; c < d; ++c) {
    residual.data[c] = std::abs(static_cast<Real>(fit.points[first + c])) + sums.extent[c];
    residual.size[c] = residual.data[c];
    for (int j = 0; j <= fit.degree; ++j) {
      residual.size[c] += basis[j] * std::abs(fit.control_points[curve->ControlPoint(j) * d + c]);
    }
  }
  if (residual.worth.has_loss) {
    // rho' ties the coordinates together. The second derivative of rho(|r|^2) is at most 2 in any
    // direction, as without a loss.
    Real squared_size = 0;
    for (int c = 0; c < d; ++c) squared_size += residual.size[c] * residual.size[c];
    std::fill_n(residual.size, d, std::sqrt(squared_size));
  }
  return residual;
}

void AddPoint(const AuditedFit& fit, const Residual& residual, AuditCurve* curve, Sums* sums) {
  const int d = fit.dimension;
  const Real slope = residual.worth.slope;
  const Real largest = residual.worth.largest;
  const std::vector<Real>& basis = curve->BasisValues();
  for (int j = 0; j <= fit.degree; ++j) ++sums->num_summands[curve->ControlPoint(j)];
  for (int c = 0; c < d; ++c) {
    const Real rounding = kUnitRoundoff * residual.size[c];
    sums->squared_rounding += largest * rounding * rounding;
    for (int j = 0; j <= fit.degree; ++j) {
      const int entry = curve->ControlPoint(j) * d + c;
      sums->gradient[entry] += 2 * slope * basis[j] * residual.value[c];
      sums->rounding[entry] += 2 * largest * basis[j] * rounding;
    }
  }
  sums->energy += residual.worth.energy;
  sums->weighted_squares += slope * residual.squared;
  sums->squared_distance += residual.squared;
  // Written so that NaN is not lost.
  if (!(residual.squared <= sums->largest)) sums->largest = residual.squared;
}

/// dE/d(length t_i) = 2 w C'(t_i) . r_i / length, w = dE / d|r_i|^2. Run and audit have the same t,
/// so that roundings are those of r and C'; in the latter W_j (P_j - P_(j-1)) may be a small
/// difference of large numbers, in coordinates from a centre no farther from the user's origin than
/// data + extent.
void AddParameter(const AuditedFit& fit, int i, const Residual& residual, AuditCurve* curve,
                  Sums* sums) {
  const ParameterState state = fit.parameter_states[i];
  if (state == ParameterState::kHeld) return;
  const int d = fit.dimension;
  const std::vector<Real>& weights = curve->DerivativeWeights();
  const Real factor = 2 * residual.worth.slope / fit.length;
  const Real largest = 2 * residual.worth.largest / fit.length;
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
        largest * kUnitRoundoff *
        (std::abs(derivative) * residual.size[c] + std::abs(residual.value[c]) * derivative_size);
  }
  sums->squared_slope_rounding += rounding * rounding;
  const double t = fit.parameters[i];
  const bool at_begin = !fit.periodic && t <= curve->domain_begin();
  const bool at_end = !fit.periodic && t >= curve->domain_end();
  if (state == ParameterState::kMoves) {
    if (fit.parameter_blocks.empty()) {
      sums->squared_slope += slope * slope;
    } else {
      // Held ends have block 0 as well, but come to no place here.
      const auto place = static_cast<std::size_t>(i);
      sums->goes_around = sums->goes_around || (i > 0 && fit.parameter_blocks[place] == 0 &&
                                                fit.parameter_blocks[place - 1] != 0);
      const auto block = static_cast<std::size_t>(fit.parameter_blocks[place]);
      (sums->goes_around ? sums->around : sums->slopes[block]).push_back(slope);
      if (at_begin || at_end) sums->inward[block] = at_begin ? 1 : -1;
    }
    return;
  }
  CHECK(at_begin || at_end) << "t is inside the domain";
  if (at_begin ? slope < 0 : slope > 0) sums->squared_pull += slope * slope;
}

/// Squared length of the steepest descent of points that share one parameter and may part in their
/// order only: of the isotonic regression of -slopes, the slopes of the greatest convex function
/// below their sums. Where `inward` is not 0, of those of this sign only: there the curve ends.
Real SquaredSlopeInOrder(const std::vector<Real>& slopes, int inward) {
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
    if (static_cast<Real>(inward) * slope < 0) continue;
    squared += slope * slope * static_cast<Real>(corners[k + 1] - corners[k]);
  }
  return squared;
}

void AddBlocks(Sums* sums, AuditReport* report) {
  if (sums->slopes.empty()) return;
  // A period on, the last points come before those of the first block.
  sums->slopes[0].insert(sums->slopes[0].begin(), sums->around.begin(), sums->around.end());
  for (std::size_t b = 0; b < sums->slopes.size(); ++b) {
    const std::vector<Real>& slopes = sums->slopes[b];
    sums->squared_slope += SquaredSlopeInOrder(slopes, sums->inward[b]);
    if (slopes.size() > 1) report->num_sharing += static_cast<int>(slopes.size());
  }
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
  if (!fit.parameter_blocks.empty()) {
    sums.slopes.resize(fit.parameter_blocks.size());
    sums.inward.resize(fit.parameter_blocks.size());
  }
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
  AuditConstraints(fit, &curve, &sums, &report);
  report.covers_gradient = fit.conditions.empty();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  report.gradient_norm = report.covers_gradient ? Norm(sums.gradient, sums.squared_slope) : nan;
  if (fit.equations.empty() || !report.covers_gradient) {
    report.projected_gradient_norm = report.gradient_norm;
  }
  report.pull_norm = static_cast<double>(std::sqrt(sums.squared_pull));
  report.gradient_floor = Norm(sums.rounding, sums.squared_slope_rounding);
  // E(r + delta) - E(r) = 2 r'W delta + delta'W delta <= 2 |r| |delta| + |delta|^2 in W's norm;
  // with losses W has the factors rho' in the first part and not in the second.
  const Real delta = std::sqrt(sums.squared_rounding);
  report.energy_floor =
      static_cast<double>(2 * std::sqrt(sums.weighted_squares) * delta + delta * delta);
  if (fit.at_foot_points) AuditFeet(fit, &report);
  report.rms_distance = m == 0 ? 0.0 : static_cast<double>(std::sqrt(sums.squared_distance / m));
  report.max_distance = static_cast<double>(std::sqrt(sums.largest));
  return report;
}

}  // namespace batten
