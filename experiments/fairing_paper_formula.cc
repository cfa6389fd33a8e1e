#include <glog/logging.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "experiments/experiment_runs.h"
#include "experiments/fairing_paper.h"
#include "problems/curve_view.h"

namespace batten {
namespace {

constexpr int kLengths[] = {10, 30, 100, 300, 1000, 3000, 10000};
/// Up to here the control points are solved for, too, as a full matrix.
constexpr int kMostSolved = 1000;
constexpr int kFewPoints = 10;
/// What the source's formula is to agree to.
constexpr double kAgrees = 1e-10;

struct LongData {
  const char* name;
  const char* file;
};
constexpr LongData kLongData[] = {{"coast", "coasts/greenland_10m.csv"},
                                  {"run", "tracks/gps_run_open.csv"}};

/// A linear function by two numbers: slope and value at 0, or its values at a span's ends.
template <typename Scalar>
using Linear = std::pair<Scalar, Scalar>;

/// The integrals of N''_i N''_(i+k) over all spans. `hat(j, s)`: the line that N_(j,1) is on span
/// s, or zero; `integral(f, g, s)`: of the product of two such lines over that span.
template <typename Scalar, typename Hat, typename Integral>
Eigen::MatrixXd BandOf(const std::vector<double>& u, const Hat& hat, const Integral& integral) {
  const auto num_knots = static_cast<Eigen::Index>(u.size());
  const auto over = [&u](Linear<Scalar> line, Eigen::Index first, Eigen::Index last) {
    const Scalar length = static_cast<Scalar>(u[last]) - static_cast<Scalar>(u[first]);
    if (!(length > 0)) return Linear<Scalar>(0, 0);
    return Linear<Scalar>(line.first / length, line.second / length);
  };
  const auto minus = [](Linear<Scalar> f, Linear<Scalar> g) {
    return Linear<Scalar>(f.first - g.first, f.second - g.second);
  };
  const auto second_derivative = [&](Eigen::Index i, Eigen::Index s) {
    const Linear<Scalar> middle = over(hat(i + 1, s), i + 1, i + 3);
    const Linear<Scalar> rise = minus(over(hat(i, s), i, i + 2), middle);
    const Linear<Scalar> fall = minus(middle, over(hat(i + 2, s), i + 2, i + 4));
    const Linear<Scalar> sixth = minus(over(rise, i, i + 3), over(fall, i + 1, i + 4));
    return Linear<Scalar>(6 * sixth.first, 6 * sixth.second);
  };
  Eigen::Matrix<Scalar, Eigen::Dynamic, 4> band;
  band.setZero(num_knots - 4, 4);
  for (Eigen::Index s = 3; s + 4 < num_knots; ++s) {
    if (!(u[s + 1] > u[s])) continue;
    Linear<Scalar> lines[4];
    for (Eigen::Index i = 0; i < 4; ++i) lines[i] = second_derivative(s - 3 + i, s);
    for (Eigen::Index i = 0; i < 4; ++i) {
      for (Eigen::Index k = 0; i + k < 4; ++k) {
        band(s - 3 + i, k) += integral(lines[i], lines[i + k], s);
      }
    }
  }
  return band.template cast<double>();
}

/// Of all, |difference| over the root of the product of the two diagonal entries.
double LargestRelativeError(const Eigen::MatrixXd& band, const Eigen::MatrixXd& exact) {
  double largest = 0.0;
  for (Eigen::Index i = 0; i < exact.rows(); ++i) {
    for (Eigen::Index k = 0; k < 4 && i + k < exact.rows(); ++k) {
      const double size = std::sqrt(exact(i, 0)) * std::sqrt(exact(i + k, 0));
      largest = std::max(largest, std::abs(band(i, k) - exact(i, k)) / size);
    }
  }
  return largest;
}

/// beta (alpha W + beta M'M)^-1 M'F of alpha = beta = 1 by column-pivoted QR.
Eigen::VectorXd SolveWith(const Eigen::MatrixXd& w_band, const Points& points) {
  const auto problem = SourceFit(points, 0.0, 1.0);
  const auto view = CurveView::Make(*problem, nullptr);
  Eigen::MatrixXd matrix = view->normal_band().ToDense();
  for (Eigen::Index i = 0; i < w_band.rows(); ++i) {
    for (Eigen::Index k = 0; k < 4 && i + k < w_band.rows(); ++k) {
      matrix(i, i + k) += w_band(i, k);
      if (k > 0) matrix(i + k, i) += w_band(i, k);
    }
  }
  const Points solution =
      matrix.colPivHouseholderQr().solve(Eigen::MatrixXd(view->normal_band().right_hand_side()));
  return Eigen::Map<const Eigen::VectorXd>(solution.data(), solution.size());
}

Eigen::VectorXd SolvedBy(const char* solver, const Problem& problem) {
  RunResult result;
  std::string error;
  CHECK(Run(problem, {solver, {}, nullptr}, RunSpec(), &result, &error)) << error;
  return result.x;
}

double LargestDifference(const Eigen::VectorXd& x, const Eigen::VectorXd& y) {
  return (x - y).cwiseAbs().maxCoeff();
}

bool RunFormula(const ExperimentRun& run, ExperimentTables* tables, std::string* error) {
  CsvTable table({"data", "points", "reach", "w_error", "source_error", "dense_qr_error"});
  double done = 0.0;
  for (const LongData& source : kLongData) {
    Points all;
    const int most = kLengths[std::size(kLengths) - 1];
    if (!ReadDistinctPoints(source.file, 1, most, &all, error)) return false;
    for (const int size : kLengths) {
      if (InterruptRequested()) break;
      if (run.progress) run.progress(done++ / 14.0, std::to_string(size) + " points");
      if (size > all.rows()) continue;
      const FormulaErrors errors = MeasureSourceFormula(all.topRows(size), size <= kMostSolved);
      const auto text = [](double value) { return std::isnan(value) ? "" : NumberText(value); };
      table.AddRow({source.name, std::to_string(size), NumberText(errors.reach),
                    NumberText(errors.w), text(errors.source), text(errors.dense_qr)});
    }
  }
  (*tables)[""] = std::move(table);
  return true;
}

/// By how many digits log10 of `y` rises with a digit of `x`, by least squares.
double PowerOf(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<double>(x.size());
  double sum_x = 0.0, sum_y = 0.0, sum_xx = 0.0, sum_xy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double a = std::log10(x[i]), b = std::log10(y[i]);
    sum_x += a;
    sum_y += b;
    sum_xx += a * a;
    sum_xy += a * b;
  }
  return (n * sum_xy - sum_x * sum_y) / (n * sum_xx - sum_x * sum_x);
}

/// The digits of relative errors, the fewest of them.
std::string DigitsLeft(const std::vector<double>& errors) {
  return Rounded(-std::log10(*std::max_element(errors.begin(), errors.end())), 1);
}

Judgement JudgeFormula(const ExperimentTables& tables) {
  Judgement judgement;
  const CsvTable& table = tables.at("");
  const std::vector<double> points = table.Numbers("points"), w = table.Numbers("w_error");
  const std::vector<double> source = table.Numbers("source_error");
  const std::vector<double> dense = table.Numbers("dense_qr_error");
  std::vector<double> few, few_source, solved, solved_dense;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i] <= kFewPoints) few.push_back(w[i]), few_source.push_back(source[i]);
    if (!std::isnan(source[i])) solved.push_back(source[i]), solved_dense.push_back(dense[i]);
  }
  if (few.empty() || few.size() == points.size()) return judgement;
  judgement.because =
      "with " + std::to_string(kFewPoints) + " points its W has " + DigitsLeft(few) +
      " digits or more and its control points " + DigitsLeft(few_source) + "; up to " +
      std::to_string(kMostSolved) + " points the control points have " + DigitsLeft(solved) +
      ", those of the same solution with W from the basis at Gauss points " +
      DigitsLeft(solved_dense) + "; of the longest data W has " + DigitsLeft(w) +
      "; digits lost grow with the power " + Rounded(PowerOf(table.Numbers("reach"), w), 1) +
      " of the parameter over its step";
  const auto agree = [](const std::vector<double>& errors) {
    return *std::max_element(errors.begin(), errors.end()) <= kAgrees;
  };
  judgement.verdict = agree(w) && agree(solved)         ? ClaimVerdict::kHolds
                      : agree(few) && agree(few_source) ? ClaimVerdict::kInPart
                                                        : ClaimVerdict::kDoesNotHold;
  return judgement;
}

std::vector<PlotPanel> FormulaPanels(const ExperimentTables& tables) {
  PlotPanel w, control_points;
  w.title = "error of W by the source's formula";
  w.x_label = "parameter over its step";
  w.y_label = "relative error";
  control_points.title = "error of the control points at 1 : 1";
  control_points.x_label = "points";
  control_points.y_label = "of the data's size";
  w.log_x = w.log_y = control_points.log_x = control_points.log_y = true;
  int color = 0;
  for (const LongData& source : kLongData) {
    const CsvTable rows = tables.at("").Where("data", source.name);
    w.series.push_back({source.name, rows.Numbers("reach"), rows.Numbers("w_error"),
                        PlotSeries::Style::kLinePoints, color});
    for (const char* way : {"source", "dense_qr"}) {
      PlotSeries series{
          std::string(source.name) + ", " + way, {}, {}, PlotSeries::Style::kLinePoints, color++};
      const std::vector<double> points = rows.Numbers("points");
      const std::vector<double> errors = rows.Numbers(std::string(way) + "_error");
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (std::isnan(errors[i])) continue;
        series.x.push_back(points[i]);
        series.y.push_back(errors[i]);
      }
      control_points.series.push_back(std::move(series));
    }
  }
  PlotSeries cube{"rounding times the cube", {}, {}, PlotSeries::Style::kLine, color};
  const std::vector<double> reach = tables.at("").Numbers("reach");
  if (!reach.empty()) {
    const auto [least, most] = std::minmax_element(reach.begin(), reach.end());
    for (const double place : {*least, *most}) {
      cube.x.push_back(place);
      cube.y.push_back(std::numeric_limits<double>::epsilon() * std::pow(place, 3));
    }
  }
  w.series.push_back(std::move(cube));
  return {w, control_points};
}

}  // namespace

Eigen::MatrixXd SourceFormulaOfW(const std::vector<double>& u) {
  const auto hat = [&u](Eigen::Index j, Eigen::Index s) {
    const double h = u[s + 1] - u[s];
    if (s == j) return Linear<double>(1.0 / h, -u[s] / h);
    if (s == j + 1) return Linear<double>(-1.0 / h, u[s + 1] / h);
    return Linear<double>(0.0, 0.0);
  };
  const auto integral = [&u](Linear<double> f, Linear<double> g, Eigen::Index s) {
    const double p = u[s], q = u[s + 1];
    return f.first * g.first * (q * q * q - p * p * p) / 3.0 +
           (f.first * g.second + f.second * g.first) * (q * q - p * p) / 2.0 +
           f.second * g.second * (q - p);
  };
  return BandOf<double>(u, hat, integral);
}

Eigen::MatrixXd AccurateW(const std::vector<double>& u) {
  using Ends = Linear<long double>;
  const auto hat = [](Eigen::Index j, Eigen::Index s) {
    return s == j ? Ends(0.0L, 1.0L) : s == j + 1 ? Ends(1.0L, 0.0L) : Ends(0.0L, 0.0L);
  };
  const auto integral = [&u](Ends f, Ends g, Eigen::Index s) {
    const long double length = static_cast<long double>(u[s + 1]) - u[s];
    return length / 6.0L *
           (2.0L * f.first * g.first + f.first * g.second + f.second * g.first +
            2.0L * f.second * g.second);
  };
  return BandOf<long double>(u, hat, integral);
}

FormulaErrors MeasureSourceFormula(const Points& points, bool solve) {
  const auto m = points.rows();
  const double mean_chord =
      (points.bottomRows(m - 1) - points.topRows(m - 1)).rowwise().norm().mean();
  const Points scaled = points / mean_chord;
  const auto problem = SourceFit(scaled, 1.0, 1.0);
  const std::vector<double>& u = problem->curve_fit()->basis().knots();
  FormulaErrors errors;
  for (std::size_t s = 3; s + 4 < u.size(); ++s) {
    if (u[s + 1] > u[s]) errors.reach = std::max(errors.reach, u[s + 1] / (u[s + 1] - u[s]));
  }
  const Eigen::MatrixXd formula = SourceFormulaOfW(u);
  errors.w = LargestRelativeError(formula, AccurateW(u));
  if (!solve) return errors;
  const Eigen::VectorXd ours = SolvedBy("banded_qr", *problem);
  errors.source = LargestDifference(SolveWith(formula, scaled), ours);
  errors.dense_qr = LargestDifference(SolvedBy("dense_qr", *problem), ours);
  return errors;
}

Experiment FairingPaperFormula() {
  Experiment experiment;
  experiment.name = "formula";
  experiment.title = "The source's formula for W on long data";
  experiment.text =
      "W holds the integrals of N''_i N''_j. On a span each N'' is a line a u + b; the source "
      "multiplies the lines out and takes differences of cubes, a c (u_(s+1)^3 - u_s^3) / 3 + ..., "
      "in the parameter as it is, which grows along the data. Here so in double, over the first 10 "
      "to 10,000 points of the coast of Greenland and the first 10 to 3000 of a run, scaled to a "
      "mean chord of 1. `reach` is the largest u_(s+1) / (u_(s+1) - u_s); `w_error` the largest "
      "error of an entry of W, over the root of its two diagonal entries, against the values of "
      "the lines at the ends of spans in long double, which cancel nothing. `source_error` is that "
      "of the control points at alpha : beta = 1 : 1 with this W, in units of the data's size, "
      "against QR of the rows in the band; `dense_qr_error` that of the same full matrix with W "
      "summed from the basis at Gauss points (both up to 1000 points).";
  experiment.run = &RunFormula;
  experiment.shown = [](const ExperimentTables& tables) { return tables.at(""); };
  experiment.claims = {
      {"W from the linear pieces of the second derivatives, in the parameter as it is",
       "the method",
       "holds if W and the control points are right to 1e-10 at every length; in part if they are "
       "with 10 points",
       &JudgeFormula}};
  experiment.figures = {{"formula", "What the formula loses.", 2, &FormulaPanels}};
  return experiment;
}

}  // namespace batten
