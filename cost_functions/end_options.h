#ifndef BATTEN_COST_FUNCTIONS_END_OPTIONS_H_
#define BATTEN_COST_FUNCTIONS_END_OPTIONS_H_

#include <limits>
#include <string>
#include <vector>

#include "cost_functions/options.h"
#include "splines/points.h"

namespace batten {

/// A coordinate that its option does not give.
inline constexpr double kNotGiven = std::numeric_limits<double>::infinity();

/// end=both|begin|end.
OptionInfo EndOption();

/// x, y, z, w, each kNotGiven by default; `of_what` stands behind "coordinate x" in their help.
void AddCoordinateOptions(const std::string& of_what, std::vector<OptionInfo>* options);

/// The values of x, y, ... of a curve of this dimension. False, and *beyond the name of a
/// coordinate, if one is given that the curve does not have.
bool GivenCoordinates(const OptionValues& options, int dimension, Eigen::RowVectorXd* given,
                      std::string* beyond);

}  // namespace batten

#endif  // BATTEN_COST_FUNCTIONS_END_OPTIONS_H_
