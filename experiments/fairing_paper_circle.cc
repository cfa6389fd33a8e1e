#include <cmath>

#include "experiments/experiment_runs.h"
#include "experiments/fairing_paper.h"

namespace batten {
namespace {

constexpr int kNumPoints = 40;
constexpr int kMisplaced = 13;
// The source does not say how far its point is off.
constexpr double kOff = 0.06;

/// Points of the unit circle, one of them a little outside.
Points MisplacedCircle() {
  Points points(kNumPoints, 2);
  for (int i = 0; i < kNumPoints; ++i) {
    const double angle = 2.0 * M_PI * i / (kNumPoints - 1);
    const double radius = i == kMisplaced ? 1.0 + kOff : 1.0;
    points.row(i) << radius * std::cos(angle), radius * std::sin(angle);
  }
  return points;
}

/// Largest distance of the curve from the unit circle at the data's parameters, of the points from
/// `first` to `last`.
double OffTheCircle(const Problem& problem, const Eigen::VectorXd& x, int first, int last) {
  const CurveFit& fit = *problem.curve_fit();
  const Eigen::VectorXd radii = fit.Curve(x).Sample(fit.parameters()).rowwise().norm();
  return (radii.segment(first, last - first + 1).array() - 1.0).abs().maxCoeff();
}

bool RunCircle(const ExperimentRun& run, ExperimentTables* tables, std::string* /*error*/) {
  std::vector<std::string> columns = {"setting", "bump", "off_the_circle"};
  for (const std::string& column : FairnessColumns()) columns.push_back(column);
  CsvTable table(columns);
  CsvTable curves(CurveColumns());
  double done = 0.0;
  for (const FairingRatio& ratio : kFairingRatios) {
    if (InterruptRequested()) break;
    if (run.progress) run.progress(done++ / 4.0, ratio.name);
    const auto problem = SourceFit(MisplacedCircle(), ratio.alpha, ratio.beta);
    ProblemRuns runs(std::string("circle (") + ratio.name + ")", problem, 1, run.recorder);
    CsvTable rows(RunColumns());
    const RunResult result = runs.Run("banded_qr", RunSpec(), &rows);
    const double bump = OffTheCircle(*problem, result.x, kMisplaced - 2, kMisplaced + 2);
    const double off = OffTheCircle(*problem, result.x, 0, kNumPoints - 1);
    std::vector<std::string> cells = {ratio.name, NumberText(bump), NumberText(off)};
    for (const std::string& cell : FairnessCells(*problem, result.x)) cells.push_back(cell);
    table.AddRow(std::move(cells));
    AddCurveRows({"circle", ratio.name}, *problem, result.x, 1000, &curves);
  }
  (*tables)[""] = std::move(table);
  (*tables)["curves"] = std::move(curves);
  return true;
}

Judgement JudgeBump(const ExperimentTables& tables) {
  Judgement judgement;
  const CsvTable& table = tables.at("");
  if (table.num_rows() != 4) return judgement;
  const std::vector<double> off = table.Numbers("bump");
  const std::vector<double> variation = table.Numbers("curvature_variation");
  judgement.because = "the bump is " + Rounded(off[0], 3) + "; " + Rounded(off[1], 3) + "; " +
                      Rounded(off[2], 3) + "; " + Rounded(off[3], 3) +
                      ", the variation of the curvature " + Rounded(variation[0], 2) + "; " +
                      Rounded(variation[1], 2) + "; " + Rounded(variation[2], 2) + "; " +
                      Rounded(variation[3], 2);
  const bool smoothed = off[1] < off[0] && off[2] < off[1];
  const bool fairer = variation[1] < variation[0] && variation[2] < variation[1];
  judgement.verdict = smoothed && fairer   ? ClaimVerdict::kHolds
                      : smoothed || fairer ? ClaimVerdict::kInPart
                                           : ClaimVerdict::kDoesNotHold;
  return judgement;
}

}  // namespace

Experiment FairingPaperCircle() {
  Experiment experiment;
  experiment.name = "circle";
  experiment.title = "A circle with one misplaced point";
  experiment.text =
      "40 points of the unit circle, from its right end around to it again, one of them moved "
      "outwards by 0.06. The interpolating curve has a bump there; how much of it is left with "
      "alpha : beta = 0.01 : 1; 1 : 1; 1 : 0.01? `bump` is the largest distance from the "
      "circle at the misplaced point and two on either side, `off_the_circle` that at all points: "
      "heavy fairing lets the ends go.";
  experiment.run = &RunCircle;
  experiment.shown = [](const ExperimentTables& tables) { return tables.at(""); };
  experiment.claims = {{"fairing takes the bump of one bad point away", "the circle's figures",
                        "holds if the largest distance from the circle at the misplaced point and "
                        "two on either side "
                        "and the variation of the curvature both fall from interpolation to 0.01 : "
                        "1 and on to 1 : 1; in part if one does",
                        &JudgeBump}};
  experiment.figures = {{"circle", "The misplaced point: curves and curvatures.", 2,
                         [](const ExperimentTables& tables) {
                           return CurveAndCurvaturePanels("circle", tables.at("curves"), false);
                         }}};
  return experiment;
}

}  // namespace batten
