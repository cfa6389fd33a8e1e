#ifndef BATTEN_PROBLEMS_CUT_PROBLEM_H_
#define BATTEN_PROBLEMS_CUT_PROBLEM_H_

#include <memory>
#include <string>

#include "problems/problem.h"
#include "splines/bezier_cut_value.h"

namespace batten {

/// Where to cut `curve`, as a problem of one variable, "cut", the place u in (0, 1): E(u) is
/// CutValue(measure), the sum of squares of the residuals in cost_functions/bezier_cut.h. Outside
/// (0, 1) E is not finite, so that line searches turn back. The curve is taken over the power of
/// two that brings its largest coordinate to [1, 2); Problem::units() says so. Null with one
/// sentence in `error` for a degree below 2, a start outside (0, 1), and the hull's area of a curve
/// that is not planar.
std::unique_ptr<Problem> MakeCutProblem(CutMeasure measure, const BezierCurve& curve, double start,
                                        std::string* error);

}  // namespace batten

#endif  // BATTEN_PROBLEMS_CUT_PROBLEM_H_
