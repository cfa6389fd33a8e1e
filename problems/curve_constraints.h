#ifndef BATTEN_PROBLEMS_CURVE_CONSTRAINTS_H_
#define BATTEN_PROBLEMS_CURVE_CONSTRAINTS_H_

#include <string>
#include <vector>

#include "cost_functions/curve_condition.h"
#include "cost_functions/options.h"
#include "problems/linear_elimination.h"

namespace batten {

class CurveFit;

/// What a hard constraint on a curve may be, in the grammar of names and options:
///   point/t=0.25/x=1/y=2          C(t) = (x, y); coordinates that are not given stay free
///   tangent/t=0.25/x=1/y=2        C'(t) = s (x, y), s > 0
///   curvature/t=0.25/kappa=2      of the curve at t, signed in the plane
///   derivative/t=0/order=1/x=3    C^(order)(t)
///   ends                          an open curve begins and ends in its first and last data point
///   natural                       C'' = 0 at both ends (option end=begin|end for one)
///   clamped                       C' is Bessel's tangent at both ends (end=, x=, y=, ... as above)
///   not-a-knot                    C^(p) does not jump at the first and the last inner knot
///   periodic                      C^(k), k = 0..p - 1, is the same at both ends of an open curve
/// t in the domain; lengths in the user's units. point, tangent, curvature and derivative (of order
/// 1 or 2) also take free=N instead of t: they hold at one parameter that is found, number N of the
/// fit's, 1 to 99, the same for all constraints with this number; t, if it is given, is where it
/// starts.
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

/// Name of the variables that are parameters at which constraints hold.
inline constexpr const char* kConstraintParameters = "constraint_parameters";

/// What of `specs` is not linear, or an inequality: conditions in the variables of the fit and,
/// behind `num_variables` others, of one parameter for each number N that is used. `start` gets
/// where these begin: at t, or where the curve through the `control_points` (scaled) misses its
/// conditions least. Names and options as above are checked already.
struct CurveConditions {
  std::vector<CurveCondition> conditions;
  Eigen::VectorXd start;
};
bool MakeCurveConditions(const std::vector<NameSpec>& specs, const CurveFit& fit, int num_variables,
                         const Eigen::VectorXd& control_points, CurveConditions* made,
                         std::string* error);

/// Whether the constraint of this name holds at one parameter, which may be one that is found.
bool IsAtAParameter(const std::string& name);

/// Checked options of one of KnownConstraints(); false with one sentence in `error`.
bool ResolveConstraint(const NameSpec& spec, OptionValues* options, std::string* error);

}  // namespace batten

#endif  // BATTEN_PROBLEMS_CURVE_CONSTRAINTS_H_
