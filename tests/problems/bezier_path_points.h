#ifndef BATTEN_TESTS_PROBLEMS_BEZIER_PATH_POINTS_H_
#define BATTEN_TESTS_PROBLEMS_BEZIER_PATH_POINTS_H_

#include <cstddef>
#include <vector>

#include "problems/svg_path.h"

namespace batten {

/// The control points of one span of one path.
inline const Points& PointsAt(const std::vector<BezierPath>& paths, std::size_t path,
                              std::size_t span) {
  return paths.at(path).spans.at(span).curve.control_points();
}

}  // namespace batten

#endif  // BATTEN_TESTS_PROBLEMS_BEZIER_PATH_POINTS_H_
