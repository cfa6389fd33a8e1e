#ifndef BATTEN_EXPERIMENTS_CURVE_SUBDIVISION_H_
#define BATTEN_EXPERIMENTS_CURVE_SUBDIVISION_H_

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "experiments/gnuplot.h"
#include "problems/bezier_file.h"
#include "solvers/cut_rule.h"

namespace batten {

/// A vertex of the polylines, and the parameter of the curve there.
struct PolylineVertex {
  int path = 0;
  double t = 0.0;
};

/// All curves of a drawing subdivided by one rule.
struct CurveSubdivision {
  std::vector<PolylineVertex> vertices;
  Points points;      ///< One row per vertex.
  double size = 0.0;  ///< L: the larger side of the box of all control points.
  int num_curves = 0;
  std::int64_t num_pieces = 0;
  int rounds = 0;  ///< The most of any curve.
  std::int64_t cuts = 0;
  std::int64_t evaluations = 0;
  std::int64_t num_failing = 0;
  SubdivisionEnd end = SubdivisionEnd::kNotRun;  ///< The worst of any curve.
  /// Sentences, "; " between them: of the first curve that ended so, and where control_points,
  /// which measures from lines, leaves a true error above the tolerance.
  std::string message;
  double seconds = 0.0;  ///< Of the subdivision alone.
  /// The Hausdorff distance of polylines and curves is no more than `error_at_most`, and of one
  /// curve no less than `error_at_least` (NaN for more curves).
  double error_at_most = 0.0;
  double error_at_least = 0.0;
};

/// Is told now and then what fraction is done, and what is at work.
using SubdivisionProgress = std::function<void(double fraction, const std::string& text)>;

/// Tolerances are relative to the whole drawing, and `max_pieces` is of all its curves: each may
/// have an equal share of what those before it left. `progress` may be empty. False with one
/// sentence in `error` where the rule or its options do not fit.
bool SubdivideCurves(const std::vector<BezierPath>& paths, CutRule* rule,
                     const SubdivisionOptions& options, const SubdivisionProgress& progress,
                     CurveSubdivision* result, std::string* error);

/// CSV of the polylines: `t,x,y`, with `path` in front where there are several.
std::string PolylineCsv(const CurveSubdivision& result);
/// "format": "batten.subdivision/1", docs/formats.md; never NaN or infinity: null.
std::string SubdivisionJson(const std::string& input, const std::string& rule,
                            const OptionValues& rule_options, const SubdivisionOptions& options,
                            const CurveSubdivision& result);
/// Control polygons, curves, polylines and their vertices; in space their projections.
FigureResult SubdivisionFigure(const std::vector<BezierPath>& paths, const CurveSubdivision& result,
                               const std::string& stem, FileBatch* batch);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_CURVE_SUBDIVISION_H_
