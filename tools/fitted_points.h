#ifndef BATTEN_TOOLS_FITTED_POINTS_H_
#define BATTEN_TOOLS_FITTED_POINTS_H_

#include <string>

#include "splines/points.h"

namespace batten {

/// Control points of a curve of this degree, closed or open, from a file that `batten fit --out`
/// has written. False with `FILE: ...` for anything else.
bool ReadFittedControlPoints(const std::string& path, int degree, bool closed, Points* points,
                             std::string* error);

}  // namespace batten

#endif  // BATTEN_TOOLS_FITTED_POINTS_H_
