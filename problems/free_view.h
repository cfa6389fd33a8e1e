#ifndef BATTEN_PROBLEMS_FREE_VIEW_H_
#define BATTEN_PROBLEMS_FREE_VIEW_H_

#include <memory>
#include <vector>

#include "problems/problem.h"
#include "splines/normal_band.h"

namespace batten {

/// A problem E(P, t) = sum_i w_i |C(t_i) - Q_i|^2 + ||A P - B||^2 with the parameters t as
/// variables, as methods see it that know this structure: one free_parameter term, with or without
/// a loss, any number of terms that are compiled rows, and linear constraints that bind control
/// points to each other or hold parameters. Beside them any terms in control points that are no
/// compiled rows, not being affine or having a loss. Or the same with t projected (one foot_point
/// term): P alone is variable then, and methods keep t behind it in vectors of their own.
class FreeView {
 public:
  /// Null for any other problem.
  static std::unique_ptr<FreeView> Make(const Problem& problem);

  const FreeSites& sites() const { return *sites_; }
  bool projected() const { return sites_->projected; }
  int num_points() const { return static_cast<int>(sites_->weights.size()); }  // m
  int num_control_points() const { return sites_->basis->num_control_points(); }
  int dimension() const { return sites_->dimension; }
  /// Whether t_i is given by a constraint.
  bool is_held(int i) const { return !held_.empty() && held_[static_cast<std::size_t>(i)] != 0; }
  /// Z of P = offset + Z y, n d x n' in coordinates, where constraints bind control points; the y
  /// are coordinates that stay. Null where they do not.
  const SparseRows* control_point_map() const { return map_.rows() == 0 ? nullptr : &map_; }
  /// Coordinates of control points among the free variables: n d or n'.
  int num_free_coordinates() const {
    return map_.rows() == 0 ? num_control_points() * dimension() : static_cast<int>(map_.cols());
  }
  /// Control points and parameters behind all variables x of the problem. Projected ones are as
  /// they may be: they are to be searched.
  Eigen::VectorXd WithParameters(const Eigen::VectorXd& x) const;
  /// The problem's variables among these.
  Eigen::VectorXd WithoutParameters(const Eigen::VectorXd& all) const;
  /// A'A and A'B of the other terms; null where there are none.
  const NormalBand* other_terms() const { return other_terms_.get(); }
  /// Terms in control points alone that are no compiled rows, such as curve_fairing, and those with
  /// a loss; each of their blocks depends on p + 1 neighbours at most.
  const std::vector<const BlockFamily*>& curved_terms() const { return curved_terms_; }

 private:
  FreeView() = default;
  /// False if constraints do anything else than bind control points and hold parameters.
  bool ReadConstraints(const Problem& problem);
  /// Whether the blocks of a term depend on p + 1 neighbouring control points and nothing else.
  bool IsOnControlPoints(const BlockFamily& term, const Eigen::VectorXd& any) const;

  const FreeSites* sites_ = nullptr;
  std::vector<char> held_;  // empty: none
  SparseRows map_;          // no rows: the identity
  std::unique_ptr<const NormalBand> other_terms_;
  std::vector<const BlockFamily*> curved_terms_;
};

}  // namespace batten

#endif  // BATTEN_PROBLEMS_FREE_VIEW_H_
