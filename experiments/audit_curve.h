#ifndef BATTEN_EXPERIMENTS_AUDIT_CURVE_H_
#define BATTEN_EXPERIMENTS_AUDIT_CURVE_H_

#include <vector>

#include "experiments/audit.h"

namespace batten {

/// The curve of an AuditedFit, point by point in long double. Notation of de Boor 1972: k = order,
/// knots u, control points d_j; d_j^(r) are the points of level r. Curve point, basis values and
/// the derivative's weights come from one table of the recursion's ratios.
class AuditCurve {
 public:
  using Real = long double;

  /// Keeps a reference to `fit`.
  explicit AuditCurve(const AuditedFit& fit);

  int num_control_points() const { return n_; }
  Real domain_begin() const { return fit_.knots[p_]; }
  Real domain_end() const { return fit_.knots[last_ + 1]; }

  /// Moves to parameter t: finds the span and fills the table of ratios. A t on a knot belongs to
  /// the span that begins there (at the domain's end: to the one before), so that derivatives that
  /// jump there, of degree 1 or at multiple knots, are those to the right, as in the run.
  void MoveTo(Real parameter);

  /// Control point of local function j = 0..p.
  int ControlPoint(int j) const { return (span_ - p_ + j) % n_; }

  /// Coordinate c of C(t): d_j^(r) = (1 - a) d_(j-1)^(r-1) + a d_j^(r-1), up to d_p^(p).
  Real Coordinate(int c);

  /// The same recursion transposed: how much each of the p + 1 control points is worth in C(t).
  const std::vector<Real>& BasisValues();

  /// C'(t) = sum over j = 1..p of W_j (P_j - P_(j-1)), W_j = p B_j / (u_(i+p) - u_i) with i the
  /// index of P_j and B_j its function of degree p - 1. Entry 0 is 0.
  const std::vector<Real>& DerivativeWeights();

  /// How much each of the p + 1 control points is worth in C^(k)(t), k = 0..p: the differences
  /// Q_j^(r) = (p - r + 1) / (u_(i+p-r+1) - u_i) (Q_j^(r-1) - Q_(j-1)^(r-1)), r = 1..k, transposed.
  /// `sizes`: the same with all signs alike, which roundings are relative to.
  void DerivativeRow(int k, std::vector<Real>* row, std::vector<Real>* sizes);

 private:
  Real Wrapped(Real t) const;
  /// Into work_: from what the points of level p are worth down to those of level `lowest`.
  void Transpose(int lowest);

  const AuditedFit& fit_;
  int p_;
  int n_;
  int last_;  // last span; u_p..u_(last + 1) is the domain
  int span_ = 0;
  std::vector<Real> ratios_;
  std::vector<Real> work_;
};

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_AUDIT_CURVE_H_
