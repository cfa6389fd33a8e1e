#include <algorithm>
#include <cmath>

#include "experiments/experiment_runs.h"
#include "experiments/fairing_paper.h"

namespace batten {
namespace {

struct Shape {
  const char* name;
  const char* file;
  int every;    // of its points
  int most;     // points
  double size;  // its longest side is made so long
};
// The source says neither where its data are from nor in what unit they are, on which alpha : beta
// depends: all are made 100 long, so that neighbours are some tenths to some units apart.
constexpr double kShapeSize = 100.0;
constexpr Shape kShapes[] = {{"track", "curves3d/gps_hike_xyz_open.csv", 4, 361, kShapeSize},
                             {"airfoil", "airfoils/naca2412_open.csv", 1, 160, kShapeSize},
                             {"coast", "coasts/great_britain_10m.csv", 4, 400, kShapeSize}};

/// Points of a file that are different from the ones before them, scaled.
bool ReadShape(const Shape& shape, Points* points, std::string* error) {
  if (!ReadDistinctPoints(shape.file, shape.every, shape.most, points, error)) return false;
  const Eigen::RowVectorXd low = points->colwise().minCoeff();
  const double side = (points->colwise().maxCoeff() - low).maxCoeff();
  *points = (points->rowwise() - low) * (shape.size / side);
  return true;
}

bool RunShapes(const ExperimentRun& run, ExperimentTables* tables, std::string* error) {
  std::vector<std::string> columns = {"shape", "points", "setting", "largest_move"};
  for (const std::string& column : FairnessColumns()) columns.push_back(column);
  CsvTable table(columns);
  CsvTable curves(CurveColumns());
  double done = 0.0;
  for (const Shape& shape : kShapes) {
    Points points;
    if (!ReadShape(shape, &points, error)) return false;
    Points interpolating;
    for (const FairingRatio& ratio : kFairingRatios) {
      if (InterruptRequested()) break;
      if (run.progress) run.progress(done++ / 12.0, shape.name);
      const auto problem = SourceFit(points, ratio.alpha, ratio.beta);
      ProblemRuns runs(std::string(shape.name) + " (" + ratio.name + ")", problem, 1, run.recorder);
      CsvTable rows(RunColumns());
      const RunResult result = runs.Run("banded_qr", RunSpec(), &rows);
      const BsplineCurve curve = problem->curve_fit()->Curve(result.x);
      // At places between the data too: ten a span in the mean.
      const BsplineBasis& basis = curve.basis();
      const Points places = curve.Sample(Eigen::VectorXd::LinSpaced(
          10 * basis.num_domain_spans(), basis.domain_begin(), basis.domain_end()));
      if (interpolating.size() == 0) interpolating = places;
      const double move = (places - interpolating).rowwise().norm().maxCoeff();
      std::vector<std::string> cells = {shape.name, std::to_string(points.rows()), ratio.name,
                                        NumberText(move)};
      for (const std::string& cell : FairnessCells(*problem, result.x)) cells.push_back(cell);
      table.AddRow(std::move(cells));
      AddCurveRows({shape.name, ratio.name}, *problem, result.x, 3000, &curves);
    }
  }
  (*tables)[""] = std::move(table);
  (*tables)["curves"] = std::move(curves);
  return true;
}

/// Of each shape: value of `column` with the setting over that with another one.
std::vector<double> Ratios(const ExperimentTables& tables, const std::string& setting,
                           const std::string& column, const std::string& other = "interpolation") {
  std::vector<double> ratios;
  for (const Shape& shape : kShapes) {
    const CsvTable rows = tables.at("").Where("shape", shape.name);
    const CsvTable with = rows.Where("setting", setting);
    const CsvTable without = rows.Where("setting", other);
    if (with.num_rows() != 1 || without.num_rows() != 1) return {};
    ratios.push_back(with.Number(0, column) / without.Number(0, column));
  }
  return ratios;
}

std::string Listed(const std::vector<double>& values, int decimals) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : "; ") + Rounded(value, decimals);
  return text;
}

std::vector<double> Moves(const ExperimentTables& tables, const std::string& setting) {
  const CsvTable rows = tables.at("").Where("setting", setting);
  std::vector<double> moves = rows.Numbers("largest_move");
  for (double& move : moves) move /= kShapeSize;
  return moves;
}

/// Names of the shapes whose bending energy or largest curvature rises, as a sentence's end.
std::string Risen(const std::vector<double>& energy, const std::vector<double>& sharpest) {
  std::string text;
  for (std::size_t i = 0; i < std::min(energy.size(), sharpest.size()); ++i) {
    for (const auto& [name, value] :
         {std::pair("bending energy", energy[i]), {"largest curvature", sharpest[i]}}) {
      if (!(value > 1.0)) continue;
      text += (text.empty() ? ": " : ", ") + std::string("the ") + name + " rises on the " +
              kShapes[i].name;
    }
  }
  return text;
}

/// One number of each shape, and the most that it may be.
struct Bounded {
  std::vector<double> values;
  double high;
};

/// Holds if all of all shapes are within their bounds, in part if some of the shapes' are.
Judgement JudgeAll(const std::vector<Bounded>& parts, const std::string& because) {
  Judgement judgement;
  std::ptrdiff_t count = 0;
  for (const Bounded& part : parts) {
    if (part.values.size() != std::size(kShapes)) return judgement;
    count += std::count_if(part.values.begin(), part.values.end(),
                           [&](double value) { return value <= part.high; });
  }
  const auto all = static_cast<std::ptrdiff_t>(parts.size() * std::size(kShapes));
  judgement.verdict = count == all ? ClaimVerdict::kHolds
                      : count > 0  ? ClaimVerdict::kInPart
                                   : ClaimVerdict::kDoesNotHold;
  judgement.because = because;
  return judgement;
}

Judgement JudgeSmall(const ExperimentTables& tables) {
  const std::vector<double> moves = Moves(tables, "0.01 : 1");
  const std::vector<double> variation = Ratios(tables, "0.01 : 1", "curvature_variation");
  const std::vector<double> energy = Ratios(tables, "0.01 : 1", "bending_energy");
  const std::vector<double> sharpest = Ratios(tables, "0.01 : 1", "max_curvature");
  constexpr double kOfSize = 0.01;
  return JudgeAll({{moves, kOfSize}, {variation, 1.0}, {energy, 1.0}, {sharpest, 1.0}},
                  "track, airfoil and coast move by at most " + Listed(moves, 4) +
                      " of their size; of the interpolating curve's the variation of their "
                      "curvature is " +
                      Listed(variation, 2) + ", their bending energy " + Listed(energy, 2) +
                      ", their largest curvature " + Listed(sharpest, 2) + Risen(energy, sharpest));
}

constexpr double kVisibly = 0.5;

Judgement JudgeEqual(const ExperimentTables& tables) {
  const std::vector<double> small = Ratios(tables, "0.01 : 1", "curvature_variation");
  const std::vector<double> variation = Ratios(tables, "1 : 1", "curvature_variation");
  return JudgeAll({{variation, kVisibly}},
                  "the variation of the curvature is " + Listed(variation, 2) +
                      " of the interpolating curve's; it was " + Listed(small, 2) + " at 0.01 : 1");
}

Judgement JudgeLarge(const ExperimentTables& tables) {
  const std::vector<double> sharpest = Ratios(tables, "1 : 0.01", "max_curvature");
  const std::vector<double> moves = Moves(tables, "1 : 0.01");
  const std::vector<double> against_equal =
      Ratios(tables, "1 : 0.01", "curvature_variation", "1 : 1");
  std::string text = "the largest curvature is " + Listed(sharpest, 3) +
                     " of the interpolating curve's; the variation of the curvature is " +
                     Listed(against_equal, 2) + " of that at 1 : 1";
  for (std::size_t i = 0; i < against_equal.size(); ++i) {
    if (against_equal[i] > 1.0) {
      text += std::string(": the ") + kShapes[i].name + " is less steady than at 1 : 1";
    }
  }
  return JudgeAll({{sharpest, kVisibly}, {against_equal, 1.0}},
                  text + "; the curves move by up to " + Listed(moves, 3) + " of their size");
}

ExperimentFigure FigureOf(const Shape& shape) {
  return {std::string("shape_") + shape.name,
          std::string(shape.name) + ": curves (the track seen from above) and curvatures.", 2,
          [&shape](const ExperimentTables& tables) {
            return CurveAndCurvaturePanels(shape.name,
                                           tables.at("curves").Where("shape", shape.name), true);
          }};
}

}  // namespace

Experiment FairingPaperShapes() {
  Experiment experiment;
  experiment.name = "shapes";
  experiment.title = "A track in 3-D, an airfoil and a coast";
  experiment.text =
      "A GPS track of a hike (every fourth point, 3-D), an airfoil and 400 points of the coast of "
      "Great Britain, each made 100 long, by interpolation and with alpha : beta = 0.01 : 1; 1 : "
      "1; "
      "1 : 0.01. The weights belong to data of that size: alpha's share grows with the cube of the "
      "parameter's step. `largest_move` is the largest distance from the interpolating curve at "
      "equal parameters.";
  experiment.run = &RunShapes;
  experiment.shown = [](const ExperimentTables& tables) { return tables.at(""); };
  experiment.claims = {
      {"at alpha / beta = 0.01 the curves hardly differ and the curvature gets a little steadier",
       "figures of the three shapes",
       "holds if all three move by at most 1 % of their size and neither the variation of their "
       "curvature nor their bending energy nor their largest curvature rises; in part if some",
       &JudgeSmall},
      {"at 1 the curvature is visibly steadier", "the same",
       "holds if the variation of the curvature falls to half or less for all three; in part for "
       "some",
       &JudgeEqual},
      {"at 100 tight bends are smoothed", "the same",
       "holds if the largest curvature falls to half or less for all three and the curvature "
       "varies no more than at 1; in part for some",
       &JudgeLarge}};
  for (const Shape& shape : kShapes) experiment.figures.push_back(FigureOf(shape));
  return experiment;
}

}  // namespace batten
