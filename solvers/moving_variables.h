#ifndef BATTEN_SOLVERS_MOVING_VARIABLES_H_
#define BATTEN_SOLVERS_MOVING_VARIABLES_H_

#include <Eigen/Core>
#include <string>
#include <vector>

#include "problems/problem.h"

namespace batten {

/// Why the windows of `problem` cannot be bounds of its free variables, as a sentence for
/// WhyUnsupported; empty: they can, or there are none.
std::string WhyNoWindows(const Problem& problem, const std::string& solver_name);

/// The free variables y of a problem whose residual blocks are bound to a window around them and
/// must be bound anew beyond it, as Ceres needs it, whose problem cannot change while it runs.
class MovingVariables {
 public:
  /// Moves them into their windows at *y: those of closed curves by whole periods, those of open
  /// ones from past an end to it. `problem` must meet WhyNoWindows.
  MovingVariables(const Problem& problem, Eigen::VectorXd* y);

  /// Their windows, `variable` counted in y; none that a constraint holds.
  const std::vector<BindingWindow>& windows() const { return windows_; }
  bool empty() const { return windows_.empty(); }

  /// One has come to a side of its window since: to one beyond which another binding leads on, or
  /// to the end of an open curve that it was not at.
  bool AnyHasArrived(const Eigen::VectorXd& y) const;
  /// Those at the end of an open curve past which E still falls: d E / d y = gradient there.
  std::vector<int> Pressed(const Eigen::VectorXd& y, const Eigen::VectorXd& gradient) const;
  bool AnyIsAtAnEnd() const;  ///< Of an open curve, when they were moved into their windows.

 private:
  std::vector<BindingWindow> windows_;
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_MOVING_VARIABLES_H_
