#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "experiments/experiment_runs.h"
#include "experiments/fairing_paper.h"
#include "problems/curve_view.h"
#include "splines/banded_rows.h"

namespace batten {
namespace {

constexpr const char* kMethods[] = {"dense_qr", "banded_cholesky", "banded_qr"};
constexpr int kSizes[] = {10, 30, 100, 300, 1000};
/// Up to here the reference is a dense QR of the rows in long double.
constexpr int kMostForReference = 300;
constexpr int kShort = 100;

using LongMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

/// All rows, dense, with their right-hand sides behind the coefficients.
class RowReader : public RowConsumer {
 public:
  explicit RowReader(const RowShape& shape)
      : shape_(shape),
        rows(LongMatrix::Zero(shape.num_rows, shape.num_columns + shape.dimension)) {}
  void Consume(const RowBlock& block) override {
    for (int i = 0; i < block.num_rows; ++i, ++next_) {
      for (int j = 0; j < shape_.width; ++j) {
        const double entry = block.coefficients[j * block.stride + i];
        if (entry != 0.0) rows(next_, block.first_column + j) += entry;
      }
      for (int c = 0; c < shape_.dimension; ++c) {
        rows(next_, shape_.num_columns + c) = block.right_hand_sides[c * block.stride + i];
      }
    }
  }

 private:
  RowShape shape_;
  int next_ = 0;

 public:
  LongMatrix rows;
};

/// The minimiser by QR of the rows themselves in long double.
Eigen::VectorXd Reference(const Problem& problem) {
  const auto view = CurveView::Make(problem, nullptr);
  RowReader reader(view->shape());
  view->rows().Stream(&reader);
  const LongMatrix a = reader.rows.leftCols(view->num_points());
  const LongMatrix q = reader.rows.rightCols(view->dimension());
  const Points solution = LongMatrix(a.colPivHouseholderQr().solve(q)).cast<double>();
  return Eigen::Map<const Eigen::VectorXd>(solution.data(), solution.size());
}

/// A plane curve that bends more and more, its neighbours about one unit apart.
Points GrowingCurve(int num_points) {
  Points points(num_points, 2);
  double heading = 0.0, x = 0.0, y = 0.0;
  for (int i = 0; i < num_points; ++i) {
    points.row(i) << x, y;
    heading = 1.3 * std::sin(0.11 * i) + 0.4 * std::sin(0.53 * i);
    x += std::cos(heading);
    y += std::sin(heading);
  }
  return points;
}

double DigitsOf(const Eigen::VectorXd& x, const Eigen::VectorXd& reference) {
  const double error = (x - reference).cwiseAbs().maxCoeff();
  return -std::log10(std::max(error, std::numeric_limits<double>::epsilon()));
}

bool RunMethods(const ExperimentRun& run, ExperimentTables* tables, std::string* /*error*/) {
  CsvTable table({"points", "setting", "method", "seconds", "times_cholesky", "digits"});
  double done = 0.0;
  for (const int size : kSizes) {
    for (const FairingRatio& ratio :
         {FairingRatio{"1 : 1", 1.0, 1.0}, FairingRatio{"1 : 0.01", 1.0, 0.01},
          FairingRatio{"1 : 1e-8", 1.0, 1e-8}}) {
      if (InterruptRequested()) break;
      if (run.progress) run.progress(done++ / 15.0, std::to_string(size) + " points");
      const auto problem = SourceFit(GrowingCurve(size), ratio.alpha, ratio.beta);
      ProblemRuns runs(std::string("curve (") + ratio.name + ")", problem, run.repetitions,
                       run.recorder);
      Eigen::VectorXd reference;
      if (size <= kMostForReference) reference = Reference(*problem);
      for (const char* method : kMethods) {
        CsvTable rows(RunColumns());
        const RunResult result = runs.Run(method, RunSpec(), &rows);
        const std::string digits =
            reference.size() > 0 ? Rounded(DigitsOf(result.x, reference), 1) : "";
        table.AddRow({std::to_string(size), ratio.name, method, rows.Text(0, "seconds"),
                      rows.Text(0, "times_cholesky"), digits});
      }
    }
  }
  (*tables)[""] = std::move(table);
  return true;
}

CsvTable Of(const ExperimentTables& tables, const std::string& method, int points) {
  return tables.at("").Where("method", method).Where("points", std::to_string(points));
}

/// Least digits of a method on data of up to `points` points.
double LeastDigits(const ExperimentTables& tables, const std::string& method,
                   const std::string& setting, int points) {
  double least = std::numeric_limits<double>::infinity();
  for (const int size : kSizes) {
    if (size > points) continue;
    const CsvTable rows = Of(tables, method, size).Where("setting", setting);
    for (const double digits : rows.Numbers("digits")) least = std::min(least, digits);
  }
  return least;
}

Judgement JudgeDigits(const ExperimentTables& tables) {
  constexpr double kAsked = 10.0;
  Judgement judgement;
  const double small = std::min(LeastDigits(tables, "dense_qr", "1 : 1", kShort),
                                LeastDigits(tables, "dense_qr", "1 : 0.01", kShort));
  const double cancelled = LeastDigits(tables, "dense_qr", "1 : 1e-8", kMostForReference);
  const double band = LeastDigits(tables, "banded_qr", "1 : 1e-8", kMostForReference);
  if (!std::isfinite(small) || !std::isfinite(cancelled) || !std::isfinite(band)) return judgement;
  judgement.because = "up to 100 points its control points have at least " + Rounded(small, 1) +
                      " digits; with alpha / beta = 1e8 and up to 300 points " +
                      Rounded(cancelled, 1) + " are left, of QR in the band " + Rounded(band, 1);
  judgement.verdict = small < kAsked       ? ClaimVerdict::kDoesNotHold
                      : cancelled < kAsked ? ClaimVerdict::kInPart
                                           : ClaimVerdict::kHolds;
  return judgement;
}

Judgement JudgeTime(const ExperimentTables& tables) {
  Judgement judgement;
  const CsvTable dense = Of(tables, "dense_qr", 1000).Where("setting", "1 : 1");
  const CsvTable band = Of(tables, "banded_cholesky", 1000).Where("setting", "1 : 1");
  if (dense.num_rows() != 1 || band.num_rows() != 1) return judgement;
  const double ratio = dense.Number(0, "seconds") / band.Number(0, "seconds");
  judgement.because = "at 1000 points the full matrix takes " +
                      Rounded(1e3 * dense.Number(0, "seconds"), 0) + " ms and the band " +
                      Rounded(1e3 * band.Number(0, "seconds"), 3) + " ms: " + Rounded(ratio, 0) +
                      " times as long";
  constexpr double kAlike = 2.0;
  judgement.verdict = ratio <= kAlike ? ClaimVerdict::kHolds : ClaimVerdict::kDoesNotHold;
  return judgement;
}

std::vector<PlotPanel> Times(const ExperimentTables& tables) {
  PlotPanel time;
  time.title = "time of one solve";
  time.x_label = "points";
  time.y_label = "seconds";
  time.log_x = time.log_y = true;
  PlotPanel digits;
  digits.title = "digits at alpha / beta = 1e8";
  digits.x_label = "points";
  digits.y_label = "digits";
  digits.log_x = true;
  int color = 0;
  for (const char* method : kMethods) {
    const CsvTable rows = tables.at("").Where("method", method);
    const CsvTable equal = rows.Where("setting", "1 : 1");
    const CsvTable heavy = rows.Where("setting", "1 : 1e-8");
    time.series.push_back({method, equal.Numbers("points"), equal.Numbers("seconds"),
                           PlotSeries::Style::kLinePoints, color});
    digits.series.push_back({method, heavy.Numbers("points"), heavy.Numbers("digits"),
                             PlotSeries::Style::kLinePoints, color++});
  }
  return {time, digits};
}

}  // namespace

Experiment FairingPaperMethod() {
  Experiment experiment;
  experiment.name = "method";
  experiment.title = "A full matrix by column-pivoted QR against the band";
  experiment.text =
      "A plane curve with 10 to 1000 points about one unit apart. `dense_qr` is the source's "
      "method; "
      "`banded_cholesky` solves the same normal equations in their band, `banded_qr` the rows they "
      "are made of. Digits: -log10 of the largest difference of a control point from the answer of "
      "a QR of the rows in long double, in units of the data's size (up to 300 points; where "
      "normal "
      "equations lose all digits `banded_cholesky` says so and hands over to `banded_qr`).";
  experiment.run = &RunMethods;
  experiment.shown = [](const ExperimentTables& tables) { return tables.at(""); };
  experiment.claims = {
      {"P = beta (alpha W + beta M'M)^-1 M'F by column-pivoted QR", "the method",
       "holds if its control points have 10 digits up to 100 points at the source's ratios and "
       "also "
       "at alpha / beta = 1e8 up to 300 points; in part if the former only",
       &JudgeDigits},
      {"the equations are solved as a full matrix", "the method",
       "holds as a choice if at 1000 points it takes at most twice the time of the band",
       &JudgeTime}};
  experiment.figures = {{"method", "Time and digits.", 2, &Times}};
  return experiment;
}

}  // namespace batten
