#ifndef BATTEN_COST_FUNCTIONS_BESSEL_TANGENTS_H_
#define BATTEN_COST_FUNCTIONS_BESSEL_TANGENTS_H_

#include <optional>

#include "cost_functions/fit_setting.h"

namespace batten {

/// Mean of the data points whose parameter is nearest to the domain's begin or end, 1 x d in the
/// user's units.
Eigen::RowVectorXd EndDatum(const FitSetting& setting, bool at_end);

/// dC/du at the domain's begin or end, 1 x d in the user's units: that of the parabola through the
/// three data points with the first or last three different parameters, at the end of the domain
/// (Bessel; Farin, Curves and Surfaces for CAGD, sec. 9.8). Of two points the straight line's.
/// Points of equal parameters count as their mean. Nothing where all parameters are equal.
std::optional<Eigen::RowVectorXd> BesselTangent(const FitSetting& setting, bool at_end);

}  // namespace batten

#endif  // BATTEN_COST_FUNCTIONS_BESSEL_TANGENTS_H_
