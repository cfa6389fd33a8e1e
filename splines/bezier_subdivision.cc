#include "splines/bezier_subdivision.h"

#include "splines/bezier_loops.h"
#include "splines/bezier_measures.h"

namespace batten {
namespace {

std::string Explanation(const Subdivision& result, const SubdivisionOptions& options,
                        const StopTest& test) {
  std::string text = std::to_string(result.num_failing) + " of " +
                     std::to_string(result.num_pieces()) + " pieces do not pass: ";
  if (result.end == SubdivisionEnd::kDepthLimit) {
    text += "the bound on depth, 2^-" + std::to_string(options.max_depth) +
            " of the curve's interval, was hit";
  } else if (result.end == SubdivisionEnd::kPieceLimit) {
    text += "the bound of " + std::to_string(options.max_pieces) + " pieces was hit";
  } else {
    text.clear();
  }
  if (!test.is_raised()) return text;
  return text + (text.empty() ? "" : "; ") + "the tolerance is below rounding and was raised to it";
}

}  // namespace

bool Subdivide(const BezierCurve& curve, const CutChoice& rule, const SubdivisionOptions& options,
               Subdivision* result, std::string* error) {
  *result = Subdivision();
  if (!options.IsValid(error)) return false;
  if (options.stop == StopMeasure::kHullArea && curve.dimension() != 2) {
    return FailWith("a stop by hull area needs a planar curve; found " +
                        std::to_string(curve.dimension()) + " coordinates, use polygon",
                    error);
  }
  const double unit = UnitOf(curve.control_points());
  const BezierCurve scaled = *BezierCurve::Make(curve.control_points() / unit, nullptr);
  const StopTest test(options.stop, options.relative_tolerance, options.reference_size / unit,
                      scaled);
  PieceCutter cutter(scaled, test, rule);
  PieceList list(unit, curve.degree(), curve.dimension(), options.keep_pieces);
  const double* points = scaled.control_points().data();
  if (options.mode == SubdivisionMode::kUniform) {
    CutInRounds(points, options, &cutter, &list, result);
  } else if (!CutAdaptively(points, options, &cutter, &list, result)) {
    HalveWorstFirst(points, options, &cutter, &list, result);
  }
  list.MoveTo(result);
  result->cuts = cutter.cuts();
  result->evaluations = cutter.evaluations();
  result->message = Explanation(*result, options, test);
  return true;
}

double CutAtHalf(CutTrial* /*trial*/) {
  constexpr double kHalf = 0.5;
  return kHalf;
}

}  // namespace batten
