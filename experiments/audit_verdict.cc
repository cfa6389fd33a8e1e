#include <cmath>
#include <sstream>
#include <string>

#include "experiments/audit.h"
#include "experiments/audit_sums.h"

namespace batten {
namespace {

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

// The run computed in double what the audit computes from control points and data rounded once.
// A term B_j(t) P_j costs the run at most kRoundings: 4 for each of the p <= 9 levels of the basis
// recursion (a difference of knots, a quotient, a product, a sum), and at most 12 more for
// centring, the products and the p + 2 sums of C(t) - Q, the weight and the loss. All of them in
// the worst direction. Sums over points add a rounding for each. The derivative by a free parameter
// has one level of the recursion less, and instead of it a quotient, a product and a difference.
constexpr double kRoundings = 4 * 9 + 12;
constexpr auto kRoundoff = static_cast<double>(AuditSums::kUnitRoundoff);

double EnergyAllowed(const AuditReport& report) {
  return kRoundings * (report.energy_floor + kRoundoff * report.energy) +
         report.num_summands * kRoundoff * report.energy;
}

Verdict VerifyNumbers(const Claim& claim, const AuditReport& report) {
  if (!std::isfinite(report.energy) ||
      (report.covers_gradient && !std::isfinite(report.gradient_norm))) {
    return {false, "claims energy " + Number(claim.energy) +
                       ", but the audit finds no finite energy and gradient"};
  }
  if (!std::isfinite(claim.energy) || !std::isfinite(claim.gradient_norm)) {
    return {false, "claims energy " + Number(claim.energy) + " and |g| " +
                       Number(claim.gradient_norm) + ", which is no result"};
  }
  return {true, ""};
}

Verdict VerifyEnergy(const Claim& claim, const AuditReport& report) {
  const double allowed = EnergyAllowed(report);
  if (std::abs(claim.energy - report.energy) <= allowed) return {true, ""};
  return Fails("energy", claim.energy, report.energy, allowed);
}

/// Constraints hold at every end, whether it is a minimum or not; conditions to what is claimed.
Verdict VerifyConstraints(const Claim& claim, const AuditReport& report) {
  if (!report.elimination_failure.empty()) return {false, report.elimination_failure};
  if (!report.worst_equation.empty() && !(report.missed <= kRoundings * report.missed_allowed)) {
    return {false, "says that constraint " + report.worst_equation +
                       " holds, but the audit finds it missed by " + Number(report.missed) +
                       " (allowed: " + Number(kRoundings * report.missed_allowed) + ")"};
  }
  const double rounding = kRoundings * report.violation_allowed;
  if (!(report.violation <= claim.violation + rounding)) {
    return {false, "claims that constraints are missed by " + Number(claim.violation) +
                       " at most, but the audit finds " + Number(report.violation) + " of " +
                       report.worst_condition + " (allowed difference " + Number(rounding) + ")"};
  }
  if (claim.minimum && !(report.violation <= claim.violation_target + rounding)) {
    return {false, "claims a minimum under constraints, but the audit finds " +
                       report.worst_condition + " missed by " + Number(report.violation) +
                       " (allowed with rounding: " + Number(claim.violation_target + rounding) +
                       ")"};
  }
  return {true, ""};
}

Verdict VerifyGradient(const Claim& claim, const AuditReport& report) {
  // A gradient entry is a sum over the points that its control point moves, of terms no larger
  // than the 2 w B (|P| + |Q|) that the floor sums up.
  const double allowed =
      (kRoundings + report.most_summands) * report.gradient_floor + report.foot_rounding;
  if (std::abs(claim.gradient_norm - report.gradient_norm) <= allowed) return {true, ""};
  return Fails("|g|", claim.gradient_norm, report.gradient_norm, allowed);
}

Verdict VerifyMinimum(const Claim& claim, const AuditReport& report) {
  const double target =
      claim.gradient_target + kRoundings * report.gradient_floor + report.foot_rounding;
  if (!(report.gradient_norm <= target)) {
    return {false, "claims a minimum with |g| at most " + Number(claim.gradient_target) +
                       ", but the audit finds " + Number(report.gradient_norm) +
                       " (allowed with rounding: " + Number(target) + ")"};
  }
  if (!(report.projected_gradient_norm <= target)) {
    return {false,
            "claims a minimum under linear constraints, but |g| projected onto what they "
            "leave is " +
                Number(report.projected_gradient_norm) +
                " (allowed with rounding: " + Number(target) + ")"};
  }
  if (!(std::hypot(report.gradient_norm, report.pull_norm) <= target)) {
    return {false,
            "claims a minimum, but E falls where parameters that are past an end of the "
            "curve move back into it: |g| of these is " +
                Number(report.pull_norm) + " (allowed: " + Number(target) + ")"};
  }
  if (report.energy - EnergyAllowed(report) > claim.start_energy) {
    return {false, "claims a minimum, but its energy " + Number(report.energy) +
                       " is above the start's " + Number(claim.start_energy)};
  }
  return {true, ""};
}

}  // namespace

Verdict Verify(const Claim& claim, const AuditReport& report) {
  const bool nothing_finite = !std::isfinite(claim.energy) && !std::isfinite(report.energy);
  if (nothing_finite && !claim.minimum) return {true, ""};
  for (const auto verify : {&VerifyNumbers, &VerifyEnergy, &VerifyConstraints}) {
    Verdict verdict = verify(claim, report);
    if (!verdict.holds) return verdict;
  }
  if (!(report.foot_excess <= report.foot_allowed)) {
    return {false, "says that points are compared at their feet, but the audit finds one that is " +
                       Number(report.foot_excess) + " nearer to another point of the curve" +
                       " (allowed: " + Number(report.foot_allowed) + ")"};
  }
  if (!report.covers_gradient) return {true, ""};
  Verdict verdict = VerifyGradient(claim, report);
  return verdict.holds && claim.minimum ? VerifyMinimum(claim, report) : verdict;
}

}  // namespace batten
