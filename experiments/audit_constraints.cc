// Constraints at the end of a run, in long double: what misses them, and the gradient that they
// leave.
#include <algorithm>
#include <cmath>
#include <limits>

#include "experiments/audit_equations.h"
#include "experiments/audit_sums.h"

namespace batten {
namespace {

using Real = AuditSums::Real;

/// By how much an equation is missed, and what rounding may be worth in it where it is solved
/// together with num_coupled - 1 others.
void MeasureEquation(const AuditedFit& fit, const AuditedEquation& equation, const EquationRow& row,
                     std::size_t num_coupled, const std::vector<Real>& data_sizes,
                     AuditReport* report) {
  Real sum = -static_cast<Real>(equation.value);
  Real rounding = std::abs(sum);
  for (const auto& [entry, coefficient] : row.row) {
    const Real point = fit.control_points[entry];
    sum += coefficient * point;
    rounding += row.sizes.at(entry) *
                (std::abs(point) + data_sizes[entry % static_cast<std::size_t>(fit.dimension)]);
  }
  rounding *= AuditSums::kUnitRoundoff * static_cast<Real>(1 + num_coupled);
  const auto missed = static_cast<double>(std::abs(sum));
  const auto allowed = static_cast<double>(rounding);
  // Written so that NaN is not lost.
  const bool is_worse = !(missed * report->missed_allowed <= report->missed * allowed);
  if (!report->worst_equation.empty() && !is_worse) return;
  report->worst_equation = equation.name;
  report->missed = missed;
  report->missed_allowed = allowed;
}

/// C^(k) where the curve is, d, and what one rounding of each number is worth, as a length.
std::vector<Real> Derivative(const AuditedFit& fit, int k, const std::vector<Real>& data_sizes,
                             AuditCurve* curve, Real* rounding) {
  std::vector<Real> row;
  std::vector<Real> sizes;
  curve->DerivativeRow(k, &row, &sizes);
  std::vector<Real> value(data_sizes.size(), 0);
  Real squared = 0;
  for (std::size_t c = 0; c < value.size(); ++c) {
    Real size = 0;
    for (int j = 0; j <= fit.degree; ++j) {
      const Real point =
          fit.control_points[static_cast<std::size_t>(curve->ControlPoint(j)) * value.size() + c];
      value[c] += row[j] * point;
      size += sizes[j] * (std::abs(point) + data_sizes[c]);
    }
    squared += size * size;
  }
  *rounding = AuditSums::kUnitRoundoff * std::sqrt(squared);
  return value;
}

Real Dot(const std::vector<Real>& a, const std::vector<Real>& b) {
  Real sum = 0;
  for (std::size_t c = 0; c < a.size(); ++c) sum += a[c] * b[c];
  return sum;
}

/// A length and what rounding is worth in it.
struct Missed {
  Real length = 0;
  Real rounding = 0;
};

Missed MissPoint(const AuditedFit& fit, const AuditedCondition& condition,
                 const std::vector<Real>& data_sizes, AuditCurve* curve) {
  Missed missed;
  const std::vector<Real> point =
      Derivative(fit, condition.order, data_sizes, curve, &missed.rounding);
  const Real unit = std::pow(curve->domain_end() - curve->domain_begin(), condition.order);
  missed.rounding *= unit;
  for (std::size_t c = 0; c < point.size(); ++c) {
    if (!std::isfinite(condition.value[c])) continue;
    const Real off = unit * std::abs(point[c] - condition.value[c]);
    if (!(off <= missed.length)) missed.length = off;
  }
  return missed;
}

/// Across: |a - (a . u) u|, of which one of d - 1 normals has at least a part of 1 / sqrt(d - 1).
Missed MissTangent(const AuditedFit& fit, const AuditedCondition& condition,
                   const std::vector<Real>& data_sizes, AuditCurve* curve) {
  Missed missed;
  std::vector<Real> a = Derivative(fit, 1, data_sizes, curve, &missed.rounding);
  const Real domain = curve->domain_end() - curve->domain_begin();
  missed.rounding *= domain;
  const std::vector<Real> u(condition.value.begin(), condition.value.end());
  const Real along = Dot(a, u) / Dot(u, u);
  for (std::size_t c = 0; c < a.size(); ++c) a[c] -= along * u[c];
  const Real across = std::sqrt(Dot(a, a) / static_cast<Real>(a.size() - 1));
  const Real slow = condition.amount - domain * along * std::sqrt(Dot(u, u));
  missed.length = std::max(domain * across, slow);
  return missed;
}

/// kappa = |a x b| / |a|^3 with a, b = C', C''; |a x b|^2 by the minors of (a, b). In space
/// (kappa^2 - amount^2) / (2 amount) is what is held.
Missed MissCurvature(const AuditedFit& fit, const AuditedCondition& condition,
                     const std::vector<Real>& data_sizes, AuditCurve* curve) {
  Real of_a = 0;
  Real of_b = 0;
  const std::vector<Real> a = Derivative(fit, 1, data_sizes, curve, &of_a);
  const std::vector<Real> b = Derivative(fit, 2, data_sizes, curve, &of_b);
  const Real speed = std::sqrt(Dot(a, a));
  Real bend = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = i + 1; j < a.size(); ++j) {
      const Real minor = a[i] * b[j] - a[j] * b[i];
      bend = a.size() == 2 ? minor : std::hypot(bend, minor);
    }
  }
  const Real kappa = bend / (speed * speed * speed);
  const Real amount = condition.amount;
  const Real off =
      a.size() == 2 ? kappa - amount : (kappa * kappa - amount * amount) / (2 * amount);
  const Real of_kappa = (of_b + of_a * std::sqrt(Dot(b, b)) / speed) / (speed * speed) +
                        3 * std::abs(kappa) * of_a / speed;
  const Real slope = a.size() == 2 ? 1 : kappa / amount;
  return {condition.unit * std::abs(off), condition.unit * slope * of_kappa};
}

Missed Miss(const AuditedFit& fit, const AuditedCondition& condition,
            const std::vector<Real>& data_sizes, AuditCurve* curve) {
  curve->MoveTo(condition.t);
  switch (condition.kind) {
    case AuditedCondition::Kind::kPoint:
      return MissPoint(fit, condition, data_sizes, curve);
    case AuditedCondition::Kind::kTangent:
      return MissTangent(fit, condition, data_sizes, curve);
    case AuditedCondition::Kind::kCurvature:
      break;
  }
  return MissCurvature(fit, condition, data_sizes, curve);
}

void MeasureConditions(const AuditedFit& fit, const std::vector<Real>& data_sizes,
                       AuditCurve* curve, AuditReport* report) {
  for (const AuditedCondition& condition : fit.conditions) {
    const Missed missed = Miss(fit, condition, data_sizes, curve);
    // Of all, the largest that rounding may be worth anywhere: what is compared is the worst.
    report->violation_allowed =
        std::max(report->violation_allowed, static_cast<double>(missed.rounding));
    // Written so that NaN is not lost.
    if (!report->worst_condition.empty() && missed.length <= report->violation) continue;
    report->worst_condition = condition.name;
    report->violation = static_cast<double>(std::max<Real>(missed.length, 0));
    if (std::isnan(missed.length)) report->violation = std::numeric_limits<double>::quiet_NaN();
  }
}

}  // namespace

void AuditConstraints(const AuditedFit& fit, AuditCurve* curve, AuditSums* sums,
                      AuditReport* report) {
  if (fit.equations.empty() && fit.conditions.empty()) return;
  const std::vector<Real> data_sizes = DataSizes(fit, *sums);
  MeasureConditions(fit, data_sizes, curve, report);
  std::vector<EquationRow> rows;
  for (const AuditedEquation& equation : fit.equations) {
    rows.push_back(MakeEquationRow(fit, equation, curve));
  }
  std::vector<bool> eliminated(sums->gradient.size(), false);
  for (const int entry : fit.eliminated) eliminated[static_cast<std::size_t>(entry)] = true;
  std::vector<Real> projected = sums->gradient;
  std::size_t num_independent = 0;
  for (const std::vector<std::size_t>& group : GroupCoupled(rows)) {
    std::vector<const EquationRow*> own;
    for (const std::size_t k : group) {
      own.push_back(&rows[k]);
      MeasureEquation(fit, fit.equations[k], rows[k], group.size(), data_sizes, report);
    }
    const CoupledEquations coupled(own, eliminated);
    num_independent += coupled.num_independent();
    if (!coupled.failure().empty()) report->elimination_failure = coupled.failure();
    if (!report->elimination_failure.empty()) continue;
    coupled.Project(&projected);
    coupled.Reduce(&sums->gradient, &sums->rounding);
  }
  if (report->elimination_failure.empty() && num_independent != fit.eliminated.size()) {
    report->elimination_failure =
        "takes coordinates of control points from linear constraints that do not hold them";
  }
  // Where the constraints hold every coordinate, what is left of g is rounding alone.
  if (num_independent == projected.size()) std::fill(projected.begin(), projected.end(), Real(0));
  Real squared = sums->squared_slope;
  for (const Real entry : projected) squared += entry * entry;
  report->projected_gradient_norm = static_cast<double>(std::sqrt(squared));
}

}  // namespace batten
