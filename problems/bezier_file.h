#ifndef BATTEN_PROBLEMS_BEZIER_FILE_H_
#define BATTEN_PROBLEMS_BEZIER_FILE_H_

#include <string>
#include <vector>

#include "problems/svg_file.h"

namespace batten {

/// Reads curves to be subdivided (docs/formats.md), by the file's name:
///
/// - `.json`: a fit.json, whose spline becomes its Bezier spans over the spline's own parameters,
/// or
///   an object with `control_points`, one Bezier curve over [0, 1];
/// - `.svg`: ReadSvgPaths(), which says in `left_out` what else is drawn there; "" for other files;
/// - any other, and `-` for standard input: ReadDataSet(), the points being the control points of
///   one Bezier curve of degree 0 to 60.
///
/// False with one sentence in `error` that names the file and the place in it.
bool ReadBezierFile(const std::string& path, std::vector<BezierPath>* paths, std::string* left_out,
                    std::string* error);

/// The larger side of the box of all control points; infinite where that is no double.
double BoxSideOf(const std::vector<BezierPath>& paths);

}  // namespace batten

#endif  // BATTEN_PROBLEMS_BEZIER_FILE_H_
