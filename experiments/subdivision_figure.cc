#include "experiments/curve_subdivision.h"
#include "experiments/plot.h"

namespace batten {
namespace {

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

/// The polylines, one series per path.
void AddPolylines(const CurveSubdivision& result, int across, int up, PlotPanel* panel) {
  constexpr int kColor = 1;
  for (std::size_t i = 0; i < result.vertices.size(); ++i) {
    if (i == 0 || result.vertices[i].path != result.vertices[i - 1].path) {
      PlotSeries polyline;
      polyline.style = PlotSeries::Style::kLine;
      polyline.color = kColor;
      if (i == 0) polyline.label = "polyline";
      panel->series.push_back(std::move(polyline));
    }
    const auto row = static_cast<Eigen::Index>(i);
    panel->series.back().x.push_back(result.points(row, across));
    panel->series.back().y.push_back(result.points(row, up));
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
  AddPolylines(result, across, up, &panel);
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
