#include "experiments/fairing_paper.h"

#include <algorithm>
#include <cmath>

#include "experiments/curve_fairness.h"
#include "experiments/experiment_runs.h"
#include "problems/data_folders.h"

namespace batten {

Reproduction FairingPaper() {
  Reproduction reproduction;
  reproduction.name = "fairing";
  reproduction.title = "Fairing approximation by cubic splines, run again";
  reproduction.source =
      "\"B-Spline (11): spline curve fitting - fairing approximation\" (whudj, 2017), after Luo "
      "Weilan (2003) and Lan Hao (2008)";
  reproduction.introduction =
      "The source minimises alpha * integral |C''(u)|^2 du + beta * sum |C(u_i) - F_i|^2 over the "
      "control points of an open cubic whose knots are the centripetal parameters of the data, not "
      "normalised: u_(i+1) = u_i + sqrt |F_(i+1) - F_i|. The two unknowns more than points are met "
      "by Bessel's end tangents as two further rows, P_1 - P_0 and P_(n-1) - P_(n-2). It solves "
      "P = beta (alpha W + beta M'M)^-1 M'F as a full matrix by column-pivoted QR (`dense_qr`). "
      "Here the same problem is the terms interpolation, end_tangent and fairing with "
      "units=source, solved in the band (`banded_qr`) unless the table says otherwise. Its data "
      "are not public: ours are a circle of our own, and GPS tracks, an airfoil and coasts from "
      "`data/`. Curvature is read at several places of every span.";
  reproduction.experiments = {FairingPaperCircle(), FairingPaperShapes(), FairingPaperMethod(),
                              FairingPaperFormula()};
  return reproduction;
}

std::shared_ptr<const Problem> SourceFit(const Points& points, double alpha, double beta) {
  const auto m = points.rows();
  DataSet data;
  data.name = "source";
  data.points = points;
  data.parameters = Eigen::VectorXd::Zero(m);
  for (Eigen::Index i = 1; i < m; ++i) {
    (*data.parameters)[i] =
        (*data.parameters)[i - 1] + std::sqrt((points.row(i) - points.row(i - 1)).norm());
  }
  FitSpec spec;
  spec.parameters.reset();
  spec.given_knots.assign(data.parameters->data(), data.parameters->data() + m);
  const double last = spec.given_knots.back();
  spec.given_knots.insert(spec.given_knots.begin(), 3, 0.0);
  spec.given_knots.insert(spec.given_knots.end(), 3, last);
  const std::pair<std::string, std::string> weight("weight", NumberText(beta));
  const std::pair<std::string, std::string> units("units", "source");
  spec.terms = {{"interpolation", {weight}, nullptr}, {"end_tangent", {units, weight}, nullptr}};
  if (alpha > 0.0) {
    spec.terms.push_back({"fairing", {units, {"weight", NumberText(alpha)}}, nullptr});
  }
  return CheckedFit(std::move(data), std::move(spec));
}

bool ReadDistinctPoints(const char* file, int every, int most, Points* points, std::string* error) {
  const std::string path = FindDataFile(file, "");
  if (path.empty()) {
    *error = std::string("data file ") + file + " is not found";
    return false;
  }
  const std::optional<DataSet> data = ReadDataSet(path, error);
  if (!data.has_value()) return false;
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < data->points.rows(); i += every) {
    const bool is_new = kept.empty() || data->points.row(i) != data->points.row(kept.back());
    if (is_new && static_cast<int>(kept.size()) < most) kept.push_back(i);
  }
  *points = data->points(kept, Eigen::all);
  return true;
}

std::vector<std::string> FairnessColumns() {
  return {"rms",           "largest_residual",      "bending_energy", "curvature_variation",
          "max_curvature", "num_curvature_extrema", "num_inflections"};
}

std::vector<std::string> FairnessCells(const Problem& problem, const Eigen::VectorXd& x) {
  const CurveFit& fit = *problem.curve_fit();
  const BsplineCurve curve = fit.Curve(x);
  const Eigen::VectorXd distances =
      (curve.Sample(fit.parameters()) - fit.data().points).rowwise().norm();
  const CurveFairness fairness = MeasureFairness(curve);
  return {NumberText(std::sqrt(distances.squaredNorm() / static_cast<double>(distances.size()))),
          NumberText(distances.maxCoeff()),
          NumberText(fairness.bending_energy),
          NumberText(fairness.curvature_variation),
          NumberText(fairness.max_curvature),
          std::to_string(fairness.num_curvature_extrema),
          fairness.num_inflections < 0 ? "" : std::to_string(fairness.num_inflections)};
}

std::vector<std::string> CurveColumns() { return {"shape", "setting", "s", "x", "y", "kappa"}; }

void AddCurveRows(const std::vector<std::string>& first, const Problem& problem,
                  const Eigen::VectorXd& x, int most, CsvTable* table) {
  const BsplineCurve curve = problem.curve_fit()->Curve(x);
  constexpr int kMostPerSpan = 16;
  const int per_span = std::clamp(most / curve.basis().num_domain_spans(), 2, kMostPerSpan);
  for (const CurvatureSample& sample : SampleCurvature(curve, per_span)) {
    std::vector<std::string> cells = first;
    for (const double value : {sample.s, sample.point[0], sample.point[1], sample.kappa}) {
      cells.push_back(NumberText(value));
    }
    table->AddRow(std::move(cells));
  }
}

std::vector<PlotPanel> CurveAndCurvaturePanels(const std::string& title, const CsvTable& rows,
                                               bool log_size) {
  PlotPanel curves, curvature;
  curves.title = title;
  curves.equal_scale = true;
  curvature.title = "curvature";
  curvature.x_label = "arc length";
  curvature.y_label = log_size ? "size of kappa" : "kappa";
  curvature.log_y = log_size;
  int color = 0;
  for (const std::string& setting : rows.Distinct("setting")) {
    const CsvTable part = rows.Where("setting", setting);
    curves.series.push_back(
        {setting, part.Numbers("x"), part.Numbers("y"), PlotSeries::Style::kLine, color});
    std::vector<double> kappa = part.Numbers("kappa");
    for (double& value : kappa) value = log_size ? std::abs(value) : value;
    curvature.series.push_back(
        {setting, part.Numbers("s"), std::move(kappa), PlotSeries::Style::kLine, color++});
  }
  return {curves, curvature};
}

}  // namespace batten
