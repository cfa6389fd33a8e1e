#ifndef BATTEN_PROBLEMS_SVG_FILE_H_
#define BATTEN_PROBLEMS_SVG_FILE_H_

#include <string>
#include <vector>

#include "problems/svg_path.h"

namespace batten {

/// The path data of all `path` elements that an SVG file draws, or of a file that holds nothing but
/// path data (ParseSvgPath()). What is never drawn where it stands (`defs`, `clipPath`, ...,
/// anything with display none) is passed over. `left_out` receives the other elements that draw
/// something, as in "circle (2), text (1)", else "".
///
/// False with `FILE:LINE:COLUMN: found ...; allowed: ...` for XML that is not well-formed, for path
/// data that are not, and for a transform of a path or of what it stands in, by an attribute or a
/// style, since none is applied.
bool ReadSvgPaths(const std::string& path, std::vector<BezierPath>* paths, std::string* left_out,
                  std::string* error);

}  // namespace batten

#endif  // BATTEN_PROBLEMS_SVG_FILE_H_
