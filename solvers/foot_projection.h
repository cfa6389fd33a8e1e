#ifndef BATTEN_SOLVERS_FOOT_PROJECTION_H_
#define BATTEN_SOLVERS_FOOT_PROJECTION_H_

#include "problems/objective.h"

namespace batten {

/// Control points and parameters at the free variables x, and back. Where parameters are projected
/// they stand behind the problem's variables, and are to be searched.
Eigen::VectorXd AllWithParameters(const Objective& objective, const Eigen::VectorXd& x);
Eigen::VectorXd FreeVariablesOf(const Objective& objective, const Eigen::VectorXd& all);
/// The same into *free, which is allocated only if it has another size.
void FreeVariablesOf(const Objective& objective, const Eigen::VectorXd& all, Eigen::VectorXd* free);

/// Sets the parameters in `all` to the foot points on the curve of its control points, held ones
/// excepted; counted as one projection at the free variables `free`. kNonFinite: `all` is no curve.
Status ProjectParameters(Objective* objective, int threads, const Eigen::VectorXd& free,
                         Eigen::VectorXd* all);

}  // namespace batten

#endif  // BATTEN_SOLVERS_FOOT_PROJECTION_H_
