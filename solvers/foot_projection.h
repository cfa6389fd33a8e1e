#ifndef BATTEN_SOLVERS_FOOT_PROJECTION_H_
#define BATTEN_SOLVERS_FOOT_PROJECTION_H_

#include "problems/objective.h"

namespace batten {

/// Sets the parameters among all variables `all` to the foot points on the curve of its control
/// points, held ones excepted; counted as one projection at `free`. kNonFinite: `all` is no curve.
Status ProjectParameters(Objective* objective, int threads, const Eigen::VectorXd& free,
                         Eigen::VectorXd* all);

}  // namespace batten

#endif  // BATTEN_SOLVERS_FOOT_PROJECTION_H_
