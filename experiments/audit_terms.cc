#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <limits>

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

/// The largest coordinates of the data that the run's own, which are centred, can come from.
std::vector<Real> DataSizes(const AuditedFit& fit, const AuditSums& sums) {
  std::vector<Real> sizes(static_cast<std::size_t>(fit.dimension), 0);
  for (std::size_t k = 0; k < fit.points.size(); ++k) {
    Real& size = sizes[k % sizes.size()];
    size = std::max(size, std::abs(static_cast<Real>(fit.points[k])));
  }
  for (std::size_t c = 0; c < sizes.size(); ++c) sizes[c] += sums.extent[c];
  return sizes;
}

/// factor * |C^(k)(t) - value|^2 where the curve now is; no value: 0. `relative`: by how much more
/// than one rounding of each of its numbers the run may know the derivative less well.
void AddPlace(const AuditedFit& fit, int k, Real factor, const std::vector<double>& value,
              const std::vector<Real>& data_sizes, Real relative, AuditCurve* curve,
              AuditSums* sums) {
  std::vector<Real> row;
  std::vector<Real> sizes;
  curve->DerivativeRow(k, &row, &sizes);
  for (int c = 0; c < fit.dimension; ++c) {
    const auto at = static_cast<std::size_t>(c);
    Real residual = value.empty() ? 0 : -static_cast<Real>(value[at]);
    Real rounding = std::abs(residual);
    for (int j = 0; j <= fit.degree; ++j) {
      const Real point = fit.control_points[curve->ControlPoint(j) * fit.dimension + c];
      residual += row[j] * point;
      rounding += sizes[j] * (std::abs(point) + data_sizes[at]);
    }
    rounding *= AuditSums::kUnitRoundoff * (1 + relative);
    sums->energy += factor * residual * residual;
    sums->squared_rounding += factor * rounding * rounding;
    for (int j = 0; j <= fit.degree; ++j) {
      const int entry = curve->ControlPoint(j) * fit.dimension + c;
      sums->gradient[entry] += 2 * factor * row[j] * residual;
      // The row itself is rounded where its entries are small differences of large ones.
      sums->rounding[entry] +=
          2 * factor *
          (std::abs(row[j]) * rounding +
           AuditSums::kUnitRoundoff * (1 + relative) * sizes[j] * std::abs(residual));
    }
  }
  ++sums->num_places;
  for (int j = 0; j <= fit.degree; ++j) ++sums->num_summands[curve->ControlPoint(j)];
}

void AddIntegral(const AuditedFit& fit, const AuditedIntegral& integral,
                 const std::vector<Real>& data_sizes, AuditCurve* curve, AuditSums* sums) {
  const int k = integral.derivative;
  const Rule rule = FejerRule(2 * (fit.degree - k) + 1);
  std::size_t num_spans = 0;
  for (auto s = static_cast<std::size_t>(fit.degree); fit.knots[s] < curve->domain_end(); ++s) {
    const Real begin = fit.knots[s];
    const Real length = fit.knots[s + 1] - begin;
    if (!(length > 0)) continue;
    const Real factor = integral.span_factors.empty() ? static_cast<Real>(integral.factor)
                                                      : static_cast<Real>(integral.factor) *
                                                            integral.span_factors.at(num_spans);
    ++num_spans;
    // The run rounds its nodes to double: by this part of the span.
    const Real relative = (std::abs(begin) + length) / length;
    for (std::size_t g = 0; g < rule.nodes.size(); ++g) {
      curve->MoveTo(begin + (1 + rule.nodes[g]) * length / 2);
      AddPlace(fit, k, factor * rule.weights[g] * length / 2, {}, data_sizes, relative, curve,
               sums);
    }
  }
  CHECK(integral.span_factors.empty() || integral.span_factors.size() == num_spans);
}

}  // namespace

void AddTermsBesidePoints(const AuditedFit& fit, AuditCurve* curve, AuditSums* sums) {
  if (fit.integrals.empty() && fit.ends.empty()) return;
  const std::vector<Real> data_sizes = DataSizes(fit, *sums);
  for (const AuditedIntegral& integral : fit.integrals) {
    AddIntegral(fit, integral, data_sizes, curve, sums);
  }
  for (const AuditedEnd& end : fit.ends) {
    CHECK(!fit.periodic && end.value.size() == static_cast<std::size_t>(fit.dimension));
    curve->MoveTo(end.at_end ? curve->domain_end() : curve->domain_begin());
    AddPlace(fit, end.derivative, end.factor, end.value, data_sizes, 0, curve, sums);
  }
}

}  // namespace batten
