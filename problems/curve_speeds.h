#ifndef BATTEN_PROBLEMS_CURVE_SPEEDS_H_
#define BATTEN_PROBLEMS_CURVE_SPEEDS_H_

#include <string>
#include <vector>

#include "cost_functions/curve_condition.h"
#include "problems/problem.h"

namespace batten {

/// Whether the linear constraints of the problem leave curves that move where curvatures are to
/// hold: at t, or somewhere, where t is found. A curve that stands still, as one that constraints
/// make a single point, has none. Else false, with one sentence in `error` that names them;
/// `linear` are those that the problem's elimination was made of, `setting` and `conditions` the
/// fit's.
bool CheckSpeeds(const FitSetting& setting, const std::vector<CurveCondition>& conditions,
                 const Problem& problem, const std::vector<LinearConstraint>& linear,
                 std::string* error);

}  // namespace batten

#endif  // BATTEN_PROBLEMS_CURVE_SPEEDS_H_
