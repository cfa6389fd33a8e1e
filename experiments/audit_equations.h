#ifndef BATTEN_EXPERIMENTS_AUDIT_EQUATIONS_H_
#define BATTEN_EXPERIMENTS_AUDIT_EQUATIONS_H_

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "experiments/audit_curve.h"

namespace batten {

/// An AuditedEquation as sum of row[e] * x[e] = value in the entries e = j * d + c of the control
/// points; `sizes` is the row with all signs alike, which roundings are relative to.
struct EquationRow {
  using Real = AuditCurve::Real;
  std::map<std::size_t, Real> row;
  std::map<std::size_t, Real> sizes;
};
EquationRow MakeEquationRow(const AuditedFit& fit, const AuditedEquation& equation,
                            AuditCurve* curve);

/// Equations that share control points with each other and with no others, as dense matrices in the
/// entries that they touch, in long double.
class CoupledEquations {
 public:
  using Real = AuditCurve::Real;
  using Rows = std::vector<std::vector<Real>>;

  /// `eliminated` [e]: the run computes entry e from others.
  CoupledEquations(const std::vector<const EquationRow*>& equations,
                   const std::vector<bool>& eliminated);

  /// Empty; else a sentence: as many equations are independent as entries are eliminated, and tell
  /// these from the others. Nothing below makes sense where it is not empty.
  const std::string& failure() const { return failure_; }
  std::size_t num_independent() const { return orthonormal_.size(); }
  /// Subtracts from `gradient` its part in the span of the rows.
  void Project(std::vector<Real>* gradient) const;
  /// Gradient in the entries that stay, where the others follow them: g_F - A_F' inv(A_B') g_B; and
  /// the worst case of its rounding from that of g and one of each number of the rows. Entries that
  /// are eliminated become 0.
  void Reduce(std::vector<Real>* gradient, std::vector<Real>* rounding) const;

 private:
  void ChooseIndependent(std::size_t num_eliminated);
  void Invert();

  std::vector<std::size_t> entries_;  // touched, ascending
  std::vector<std::size_t> pivots_;   // places in entries_ of those that are eliminated
  Rows rows_;                         // each of length 1
  Rows sizes_;                        // in the same unit
  Rows orthonormal_;                  // basis of the span of the independent rows
  Rows inverse_;                      // of the pivots' columns of the independent rows: pivot x row
  std::string failure_;
};

/// Groups of equations that are coupled: indices into `rows`.
std::vector<std::vector<std::size_t>> GroupCoupled(const std::vector<EquationRow>& rows);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_AUDIT_EQUATIONS_H_
