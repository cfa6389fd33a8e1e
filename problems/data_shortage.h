#ifndef BATTEN_PROBLEMS_DATA_SHORTAGE_H_
#define BATTEN_PROBLEMS_DATA_SHORTAGE_H_

#include <string>

#include "problems/fit_problem.h"

namespace batten {

/// Which control points have fewer distinct parameters of data points with weight than their
/// number, so that the data alone cannot place them (Schoenberg & Whitney): "control points 5 to 9
/// have 2 distinct parameters for 5". Empty where there are none.
std::string DataShortageText(const CurveFit& fit);

}  // namespace batten

#endif  // BATTEN_PROBLEMS_DATA_SHORTAGE_H_
