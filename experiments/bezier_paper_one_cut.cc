#include <cmath>
#include <iterator>

#include "cost_functions/options.h"
#include "experiments/bezier_paper.h"
#include "experiments/bezier_paper_curves.h"
#include "experiments/experiment_runs.h"
#include "solvers/cut_search.h"
#include "splines/bezier_hull.h"

namespace batten {
namespace {

// The first curve of the walk of this degree: polygons of six legs can be told apart by eye.
constexpr int kOneCutDegree = 6;
constexpr const char* kFamily = "walk";

struct OneCut {
  const char* rule;
  double u;
};

bool RunOneCut(const ExperimentRun& /*run*/, ExperimentTables* tables, std::string* /*error*/) {
  const BezierCurve curve = FamilyCurve(kFamily, kOneCutDegree, 0);
  const double* points = curve.control_points().data();
  CutValue flatness(CutMeasure::kFlatness, kOneCutDegree, 2, points);
  CutValue hull(CutMeasure::kHullArea, kOneCutDegree, 2, points);
  const OneCut cuts[] = {{"half", 0.5},
                         {"hull", GridMinimum(&hull).u},
                         {"hull exact", ExactMinimum(&hull).u},
                         {"flatness", GridMinimum(&flatness).u},
                         {"flatness exact", ExactMinimum(&flatness).u}};
  CsvTable& table = (*tables)[""] = CsvTable({"rule", "u", "flatness", "hull_area"});
  CsvTable& places = (*tables)["values"] = CsvTable({"u", "flatness", "hull_area"});
  for (const OneCut& cut : cuts) {
    table.AddRow(
        {cut.rule, NumberText(cut.u), NumberText(flatness(cut.u)), NumberText(hull(cut.u))});
  }
  constexpr int kSteps = 200;
  for (int k = 1; k < kSteps; ++k) {
    const double u = k / static_cast<double>(kSteps);
    places.AddRow({NumberText(u), NumberText(flatness(u)), NumberText(hull(u))});
  }
  return true;
}

Judgement JudgeSmaller(const ExperimentTables& tables) {
  const CsvTable& table = tables.at("");
  Judgement judgement;
  const CsvTable half = table.Where("rule", "half");
  if (half.num_rows() != 1) return judgement;
  int smaller = 0;
  for (const auto& [rule, column] :
       {std::pair<const char*, const char*>("flatness", "flatness"), {"hull", "hull_area"}}) {
    const CsvTable row = table.Where("rule", rule);
    if (row.num_rows() != 1) return Judgement();
    const double ratio = row.Number(0, column) / half.Number(0, column);
    smaller += ratio < 1.0 ? 1 : 0;
    judgement.because += (judgement.because.empty() ? "" : "; ") + std::string(rule) + " cuts at " +
                         row.Text(0, "u") + ", where its sum is " + Rounded(ratio, 2) +
                         " of that at 0.5";
  }
  judgement.verdict = smaller == 2   ? ClaimVerdict::kHolds
                      : smaller == 1 ? ClaimVerdict::kInPart
                                     : ClaimVerdict::kDoesNotHold;
  return judgement;
}

void AddPoints(const Points& points, PlotSeries* series) {
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    series->x.push_back(points(i, 0));
    series->y.push_back(points(i, 1));
  }
}

PlotSeries PolygonSeries(const Points& part, const std::string& label, int color) {
  PlotSeries series;
  series.label = label;
  series.color = color;
  AddPoints(part, &series);
  return series;
}

PlotSeries HullSeries(const Points& part, const std::string& label, int color) {
  std::vector<int> corners(static_cast<std::size_t>(part.rows()) + 1);
  const int count = ConvexHull(static_cast<int>(part.rows()) - 1, part.data(), corners.data());
  PlotSeries series;
  series.label = label;
  series.color = color;
  series.style = PlotSeries::Style::kLine;
  for (int k = 0; k <= count && count > 0; ++k) AddPoints(part.row(corners[k % count]), &series);
  return series;
}

PlotSeries CurveSeries(const BezierCurve& curve) {
  constexpr int kSteps = 300, kBlack = 6;
  PlotSeries series;
  series.label = "curve";
  series.style = PlotSeries::Style::kLine;
  series.color = kBlack;
  Points point(1, 2);
  for (int k = 0; k <= kSteps; ++k) {
    curve.Evaluate(k / static_cast<double>(kSteps), point.data());
    AddPoints(point, &series);
  }
  return series;
}

std::vector<PlotPanel> OneCutPanels(const ExperimentTables& tables) {
  constexpr int kFirstColor = 0, kSecondColor = 1;
  const BezierCurve curve = FamilyCurve(kFamily, kOneCutDegree, 0);
  std::vector<PlotPanel> panels;
  for (const char* rule : {"half", "hull", "flatness"}) {
    const CsvTable row = tables.at("").Where("rule", rule);
    if (row.num_rows() != 1) continue;
    const double u = row.Number(0, "u");
    if (!(u > 0.0 && u < 1.0)) continue;  // an edited table
    Points first = curve.control_points(), second = first;
    CutBezier(kOneCutDegree, 2, u, curve.control_points().data(), first.data(), second.data());
    PlotPanel panel;
    panel.equal_scale = true;
    panel.title = std::string(rule) + ", cut at " + row.Text(0, "u");
    const bool draws_hulls = std::string(rule) == "hull";
    const auto part = draws_hulls ? &HullSeries : &PolygonSeries;
    panel.series = {part(first, draws_hulls ? "first hull" : "first polygon", kFirstColor),
                    part(second, draws_hulls ? "second hull" : "second polygon", kSecondColor),
                    CurveSeries(curve)};
    panels.push_back(std::move(panel));
  }
  return panels;
}

std::vector<PlotPanel> ValuePanels(const ExperimentTables& tables) {
  std::vector<PlotPanel> panels;
  const auto found = tables.find("values");
  if (found == tables.end()) return panels;
  for (const char* column : {"flatness", "hull_area"}) {
    PlotPanel panel;
    panel.title = column;
    panel.x_label = "u";
    panel.y_label = "sum over both parts";
    panel.legend = false;
    panel.series.push_back({"", found->second.Numbers("u"), found->second.Numbers(column),
                            PlotSeries::Style::kLine, 0});
    panels.push_back(std::move(panel));
  }
  return panels;
}

}  // namespace

Experiment BezierPaperOneCut() {
  Experiment experiment;
  experiment.name = "figure_1";
  experiment.title = "Figure 1: one cut";
  experiment.text =
      "The first curve of degree 6 of the family `walk` (the paper's is not printed), cut once: in "
      "the middle, where the hulls are smallest, where the polygons are flattest. `exact` is the "
      "least of all local minima, the others the best of the paper's 13 values.";
  experiment.run = &RunOneCut;
  experiment.claims = {
      {"a cut at the best place leaves parts with flatter polygons, or smaller hulls, than one at "
       "0.5",
       "Figure 1", "holds where both rules' sums are below those at 0.5; in part where one is",
       &JudgeSmaller}};
  experiment.figures = {
      {"figure_1_parts", "Both parts after one cut: control polygons, and hulls where they count.",
       3, &OneCutPanels},
      {"figure_1_values", "The sums that are minimised, against the place of the cut.", 2,
       &ValuePanels}};
  return experiment;
}

}  // namespace batten
