#ifndef BATTEN_EXPERIMENTS_BEZIER_PAPER_CURVES_H_
#define BATTEN_EXPERIMENTS_BEZIER_PAPER_CURVES_H_

#include <string>
#include <vector>

#include "splines/bezier.h"

namespace batten {

/// The degrees of the paper's table.
inline constexpr int kPaperDegrees[] = {12, 13, 16, 17, 18, 19, 20, 22, 24, 25};

/// What curves are drawn from: "uniform", control points uniform in a square; "walk", a walk of
/// steps uniform in a square; "wave", points of a sine of random amplitude, frequency and phase at
/// equal distances. None looks at how a rule does on the curve.
const std::vector<std::string>& CurveFamilies();

/// Curve `number` of a family and degree: the same on any machine.
BezierCurve FamilyCurve(const std::string& family, int degree, int number);

/// All curves of data/glyphs/NAME.svg but the straight lines, whatever their degree. False with one
/// sentence in `error`.
bool GlyphCurves(const std::string& name, std::vector<BezierCurve>* curves, std::string* error);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_BEZIER_PAPER_CURVES_H_
