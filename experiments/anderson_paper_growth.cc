#include "experiments/anderson_paper_growth.h"

#include <cmath>

#include "experiments/anderson_paper_judges.h"
#include "experiments/anderson_paper_runs.h"
#include "experiments/experiment_runs.h"

namespace batten {
namespace {

// Enough for a mean, and before any method is done.
constexpr int kIterations = 30;

/// How many of `solvers` grow faster than size^most; -1 where one cannot be told.
int CountFaster(const CsvTable& table, const std::vector<std::string>& solvers,
                const std::string& size, double most, std::string* because) {
  int faster = 0;
  for (const std::string& solver : solvers) {
    const double power = GrowthPower(table, solver, size);
    if (std::isnan(power)) return -1;
    faster += power > most ? 1 : 0;
    *because += (because->empty() ? "" : "; ");
    *because += solver + " size^" + Rounded(power, 2);
  }
  return faster;
}

}  // namespace

std::vector<std::string> GrowthColumns() {
  return {"points", "control_points", "solver", "seconds_per_iteration"};
}

void AddGrowthRows(const Problem& problem, const ExperimentRun& run, double done, CsvTable* table) {
  const std::string points = std::to_string(problem.curve_fit()->parameters().size());
  const std::string control_points =
      std::to_string(problem.curve_fit()->basis().num_control_points());
  for (const std::string& solver : IteratingMethods()) {
    if (InterruptRequested()) return;
    if (run.progress) {
      run.progress(done, points + " points, " + control_points + " control points, " + solver);
    }
    const double seconds = SecondsPerIteration(problem, solver, kIterations, run.repetitions);
    table->AddRow({points, control_points, solver, NumberText(seconds)});
  }
}

double GrowthPower(const CsvTable& table, const std::string& solver, const std::string& size) {
  const CsvTable rows = table.Where("solver", solver);
  std::vector<double> x, y;
  for (std::size_t row = 0; row < rows.num_rows(); ++row) {
    const double log_size = std::log(rows.Number(row, size));
    const double log_time = std::log(rows.Number(row, "seconds_per_iteration"));
    if (!std::isfinite(log_size) || !std::isfinite(log_time)) continue;
    x.push_back(log_size);
    y.push_back(log_time);
  }
  if (x.size() < 2) return std::nan("");
  const auto count = static_cast<Eigen::Index>(x.size());
  Eigen::ArrayXd dx = Eigen::Map<const Eigen::ArrayXd>(x.data(), count);
  Eigen::ArrayXd dy = Eigen::Map<const Eigen::ArrayXd>(y.data(), count);
  dx -= dx.mean();
  dy -= dy.mean();
  const double spread = dx.square().sum();
  return spread > 0.0 ? (dx * dy).sum() / spread : std::nan("");
}

Judgement JudgeLinear(const ExperimentTables& tables, const std::string& size) {
  constexpr double kLinear = 1.15;
  Judgement judgement;
  std::string powers;
  const int faster =
      CountFaster(tables.at(""), {kJointLbfgs, kAndersonPdm}, size, kLinear, &powers);
  if (faster < 0) return judgement;
  judgement.because = "time per iteration goes like: " + powers;
  judgement.verdict = VerdictOf(2 - faster, 2);
  return judgement;
}

Judgement JudgeSlowsDown(const ExperimentTables& tables, const std::string& size) {
  constexpr double kFast = 1.5;
  Judgement judgement;
  std::string powers;
  const int faster = CountFaster(tables.at(""), {"pdm", "tdm", "sdm"}, size, kFast, &powers);
  if (faster < 0) return judgement;
  judgement.because =
      "with the normal equations in their band time per iteration goes like: " + powers;
  judgement.verdict = VerdictOf(faster, 3);
  return judgement;
}

std::vector<PlotPanel> AgainstGrowth(const ExperimentTables& tables, const std::string& size) {
  PlotPanel panel;
  panel.title = "The first " + std::to_string(kIterations) + " iterations from the circle";
  panel.x_label = size == "points" ? "points" : "control points";
  panel.y_label = "seconds per iteration";
  panel.log_x = panel.log_y = true;
  int color = 0;
  for (const char* solver : kDrawnMethods) {
    const CsvTable rows = tables.at("").Where("solver", solver);
    panel.series.push_back({solver, rows.Numbers(size), rows.Numbers("seconds_per_iteration"),
                            PlotSeries::Style::kLinePoints, color++});
  }
  return {panel};
}

CsvTable GrowthShown(const ExperimentTables& tables, const std::string& size) {
  std::vector<std::string> columns = {size};
  for (const std::string& solver : IteratingMethods()) columns.push_back(solver + " us");
  CsvTable shown(columns);
  const CsvTable& all = tables.at("");
  for (const std::string& value : all.Distinct(size)) {
    const CsvTable on = all.Where(size, value);
    std::vector<std::string> row = {value};
    for (const std::string& solver : IteratingMethods()) {
      row.push_back(
          NumberText(1e6 * OnlyNumber(on.Where("solver", solver), "seconds_per_iteration")));
    }
    shown.AddRow(row);
  }
  return shown;
}

}  // namespace batten
