#include "experiments/audit.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace batten {
namespace {

using Real = long double;
constexpr Real kUnitRoundoff = 0x1p-53L;  // of double: half the distance from 1 to its neighbour
constexpr int kMostCoordinates = 16;

/// Notation of de Boor 1972: k = order, knots u, control points d_j; d_j^(r) are the points of
/// level r. Curve point and basis values come from one table of the recursion's ratios.
class DeBoor {
 public:
  explicit DeBoor(const AuditedFit& fit)
      : fit_(fit),
        p_(fit.degree),
        n_(static_cast<int>(fit.control_points.size()) / fit.dimension),
        last_(fit.periodic ? n_ + p_ - 1 : n_ - 1),
        ratios_((p_ + 1) * (p_ + 1)),
        work_(p_ + 1) {
    CHECK_GE(p_, 1);
    CHECK_EQ(fit.knots.size(), static_cast<std::size_t>(last_ + p_ + 2));
  }

  int num_control_points() const { return n_; }

  /// Moves to parameter t: finds the span and fills the table of ratios.
  void MoveTo(double parameter) {
    const Real t = Wrapped(parameter);
    const double* u = fit_.knots.data();
    // The last span with u_s <= t that is not empty: the domain's end belongs to the span before.
    const double* end = std::upper_bound(u + p_, u + last_ + 1, t,
                                         [](Real value, double knot) { return value < knot; });
    span_ = static_cast<int>(end - u) - 1;
    while (span_ > p_ && u[span_] >= u[span_ + 1]) --span_;
    for (int r = 1; r <= p_; ++r) {
      for (int j = p_; j >= r; --j) {
        const int i = span_ - p_ + j;
        const Real low = u[i];
        ratios_[r * (p_ + 1) + j] = (t - low) / (static_cast<Real>(u[i + p_ - r + 1]) - low);
      }
    }
  }

  /// Control point of local function j = 0..p.
  int ControlPoint(int j) const { return (span_ - p_ + j) % n_; }

  /// Coordinate c of C(t): d_j^(r) = (1 - a) d_(j-1)^(r-1) + a d_j^(r-1), up to d_p^(p).
  Real Coordinate(int c) {
    for (int j = 0; j <= p_; ++j)
      work_[j] = fit_.control_points[ControlPoint(j) * fit_.dimension + c];
    for (int r = 1; r <= p_; ++r) {
      for (int j = p_; j >= r; --j) {
        const Real a = ratios_[r * (p_ + 1) + j];
        work_[j] = (1 - a) * work_[j - 1] + a * work_[j];
      }
    }
    return work_[p_];
  }

  /// The same recursion transposed: how much each of the p + 1 control points is worth in C(t).
  const std::vector<Real>& BasisValues() {
    std::fill(work_.begin(), work_.end(), 0);
    work_[p_] = 1;
    for (int r = p_; r >= 1; --r) {
      for (int j = r; j <= p_; ++j) {
        const Real a = ratios_[r * (p_ + 1) + j];
        work_[j - 1] += (1 - a) * work_[j];
        work_[j] *= a;
      }
    }
    return work_;
  }

 private:
  Real Wrapped(double t) const {
    const Real begin = fit_.knots[p_];
    const Real end = fit_.knots[last_ + 1];
    if (!fit_.periodic) return std::clamp(static_cast<Real>(t), begin, end);
    const Real turns = std::floor((t - begin) / (end - begin));
    return std::clamp(t - turns * (end - begin), begin, end);
  }

  const AuditedFit& fit_;
  int p_;
  int n_;
  int last_;  // last span; u_p..u_(last + 1) is the domain
  int span_ = 0;
  std::vector<Real> ratios_;
  std::vector<Real> work_;
};

/// |v|, without overflow where single squares do not overflow in long double.
double Norm(const std::vector<Real>& v) {
  Real sum = 0;
  for (const Real value : v) sum += value * value;
  return static_cast<double>(std::sqrt(sum));
}

/// What is summed up over the points.
struct Sums {
  Real energy = 0;
  Real squared_distance = 0;
  Real largest = 0;
  Real squared_rounding = 0;    // of the residuals: sum of w delta^2
  std::vector<Real> gradient;   // n x d
  std::vector<Real> rounding;   // its worst case, n x d
  std::vector<int> num_points;  // that each control point moves, n
  // Of the points that count, per coordinate: the run rounds in coordinates from their centre, in
  // which points near the user's origin may be far out.
  Real extent[kMostCoordinates] = {};
};

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

void AddPoint(const AuditedFit& fit, int i, DeBoor* curve, Sums* sums) {
  const int d = fit.dimension;
  const std::size_t first = static_cast<std::size_t>(i) * d;
  const Real weight = fit.weights.empty() ? 1.0 : fit.weights[i];
  curve->MoveTo(fit.parameters[i]);
  Real residual[kMostCoordinates];
  for (int c = 0; c < d; ++c) residual[c] = curve->Coordinate(c) - fit.points[first + c];
  const std::vector<Real>& basis = curve->BasisValues();
  for (int j = 0; j <= fit.degree; ++j) ++sums->num_points[curve->ControlPoint(j)];
  Real squared = 0;
  for (int c = 0; c < d; ++c) {
    squared += residual[c] * residual[c];
    Real size = std::abs(static_cast<Real>(fit.points[first + c])) + sums->extent[c];
    for (int j = 0; j <= fit.degree; ++j) {
      size += basis[j] * std::abs(fit.control_points[curve->ControlPoint(j) * d + c]);
    }
    const Real rounding = kUnitRoundoff * size;
    sums->squared_rounding += weight * rounding * rounding;
    for (int j = 0; j <= fit.degree; ++j) {
      const int entry = curve->ControlPoint(j) * d + c;
      sums->gradient[entry] += 2 * weight * basis[j] * residual[c];
      sums->rounding[entry] += 2 * weight * basis[j] * rounding;
    }
  }
  sums->energy += weight * squared;
  sums->squared_distance += squared;
  // Written so that NaN is not lost.
  if (!(squared <= sums->largest)) sums->largest = squared;
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
  DeBoor curve(fit);
  Sums sums;
  sums.gradient.assign(fit.control_points.size(), 0);
  sums.rounding.assign(fit.control_points.size(), 0);
  sums.num_points.assign(curve.num_control_points(), 0);
  MeasureExtent(fit, &sums);
  for (int i = 0; i < m; ++i) AddPoint(fit, i, &curve, &sums);

  AuditReport report;
  report.num_points = m;
  report.most_summands = *std::max_element(sums.num_points.begin(), sums.num_points.end());
  report.energy = static_cast<double>(sums.energy);
  report.gradient_norm = Norm(sums.gradient);
  report.gradient_floor = Norm(sums.rounding);
  // E(r + delta) - E(r) = 2 r'W delta + delta'W delta <= 2 |r| |delta| + |delta|^2 in W's norm.
  const Real delta = std::sqrt(sums.squared_rounding);
  report.energy_floor = static_cast<double>(2 * std::sqrt(sums.energy) * delta + delta * delta);
  report.rms_distance = m == 0 ? 0.0 : static_cast<double>(std::sqrt(sums.squared_distance / m));
  report.max_distance = static_cast<double>(std::sqrt(sums.largest));
  return report;
}

// The run computed in double what the audit computes from control points and data rounded once.
// A term B_j(t) P_j costs the run at most kRoundings: 4 for each of the p <= 9 levels of the basis
// recursion (a difference of knots, a quotient, a product, a sum), and at most 12 more for
// centring, the products and the p + 2 sums of C(t) - Q, and the weight. All of them in the worst
// direction. Sums over points add a rounding for each.
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
  const double sum_rounding = report.num_points * static_cast<double>(kUnitRoundoff);
  const double energy_allowed =
      kRoundings * (report.energy_floor + static_cast<double>(kUnitRoundoff) * report.energy) +
      sum_rounding * report.energy;
  if (!(std::abs(claim.energy - report.energy) <= energy_allowed)) {
    return Fails("energy", claim.energy, report.energy, energy_allowed);
  }
  // A gradient entry is a sum over the points that its control point moves, of terms no larger
  // than the 2 w B (|P| + |Q|) that the floor sums up.
  const double gradient_allowed = (kRoundings + report.most_summands) * report.gradient_floor;
  if (!(std::abs(claim.gradient_norm - report.gradient_norm) <= gradient_allowed)) {
    return Fails("|g|", claim.gradient_norm, report.gradient_norm, gradient_allowed);
  }
  if (!claim.minimum) return {true, ""};
  const double target = claim.gradient_target + kRoundings * report.gradient_floor;
  if (!(report.gradient_norm <= target)) {
    return {false, "claims a minimum with |g| at most " + Number(claim.gradient_target) +
                       ", but the audit finds " + Number(report.gradient_norm) +
                       " (allowed with rounding: " + Number(target) + ")"};
  }
  if (report.energy - energy_allowed > claim.start_energy) {
    return {false, "claims a minimum, but its energy " + Number(report.energy) +
                       " is above the start's " + Number(claim.start_energy)};
  }
  return {true, ""};
}

}  // namespace batten
