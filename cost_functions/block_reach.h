#ifndef BATTEN_COST_FUNCTIONS_BLOCK_REACH_H_
#define BATTEN_COST_FUNCTIONS_BLOCK_REACH_H_

#include "cost_functions/block_family.h"
#include "splines/bspline_basis.h"

namespace batten {

/// How far apart the control points of one residual block of a term are at most; on closed curves
/// the shorter way around counts. Blocks must depend on control points alone, as a whole each;
/// `any` is any x.
int LargestReach(const BsplineBasis& basis, int dimension, const BlockFamily& term,
                 const Eigen::VectorXd& any);

}  // namespace batten

#endif  // BATTEN_COST_FUNCTIONS_BLOCK_REACH_H_
