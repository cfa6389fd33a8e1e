#ifndef BATTEN_EXPERIMENTS_AUDIT_H_
#define BATTEN_EXPERIMENTS_AUDIT_H_

#include <limits>
#include <string>
#include <vector>

namespace batten {

/// What a free parameter is to the gradient.
enum class ParameterState : char {
  kMoves,
  kHeld,    ///< By a constraint: it is no variable.
  kPastEnd  ///< Of an open curve: the run has it past an end, where E does not change with it.
};

/// A robust loss rho(s) of the squared norm s = |r|^2, b = scale^2 (Huber 1964; Beaton & Tukey
/// 1974; Cauchy and soft L1 as in Triggs et al., Bundle Adjustment, 2000):
///   none    s
///   huber   s up to b, beyond it 2 sqrt(b s) - b
///   cauchy  b log(1 + s / b)
///   tukey   b / 3 (1 - (1 - s / b)^3) up to b, beyond it b / 3
///   soft_l1 2 b (sqrt(1 + s / b) - 1)
struct AuditedLoss {
  enum class Kind : char { kNone, kHuber, kCauchy, kTukey, kSoftL1 };
  Kind kind = Kind::kNone;
  double scale = 1.0;  ///< In the user's unit of what |r| is.
};

/// A term: factor * sum over the data points of rho(w_i |C(t_i) - Q_i|^2).
struct AuditedDistance {
  double factor = 1.0;
  AuditedLoss loss = AuditedLoss();
};

/// A term: factor times the integral of |C^(k)(t)|^2 over the domain.
struct AuditedIntegral {
  int derivative = 2;  ///< k, 1 to the degree.
  double factor = 1.0;
  std::vector<double> span_factors;  ///< Of the spans that are not empty; none: all 1.
};

/// A term: factor times Gauss and Legendre's sum, with so many points a span, for the integral over
/// the arc length s of kappa^2 or, `variation`, of |d(kappa b) / ds|^2, b the binormal.
struct AuditedBending {
  bool variation = false;
  int points = 4;
  double factor = 1.0;
  std::vector<double> span_factors;  ///< As AuditedIntegral's.
};

/// A term: factor * rho(|C^(k)(t) - value|^2) at the begin or the end t of an open curve's domain.
struct AuditedEnd {
  bool at_end = false;
  int derivative = 0;  ///< k, 0 to the degree.
  double factor = 1.0;
  std::vector<double> value;  ///< d
  AuditedLoss loss = AuditedLoss();
};

/// A linear constraint: sum over the parts of factor * direction . C^(derivative)(t) = value.
struct AuditedEquation {
  struct Part {
    double t = 0.0;
    int derivative =
        0;  ///< 0 to the degree; on a knot the one to the right, at the end to the left
    double factor = 1.0;
  };
  std::string name;
  std::vector<Part> parts;
  std::vector<double> direction;  ///< d
  double value = 0.0;
};

/// A constraint that is not linear, or an inequality, at one parameter.
struct AuditedCondition {
  enum class Kind : char {
    kPoint,     ///< C^(order)(t) = value in the coordinates that are finite there.
    kTangent,   ///< C'(t) along the unit vector `value`, at least `amount` / length of the domain.
    kCurvature  ///< Of C at t is `amount`, signed in the plane.
  };
  Kind kind = Kind::kPoint;
  std::string name;
  double t = 0.0;
  std::vector<double> value;  ///< d
  double amount = 0.0;
  double unit = 1.0;  ///< Of a curvature: what its difference is multiplied by to be a length.
  int order = 0;      ///< Of the derivative that kPoint holds.
};

/// A fitted curve as plain numbers, in the user's units: all the audit knows. The
/// evaluator shares no code with the folder splines/; Bessel tangents, values that a term or a
/// constraint asks for, are taken from it.
struct AuditedFit {
  int degree = 0;
  bool periodic = false;
  int dimension = 0;
  std::vector<double> knots;
  std::vector<double> control_points;  // n x d, row-major
  std::vector<double> points;          // m x d
  std::vector<double> parameters;      // m
  std::vector<double> weights;         // m, or empty: all 1
  std::vector<AuditedDistance> distances = std::vector<AuditedDistance>(1);
  std::vector<AuditedIntegral> integrals;
  std::vector<AuditedBending> bendings;
  std::vector<AuditedEnd> ends;
  /// Of free parameters, m; empty: they are fixed. Those past an end are given as that end.
  std::vector<ParameterState> parameter_states;
  /// Where the order of free ones is kept: block of each point, in the order of the points but for
  /// block 0, which the last ones may belong to. Points of one block share one parameter. Empty:
  /// all are their own.
  std::vector<int> parameter_blocks;
  /// The parameters are said to be the foot points, which is checked.
  bool at_foot_points = false;
  /// Of free ones: |g| is the gradient in (P, length * t), all of one unit.
  double length = 1.0;
  /// Constraints on the control points. `eliminated` are the entries j * d + c that the run
  /// computes from the others by the equations: |g| is the gradient in those others.
  std::vector<AuditedEquation> equations;
  std::vector<int> eliminated;
  /// With any, |g| is that of a Lagrangian, which the audit does not know.
  std::vector<AuditedCondition> conditions;
};

/// E, g and distances of a fit, recomputed by de Boor's recursion in long double, point by point.
struct AuditReport {
  double energy = 0.0;  // of distances, integrals and ends
  /// Of E with respect to the control points that are not eliminated and, of free parameters,
  /// length * t of those that move. NaN where it is not audited: under conditions.
  double gradient_norm = 0.0;
  bool covers_gradient = true;
  /// The same, but projected onto what the equations leave of all control points: never longer,
  /// and it knows nothing of which ones are eliminated.
  double projected_gradient_norm = 0.0;
  /// Beside it: of parameters past an end that E draws back into the domain. 0 at a minimum.
  double pull_norm = 0.0;
  int num_sharing = 0;        ///< Points that share their parameter because their order is kept.
  double energy_floor = 0.0;  // what rounding control points and data to double is worth in E,
  double gradient_floor =
      0.0;                    // and in |g|: one rounding of each number, all in the worst direction
  double rms_distance = 0.0;  // over the points, at their parameters, not weighted
  double max_distance = 0.0;
  /// Of parameters that are to be foot points: the largest by which a sampled point of the curve is
  /// nearer to a data point than C(t) is, and what rounding allows of it.
  double foot_excess = 0.0;
  double foot_allowed = 0.0;
  /// What the rounding of feet is worth in |g|: E falls along t by a slope that is not quite 0
  /// there, and t follows the control points or not.
  double foot_rounding = 0.0;
  /// The equation that is missed by most in parts of what rounding allows; none: an empty name.
  std::string worst_equation;
  double missed = 0.0;  // by it
  double missed_allowed = 0.0;
  /// Empty; else a sentence of how many independent equations there are and how many control
  /// points' coordinates the run eliminates instead.
  std::string elimination_failure;
  /// By which the conditions are missed at most, a length (docs/constraints.md), what rounding
  /// allows of it, and of which. Of d - 1 normals of a direction that nobody knows the largest part
  /// is taken to be as small as it can be.
  double violation = 0.0;
  double violation_allowed = 0.0;
  std::string worst_condition;
  int num_summands = 0;   // of E: m points and the places where other terms are evaluated
  int most_summands = 0;  // largest number of them that one control point moves
};
AuditReport Audit(const AuditedFit& fit);
/// Fills in foot_excess and foot_allowed: plain comparisons with points sampled on every span, as
/// many as a bound of the work leaves.
void AuditFeet(const AuditedFit& fit, AuditReport* report);

/// What a run claims about its end.
struct Claim {
  double energy = 0.0;
  double gradient_norm = 0.0;
  bool minimum = false;  // it says it reached gradient_target or the rounding floor
  double gradient_target = 0.0;
  double start_energy = std::numeric_limits<double>::quiet_NaN();  // NaN: not known
  double violation = 0.0;                                          // of the conditions
  double violation_target = 0.0;                                   // what a minimum may have of it
};

struct Verdict {
  bool holds = false;
  std::string failure;  // one sentence: what was claimed, what was found
};
/// Compares claim and report within what rounding allows; tolerances are stated in the .cc.
Verdict Verify(const Claim& claim, const AuditReport& report);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_AUDIT_H_
