#ifndef BATTEN_PROBLEMS_SVG_PATH_H_
#define BATTEN_PROBLEMS_SVG_PATH_H_

#include <string>
#include <string_view>
#include <vector>

#include "splines/bezier_conversion.h"

namespace batten {

/// A connected run of Bezier curves: curve i stands for [i, i + 1] where nothing else is said.
struct BezierPath {
  std::vector<BezierSpan> spans;
};

/// Reads path data in the grammar of SVG 1.1, sec. 8.3: M, L, H, V, C, S, Q, T and Z in both cases,
/// as straight lines, quadratics and cubics; y as it stands there, downwards. One path per M; a Z
/// adds a line unless the path ends where it began; paths without a curve are left out. False with
/// one sentence in `error`, which begins with the 0-based place in *offset, for anything else; arcs
/// (A) are no Bezier curves and refused.
bool ParseSvgPath(std::string_view text, std::vector<BezierPath>* paths, std::size_t* offset,
                  std::string* error);

}  // namespace batten

#endif  // BATTEN_PROBLEMS_SVG_PATH_H_
