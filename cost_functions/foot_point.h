#ifndef BATTEN_COST_FUNCTIONS_FOOT_POINT_H_
#define BATTEN_COST_FUNCTIONS_FOOT_POINT_H_

#include <memory>

#include "cost_functions/term.h"

namespace batten {

/// The term `foot_point`: r_i = sqrt(w_i) (C(t_i) - Q_i) with t_i the foot point of Q_i, so that
/// its energy is sum_i w_i (distance of Q_i from the curve)^2. One block per data point, d
/// residuals. docs/terms/foot_point.md.
std::unique_ptr<Term> MakeFootPointTerm();

}  // namespace batten

#endif  // BATTEN_COST_FUNCTIONS_FOOT_POINT_H_
