#ifndef BATTEN_EXPERIMENTS_CURVE_RECORDS_H_
#define BATTEN_EXPERIMENTS_CURVE_RECORDS_H_

#include <string>

#include "experiments/run.h"
#include "problems/fit_problem.h"

namespace batten {

// What the curves of runs are drawn from, as `compare` and `bench` keep it (docs/formats.md).

/// The same for all runs on a problem, one JSON object: the spline's degree and knots, the data
/// points in the user's units, every k-th where there are more than 1,000.
std::string CurveJson(const CurveFit& fit);

/// The line of an iterate: {"iteration", "control_points"}, in the user's units; what is no finite
/// number is null.
std::string ControlPointsJsonLine(const CurveFit& fit, const Iterate& iterate);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_CURVE_RECORDS_H_
