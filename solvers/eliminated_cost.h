#ifndef BATTEN_SOLVERS_ELIMINATED_COST_H_
#define BATTEN_SOLVERS_ELIMINATED_COST_H_

#include <ceres/cost_function.h>

#include <memory>
#include <vector>

#include "problems/linear_elimination.h"
#include "solvers/variable_groups.h"

namespace batten {

/// Residual blocks of a problem written in the free variables y of x = offset + Z y.
class FreeGroups {
 public:
  /// `all`: the groups of x that residual blocks ask for. Both arguments must outlive this.
  FreeGroups(const LinearElimination& elimination, const VariableGroups& all);

  /// Groups of y: what is left of each group of x, in pieces where a variable in between is
  /// determined by others.
  const VariableGroups& groups() const { return groups_; }

  /// `cost`, a block of the groups of x that begin at `begins`, as a block of groups of y, where
  /// they begin in `begins` now. A block that no constraint touches stays as it is.
  std::unique_ptr<ceres::CostFunction> Rewrite(std::unique_ptr<ceres::CostFunction> cost,
                                               std::vector<int>* begins) const;

 private:
  /// All variables of the group stay, together.
  bool IsWhole(int begin) const;

  const LinearElimination& elimination_;
  const VariableGroups& all_;
  VariableGroups groups_;
  std::vector<int> free_index_;  // of each x; -1: determined by others
  Eigen::VectorXd offset_;
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_ELIMINATED_COST_H_
