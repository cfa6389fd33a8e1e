#include <algorithm>
#include <cmath>

#include "experiments/accelerated_gim.h"
#include "experiments/experiment_runs.h"

namespace batten {
namespace {

constexpr long kMostPoints = 10'000'000;
// Above it a run is made once: it takes long enough to be measured.
constexpr long kManyPoints = 100'000;

struct Grid {
  int n;
  int per_control_point;  // m / n
};

std::vector<Grid> Sizes() {
  std::vector<Grid> sizes;
  for (const int n : {50, 500, 5000, 50'000, 500'000, 1'000'000}) {
    for (const int ratio : {1, 2, 10, 100}) {
      if (static_cast<long>(n) * ratio <= kMostPoints) sizes.push_back({n, ratio});
    }
  }
  return sizes;
}

bool RunSizes(const ExperimentRun& run, ExperimentTables* tables, std::string* /*error*/) {
  CsvTable& runs = (*tables)[""] = CsvTable(RunColumnsBehind({"points_per_control_point"}));
  const std::vector<Grid> sizes = Sizes();
  double done = 0.0;
  for (const Grid& size : sizes) {
    const int m = size.n * size.per_control_point;
    if (run.progress) {
      run.progress(done / static_cast<double>(sizes.size()),
                   std::to_string(m) + " points, " + std::to_string(size.n) + " control points");
    }
    done += 1.0;
    ProblemRuns on("loop", LoopProblem(m, size.n, kLoopSize), m > kManyPoints ? 1 : run.repetitions,
                   run.recorder);
    CsvTable rows(RunColumns());
    for (RunSpec spec : {NativeSpec(1e-6), RaceSpec(1e-6)}) {
      if (spec.mode == Mode::kNative && m > kManyPoints) continue;
      spec.keep_trace = false;
      spec.max_seconds = 20.0;
      for (const char* solver : {kLspia, "lspia/step=optimal", kLbfgs, "cg", "banded_cholesky"}) {
        if (InterruptRequested()) return true;
        on.Run(solver, spec, &rows);
      }
    }
    AddRowsBehind({std::to_string(size.per_control_point)}, rows, &runs);
  }
  return true;
}

/// Slope of log(lspia / lbfgs) of `column` on log n, over race rows; NaN for fewer than two sizes.
double Slope(const ExperimentTables& tables, const std::string& column) {
  const CsvTable race = tables.at("").Where("mode", "race");
  const CsvTable slow = race.Where("solver", kLspia);
  const CsvTable fast = race.Where("solver", kLbfgs);
  if (slow.num_rows() != fast.num_rows()) return std::nan("");
  std::vector<double> x, y;
  for (std::size_t row = 0; row < slow.num_rows(); ++row) {
    const double ratio = slow.Number(row, column) / fast.Number(row, column);
    if (!(ratio > 0.0) || !std::isfinite(ratio)) continue;
    x.push_back(std::log(slow.Number(row, "control_points")));
    y.push_back(std::log(ratio));
  }
  const auto count = static_cast<Eigen::Index>(x.size());
  if (count < 2) return std::nan("");
  const Eigen::ArrayXd dx = Eigen::Map<const Eigen::ArrayXd>(x.data(), count) -
                            Eigen::Map<const Eigen::ArrayXd>(x.data(), count).mean();
  const Eigen::ArrayXd dy = Eigen::Map<const Eigen::ArrayXd>(y.data(), count) -
                            Eigen::Map<const Eigen::ArrayXd>(y.data(), count).mean();
  return (dx * dy).sum() / dx.square().sum();
}

Judgement JudgeGrowth(const ExperimentTables& tables) {
  constexpr double kGrows = 0.1;
  const double iterations = Slope(tables, "iterations");
  const double seconds = Slope(tables, "seconds");
  Judgement judgement;
  if (std::isnan(iterations) || std::isnan(seconds)) return judgement;
  judgement.because = "over the sizes the ratio lspia / lbfgs of iterations goes like n^" +
                      Rounded(iterations, 2) + ", that of times like n^" + Rounded(seconds, 2);
  const bool both = iterations > kGrows && seconds > kGrows;
  const bool one = iterations > kGrows || seconds > kGrows;
  judgement.verdict = both  ? ClaimVerdict::kHolds
                      : one ? ClaimVerdict::kInPart
                            : ClaimVerdict::kDoesNotHold;
  return judgement;
}

std::vector<PlotPanel> AgainstSize(const ExperimentTables& tables) {
  std::vector<PlotPanel> panels;
  const CsvTable race = tables.at("").Where("mode", "race");
  for (const char* column : {"iterations", "seconds"}) {
    for (const char* ratio : {"2", "10"}) {
      PlotPanel panel;
      panel.title = std::string("m / n = ") + ratio + ", |g| <= 1e-6 |g(start)|";
      panel.x_label = "control points n";
      panel.y_label = column;
      panel.log_x = panel.log_y = true;
      const CsvTable rows = race.Where("points_per_control_point", ratio);
      int color = 0;
      for (const std::string& solver : rows.Distinct("solver")) {
        const CsvTable of = rows.Where("solver", solver);
        panel.series.push_back({solver, of.Numbers("control_points"), of.Numbers(column),
                                PlotSeries::Style::kLinePoints, color++});
      }
      panels.push_back(std::move(panel));
    }
  }
  return panels;
}

}  // namespace

Experiment AcceleratedGimSize() {
  Experiment experiment;
  experiment.name = "size";
  experiment.title = "The advantage against the size";
  experiment.text =
      "Closed loops with noise, uniform cubics, uniform parameters: n control points from 50 to "
      "1e6, m / n from 1 to 100, m up to 1e7; native runs up to 1e5 points. Race runs stop at |g| "
      "<= 1e-6 |g(start)|, all runs "
      "after 20 s. Times contain the set-up (summing up the normal band from m rows), which all "
      "methods share; `optimal` also estimates eigenvalues, in up to 300 products, which is dear "
      "on small problems. Above 1e5 points a run is made once. In the table they are multiples (x) "
      "of that of banded_cholesky.";
  experiment.run = &RunSizes;
  experiment.shown = [](const ExperimentTables& tables) {
    CsvTable shown({"n", "m", "lspia", "optimal", "lbfgs", "cg", "lspia x", "optimal x", "lbfgs x",
                    "cg x", "cholesky s"});
    const CsvTable race = tables.at("").Where("mode", "race");
    const CsvTable lspia = race.Where("solver", kLspia);
    const auto of = [&race](const char* solver) { return race.Where("solver", solver); };
    const CsvTable optimal = of("lspia/step=optimal"), lbfgs = of(kLbfgs), cg = of("cg"),
                   cholesky = of("banded_cholesky");
    const std::size_t rows = std::min({cholesky.num_rows(), lspia.num_rows(), optimal.num_rows(),
                                       lbfgs.num_rows(), cg.num_rows()});
    for (std::size_t row = 0; row < rows; ++row) {
      shown.AddRow({lspia.Text(row, "control_points"), lspia.Text(row, "points"),
                    lspia.Text(row, "iterations"), optimal.Text(row, "iterations"),
                    lbfgs.Text(row, "iterations"), cg.Text(row, "iterations"),
                    lspia.Text(row, "times_cholesky"), optimal.Text(row, "times_cholesky"),
                    lbfgs.Text(row, "times_cholesky"), cg.Text(row, "times_cholesky"),
                    cholesky.Text(row, "seconds")});
    }
    return shown;
  };
  experiment.claims = {
      {"The advantage grows with the size", "section on experiments",
       "fits log(lspia / lbfgs) against log n over all race rows: holds where both the ratio of "
       "iterations and that of times grow faster than n^0.1, in part where one does",
       &JudgeGrowth}};
  experiment.figures = {{"size_growth",
                         "Iterations and times against the number of control points, race.", 2,
                         &AgainstSize}};
  return experiment;
}

}  // namespace batten
