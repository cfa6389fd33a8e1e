#ifndef BATTEN_SOLVERS_FURTHER_TERMS_H_
#define BATTEN_SOLVERS_FURTHER_TERMS_H_

#include <Eigen/SparseCore>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "problems/objective.h"
#include "splines/banded_rows.h"
#include "splines/normal_band.h"

namespace batten {

/// Whether `term` is NAME, whatever its options.
bool IsNamed(const Problem::TermInstance& term, const std::string& name);

/// A'A and A'Q of the terms that are wanted, all of compiled rows; `shape` as of the curve view.
NormalBand BandOfTerms(const Problem& problem, const RowShape& shape,
                       const std::function<bool(const Problem::TermInstance&)>& is_wanted);

/// What stands beside interpolation, for methods that give residuals of data points to control
/// points: F = sum of A'A and f = sum of A'Q over the other terms, their weights in it.
class FurtherTerms {
 public:
  /// In SolverInfo::needs: what WhyNot asks for beside compiled rows.
  static constexpr char kNeeds[] = "one interpolation term of weight 1 without weights per point";
  /// Empty, or why `objective` is not one interpolation term of weight 1, without weights per
  /// point, constraints or bounds, and any further terms of compiled rows; as one sentence.
  static std::string WhyNot(const Objective& objective, const std::string& solver_name);
  /// Of an objective that WhyNot allows: rows of its interpolation term alone. Those of the view
  /// where that is the only term, else compiled into *own, which must outlive them.
  static const BandedRows& InterpolationRows(Objective* objective, std::optional<BandedRows>* own);

  FurtherTerms() = default;  ///< None.
  /// `objective` as WhyNot allows.
  explicit FurtherTerms(Objective* objective);

  /// There is no other term, or none weighs anything.
  bool empty() const { return !band_.has_value(); }
  // Not where empty():
  /// sum_k |F_jk|, n of them.
  std::vector<double> RowSums() const { return band_->AbsoluteRowSums(); }
  /// pull = f - F P, n x d, P n x d row-major.
  void Pull(const double* control_points, Points* pull) const;
  /// F, n x n.
  Eigen::SparseMatrix<double, Eigen::RowMajor> ToSparse() const;

 private:
  std::optional<NormalBand> band_;
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_FURTHER_TERMS_H_
