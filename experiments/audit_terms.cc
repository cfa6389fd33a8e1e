#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "experiments/audit_loss.h"
#include "experiments/audit_sums.h"

namespace batten {
namespace {

using Real = AuditSums::Real;

struct Rule {
  std::vector<Real> nodes;    // in (-1, 1)
  std::vector<Real> weights;  // sum 2
};

/// Fejer's first rule with n points, exact for polynomials of degree n - 1: the cosines of odd
/// multiples of pi / 2n, weights in closed form (Fejer, Math. Zeitschrift 37, 1933).
Rule FejerRule(int n) {
  const Real pi = std::acos(static_cast<Real>(-1));
  Rule rule;
  for (int i = 0; i < n; ++i) {
    const Real angle = (2 * i + 1) * pi / (2 * n);
    Real sum = 1;
    for (int m = 1; m <= n / 2; ++m) {
      sum -= 2 * std::cos(2 * m * angle) / static_cast<Real>(4 * m * m - 1);
    }
    rule.nodes.push_back(std::cos(angle));
    rule.weights.push_back(2 * sum / n);
  }
  return rule;
}

/// A term factor * rho(|C^(k)(t) - value|^2) where the curve now is.
struct Place {
  int derivative = 0;
  Real factor = 1;
  std::vector<double> value;  // empty: 0
  AuditedLoss loss;
  /// By how much more than one rounding of each of its numbers the run may know the derivative less
  /// well.
  Real relative = 0;
};

void AddPlace(const AuditedFit& fit, const Place& place, const std::vector<Real>& data_sizes,
              AuditCurve* curve, AuditSums* sums) {
  const auto d = static_cast<std::size_t>(fit.dimension);
  std::vector<Real> row;
  std::vector<Real> sizes;
  curve->DerivativeRow(place.derivative, &row, &sizes);
  std::vector<Real> residual(d);
  std::vector<Real> rounding(d);
  Real squared = 0;
  Real squared_rounding = 0;
  for (std::size_t c = 0; c < d; ++c) {
    residual[c] = place.value.empty() ? 0 : -static_cast<Real>(place.value[c]);
    rounding[c] = std::abs(residual[c]);
    for (int j = 0; j <= fit.degree; ++j) {
      const Real point =
          fit.control_points[static_cast<std::size_t>(curve->ControlPoint(j)) * d + c];
      residual[c] += row[j] * point;
      rounding[c] += sizes[j] * (std::abs(point) + data_sizes[c]);
    }
    rounding[c] *= AuditSums::kUnitRoundoff * (1 + place.relative);
    squared += residual[c] * residual[c];
    squared_rounding += rounding[c] * rounding[c];
  }
  const AuditedRho rho = EvaluateRho(place.loss, squared);
  if (place.loss.kind != AuditedLoss::Kind::kNone) {
    std::fill(rounding.begin(), rounding.end(), std::sqrt(squared_rounding));
  }
  sums->energy += place.factor * rho.value;
  sums->weighted_squares += place.factor * rho.slope * squared;
  sums->squared_rounding += place.factor * squared_rounding;
  for (int j = 0; j <= fit.degree; ++j) {
    for (std::size_t c = 0; c < d; ++c) {
      const std::size_t entry = static_cast<std::size_t>(curve->ControlPoint(j)) * d + c;
      sums->gradient[entry] += 2 * place.factor * rho.slope * row[j] * residual[c];
      // The row itself is rounded where its entries are small differences of large ones.
      sums->rounding[entry] +=
          2 * place.factor *
          (std::abs(row[j]) * rounding[c] +
           AuditSums::kUnitRoundoff * (1 + place.relative) * sizes[j] * std::abs(residual[c]));
    }
  }
  ++sums->num_places;
  for (int j = 0; j <= fit.degree; ++j) ++sums->num_summands[curve->ControlPoint(j)];
}

void AddIntegral(const AuditedFit& fit, const AuditedIntegral& integral,
                 const std::vector<Real>& data_sizes, AuditCurve* curve, AuditSums* sums) {
  const int k = integral.derivative;
  const Rule rule = FejerRule(2 * (fit.degree - k) + 1);
  const auto add_span = [&](Real begin, Real length, Real factor) {
    for (std::size_t g = 0; g < rule.nodes.size(); ++g) {
      curve->MoveTo(begin + (1 + rule.nodes[g]) * length / 2);
      const Place place = {
          k, factor * rule.weights[g] * length / 2, {}, {}, NodeRounding(begin, length)};
      AddPlace(fit, place, data_sizes, curve, sums);
    }
  };
  VisitSpans(fit, *curve, integral.factor, integral.span_factors, add_span);
}

}  // namespace

std::vector<Real> DataSizes(const AuditedFit& fit, const AuditSums& sums) {
  std::vector<Real> sizes(static_cast<std::size_t>(fit.dimension), 0);
  for (std::size_t k = 0; k < fit.points.size(); ++k) {
    Real& size = sizes[k % sizes.size()];
    size = std::max(size, std::abs(static_cast<Real>(fit.points[k])));
  }
  for (std::size_t c = 0; c < sizes.size(); ++c) sizes[c] += sums.extent[c];
  return sizes;
}

void AddTermsBesidePoints(const AuditedFit& fit, AuditCurve* curve, AuditSums* sums) {
  if (fit.integrals.empty() && fit.bendings.empty() && fit.ends.empty()) return;
  const std::vector<Real> data_sizes = DataSizes(fit, *sums);
  for (const AuditedIntegral& integral : fit.integrals) {
    AddIntegral(fit, integral, data_sizes, curve, sums);
  }
  for (const AuditedBending& bending : fit.bendings) {
    AddBending(fit, bending, data_sizes, curve, sums);
  }
  for (const AuditedEnd& end : fit.ends) {
    CHECK(!fit.periodic && end.value.size() == static_cast<std::size_t>(fit.dimension));
    curve->MoveTo(end.at_end ? curve->domain_end() : curve->domain_begin());
    AddPlace(fit, {end.derivative, end.factor, end.value, end.loss, 0}, data_sizes, curve, sums);
  }
}

}  // namespace batten
