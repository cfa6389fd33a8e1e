#ifndef BATTEN_EXPERIMENTS_AUDITED_CONSTRAINTS_H_
#define BATTEN_EXPERIMENTS_AUDITED_CONSTRAINTS_H_

#include <Eigen/Core>

#include "experiments/audit.h"
#include "problems/problem.h"

namespace batten {

/// Writes the constraints of `problem`, a curve fit, at its variables x into `plain`, as
/// docs/constraints.md defines them, and which control points' coordinates the run eliminates.
/// Needs the knots, the dimension and the points of `plain`.
void AddConstraints(const Problem& problem, const Eigen::VectorXd& x, AuditedFit* plain);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_AUDITED_CONSTRAINTS_H_
