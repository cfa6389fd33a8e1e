#ifndef BATTEN_PROBLEMS_CURVE_CONSTRAINTS_H_
#define BATTEN_PROBLEMS_CURVE_CONSTRAINTS_H_

#include <string>
#include <vector>

#include "cost_functions/options.h"
#include "problems/linear_elimination.h"

namespace batten {

class CurveFit;

/// What a hard constraint on a curve may be, in the grammar of names and options:
///   point/t=0.25/x=1/y=2          C(t) = (x, y); coordinates that are not given stay free
///   derivative/t=0/order=1/x=3    C^(order)(t)
///   ends                          an open curve begins and ends in its first and last data point
///   natural                       C'' = 0 at both ends (option end=begin|end for one)
///   clamped                       C' is Bessel's tangent at both ends (end=, x=, y=, ... as above)
///   not-a-knot                    C^(p) does not jump at the first and the last inner knot
///   periodic                      C^(k), k = 0..p - 1, is the same at both ends of an open curve
/// t in the domain; lengths in the user's units.
struct ConstraintInfo {
  std::string name;
  std::string summary;
  std::vector<OptionInfo> options;
};
std::vector<ConstraintInfo> KnownConstraints();

/// False with one sentence in `error` (found, allowed) for an unknown name, option or value.
bool CheckConstraint(const NameSpec& spec, std::string* error);

/// Appends the linear constraints of `specs` in the variables of a fit whose basis, setting and
/// data are there; each is named after its text and coordinate. False with one sentence in `error`
/// for what the curve at hand cannot meet: a parameter outside the domain, an order above the
/// degree, ends of a closed curve, a coordinate that the data do not have.
bool AppendCurveConstraints(const std::vector<NameSpec>& specs, const CurveFit& fit,
                            std::vector<LinearConstraint>* constraints, std::string* error);

}  // namespace batten

#endif  // BATTEN_PROBLEMS_CURVE_CONSTRAINTS_H_
