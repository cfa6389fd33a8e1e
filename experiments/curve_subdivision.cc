#include "experiments/curve_subdivision.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "experiments/build_info.h"
#include "experiments/plot.h"
#include "splines/bezier_distance.h"

namespace batten {
namespace {

using Json = nlohmann::ordered_json;

Json NumberOrNull(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

/// Adds what one curve came to.
void Add(int path, const BezierSpan& span, bool is_first, const Subdivision& part,
         std::vector<double>* coordinates, CurveSubdivision* whole) {
  for (std::size_t i = is_first ? 0 : 1; i < part.parameters.size(); ++i) {
    const double s = part.parameters[i];
    whole->vertices.push_back(
        {path, s == 1.0 ? span.end : span.begin + s * (span.end - span.begin)});
    const double* point =
        part.vertices.data() + static_cast<std::ptrdiff_t>(i) * part.vertices.cols();
    coordinates->insert(coordinates->end(), point, point + part.vertices.cols());
  }
  ++whole->num_curves;
  whole->num_pieces += part.num_pieces();
  whole->rounds = std::max(whole->rounds, part.rounds);
  whole->cuts += part.cuts;
  whole->evaluations += part.evaluations;
  whole->num_failing += part.num_failing;
  if (part.end > whole->end || (whole->message.empty() && part.end == whole->end)) {
    whole->message = part.message;
  }
  whole->end = std::max(whole->end, part.end);
}

void AddError(const BezierCurve& curve, const Subdivision& part, CurveSubdivision* whole) {
  const Eigen::Map<const Eigen::VectorXd> parameters(
      part.parameters.data(), static_cast<Eigen::Index>(part.parameters.size()));
  const DistanceBounds bounds = BoundHausdorffDistance(curve, parameters, part.vertices);
  whole->error_at_most = std::max(whole->error_at_most, bounds.upper);
  // Another curve's polyline may pass nearer: no bound for more curves than one.
  whole->error_at_least =
      whole->num_curves == 1 ? bounds.lower : std::numeric_limits<double>::quiet_NaN();
}

void AppendRows(const Points& points, int across, int up, PlotSeries* series) {
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    series->x.push_back(points(i, across));
    series->y.push_back(points(i, up));
  }
}

void AppendCurve(const BezierCurve& curve, int across, int up, PlotSeries* series) {
  constexpr int kSteps = 200;
  double point[kMaxDimension];
  for (int k = 0; k <= kSteps; ++k) {
    curve.Evaluate(k / static_cast<double>(kSteps), point);
    series->x.push_back(point[across]);
    series->y.push_back(point[up]);
  }
}

// Each path is its own series: the plot has no gaps within one.
PlotPanel ProjectionPanel(const std::vector<BezierPath>& paths, const CurveSubdivision& result,
                          int across, int up) {
  constexpr int kPolygonColor = 7, kCurveColor = 0, kVertexColor = 1;
  PlotPanel panel;
  panel.equal_scale = true;
  if (result.points.cols() > 2) {
    panel.x_label = kCoordinateNames[across];
    panel.y_label = kCoordinateNames[up];
  }
  // Below the curve, which many marks would hide.
  constexpr std::int64_t kFewPieces = 100;
  PlotSeries vertices;
  vertices.label = "cuts";
  vertices.style =
      result.num_pieces <= kFewPieces ? PlotSeries::Style::kCircles : PlotSeries::Style::kPoints;
  vertices.color = kVertexColor;
  AppendRows(result.points, across, up, &vertices);
  panel.series.push_back(std::move(vertices));
  for (const BezierPath& path : paths) {
    PlotSeries polygon, curve;
    polygon.style = PlotSeries::Style::kDashed;
    polygon.color = kPolygonColor;
    curve.style = PlotSeries::Style::kLine;
    curve.color = kCurveColor;
    if (&path == &paths.front()) {
      polygon.label = "control polygon";
      curve.label = "curve";
    }
    for (const BezierSpan& span : path.spans) {
      AppendRows(span.curve.control_points(), across, up, &polygon);
      AppendCurve(span.curve, across, up, &curve);
    }
    panel.series.push_back(std::move(polygon));
    panel.series.push_back(std::move(curve));
  }
  return panel;
}

}  // namespace

bool SubdivideCurves(const std::vector<BezierPath>& paths, CutRule* rule,
                     const SubdivisionOptions& options, CurveSubdivision* result,
                     std::string* error) {
  *result = CurveSubdivision();
  result->size = BoxSideOf(paths);
  SubdivisionOptions part_options = options;
  part_options.reference_size = result->size;
  std::vector<double> coordinates;
  int dimension = 1;
  for (std::size_t p = 0; p < paths.size(); ++p) {
    bool is_first = true;
    for (const BezierSpan& span : paths[p].spans) {
      Subdivision part;
      const auto begin = std::chrono::steady_clock::now();
      if (!SubdivideBy(rule, span.curve, part_options, &part, error)) return false;
      const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
      result->seconds += taken.count();
      dimension = span.curve.dimension();
      Add(static_cast<int>(p), span, is_first, part, &coordinates, result);
      AddError(span.curve, part, result);
      is_first = false;
    }
  }
  result->points = Eigen::Map<const Points>(
      coordinates.data(), static_cast<Eigen::Index>(result->vertices.size()), dimension);
  return true;
}

std::string PolylineCsv(const CurveSubdivision& result) {
  const bool has_paths = !result.vertices.empty() && result.vertices.back().path > 0;
  const std::string names = "x,y,z,w";
  const auto d = static_cast<std::size_t>(result.points.cols());
  std::string text = (has_paths ? "path,t," : "t,") + names.substr(0, 2 * d - 1) + "\n";
  for (std::size_t i = 0; i < result.vertices.size(); ++i) {
    if (has_paths) text += std::to_string(result.vertices[i].path) + ",";
    text += NumberText(result.vertices[i].t);
    for (Eigen::Index c = 0; c < result.points.cols(); ++c) {
      text += "," + NumberText(result.points(static_cast<Eigen::Index>(i), c));
    }
    text += "\n";
  }
  return text;
}

std::string SubdivisionJson(const std::string& input, const std::string& rule,
                            const OptionValues& rule_options, const SubdivisionOptions& options,
                            const CurveSubdivision& result) {
  Json json;
  json["format"] = "batten.subdivision/1";
  json["input"] = input;
  json["rule"] = rule;
  json["rule_options"] = rule_options.ToText();
  json["stop"] = ToString(options.stop);
  json["relative_tolerance"] = options.relative_tolerance;
  json["subdivision"] = ToString(options.mode);
  json["size"] = NumberOrNull(result.size);
  json["curves"] = result.num_curves;
  json["pieces"] = result.num_pieces;
  json["rounds"] = result.rounds;
  json["cuts"] = result.cuts;
  json["evaluations"] = result.evaluations;
  json["seconds"] = result.seconds;
  json["true_error"] = {{"at_most", NumberOrNull(result.error_at_most)},
                        {"at_least", NumberOrNull(result.error_at_least)},
                        {"relative_at_most", NumberOrNull(result.error_at_most / result.size)}};
  json["end"] = ToString(result.end);
  json["failing_pieces"] = result.num_failing;
  json["message"] = result.message;
  json["version"] = kVersion;
  json["commit"] = kGitCommit;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

FigureResult SubdivisionFigure(const std::vector<BezierPath>& paths, const CurveSubdivision& result,
                               const std::string& stem, FileBatch* batch) {
  const auto d = static_cast<int>(result.points.cols());
  if (d == 1) return NoFigure(stem, "a curve of one coordinate has no picture", batch);
  std::vector<PlotPanel> panels = {ProjectionPanel(paths, result, 0, 1)};
  if (d == 3) {
    panels.push_back(ProjectionPanel(paths, result, 0, 2));
    panels.push_back(ProjectionPanel(paths, result, 1, 2));
  }
  if (d == 4) panels.push_back(ProjectionPanel(paths, result, 2, 3));
  const std::string size = std::to_string(result.num_pieces) + " pieces";
  for (PlotPanel& panel : panels) panel.title = size;
  return DrawPlot(stem, panels, static_cast<int>(panels.size()), batch);
}

}  // namespace batten
