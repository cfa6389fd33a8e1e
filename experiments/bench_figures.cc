#include <algorithm>
#include <cmath>

#include "experiments/bench_tables.h"
#include "experiments/plot.h"

namespace batten {
namespace {

constexpr std::size_t kMostPairSolvers = 4;

std::string AxisName(BenchCost cost) {
  switch (cost) {
    case BenchCost::kEvaluations:
      return "evaluations";
    case BenchCost::kWorkUnits:
      return "work units";
    case BenchCost::kSeconds:
      return "seconds";
  }
  return "";
}

double LargestPlace(const std::vector<Steps>& profiles, double lowest) {
  double largest = lowest;
  for (const Steps& steps : profiles) {
    if (!steps.x.empty()) largest = std::max(largest, steps.x.back());
  }
  return largest;
}

/// A step function as a line, from `begin` to `end`.
PlotSeries StepLine(const Steps& steps, const std::string& label, int color, double begin,
                    double end) {
  PlotSeries series;
  series.label = label;
  series.color = color;
  series.style = color < 8 ? PlotSeries::Style::kLine : PlotSeries::Style::kDashed;
  double y = 0.0;
  series.x.push_back(begin);
  series.y.push_back(steps.At(begin));
  y = series.y.back();
  for (std::size_t k = 0; k < steps.x.size(); ++k) {
    if (steps.x[k] <= begin) continue;
    series.x.push_back(steps.x[k]);
    series.y.push_back(y);
    y = steps.y[k];
    series.x.push_back(steps.x[k]);
    series.y.push_back(y);
  }
  series.x.push_back(end);
  series.y.push_back(y);
  return series;
}

PlotPanel StepPanel(const std::string& title, const std::string& x_label,
                    const std::vector<Steps>& profiles, const std::vector<std::string>& names,
                    double begin) {
  PlotPanel panel;
  panel.title = title;
  panel.x_label = x_label;
  panel.y_label = "share";
  panel.log_x = true;
  constexpr double kMargin = 1.5;  // a factor, so that last steps are seen
  const double end = kMargin * LargestPlace(profiles, begin);
  for (std::size_t s = 0; s < profiles.size(); ++s) {
    panel.series.push_back(StepLine(profiles[s], names[s], static_cast<int>(s), begin, end));
  }
  return panel;
}

bool AnyFinite(const CostTable& costs) {
  return std::any_of(costs.begin(), costs.end(), [](const std::vector<double>& row) {
    return std::any_of(row.begin(), row.end(), [](double cost) { return std::isfinite(cost); });
  });
}

double SmallestPlace(const std::vector<Steps>& profiles) {
  double smallest = HUGE_VAL;
  for (const Steps& steps : profiles) {
    if (!steps.x.empty()) smallest = std::min(smallest, steps.x.front());
  }
  return smallest;
}

/// By each target (rows) and cost (columns).
std::vector<PlotPanel> PerformancePanels(const BenchResults& results) {
  std::vector<PlotPanel> panels;
  for (std::size_t t = 0; t < results.targets.size(); ++t) {
    for (const BenchCost cost : kBenchCosts) {
      const CostTable costs = CostsOf(results, t, cost, nullptr);
      if (!AnyFinite(costs)) continue;
      panels.push_back(StepPanel(results.targets[t].label + ", " + AxisName(cost),
                                 "times the best solver's " + AxisName(cost),
                                 PerformanceProfiles(costs), results.solvers, 1.0));
    }
  }
  return panels;
}

std::vector<PlotPanel> DataPanels(const BenchResults& results) {
  std::vector<PlotPanel> panels;
  for (std::size_t t = 0; t < results.targets.size(); ++t) {
    for (const BenchCost cost : kBenchCosts) {
      std::vector<std::size_t> rows_of;
      const CostTable costs = CostsOf(results, t, cost, &rows_of);
      if (!AnyFinite(costs)) continue;
      std::vector<double> units(costs.size(), 1.0);
      if (cost == BenchCost::kEvaluations) {
        for (std::size_t k = 0; k < units.size(); ++k) {
          units[k] = results.instances[rows_of[k]].num_variables + 1.0;
        }
      }
      const std::vector<Steps> profiles = DataProfiles(costs, units);
      const std::string label =
          AxisName(cost) + (cost == BenchCost::kEvaluations ? " / (n + 1)" : "");
      panels.push_back(StepPanel(results.targets[t].label + ", " + AxisName(cost), label, profiles,
                                 results.solvers, SmallestPlace(profiles) / 1.5));
    }
  }
  return panels;
}

/// Over all targets at once.
std::vector<PlotPanel> DistributionPanels(const BenchResults& results) {
  std::vector<PlotPanel> panels;
  for (const BenchCost cost : kBenchCosts) {
    std::vector<std::vector<double>> all(results.solvers.size());
    for (std::size_t t = 0; t < results.targets.size(); ++t) {
      for (const std::vector<double>& row : CostsOf(results, t, cost, nullptr)) {
        for (std::size_t s = 0; s < row.size(); ++s) all[s].push_back(row[s]);
      }
    }
    if (!AnyFinite(all)) continue;
    std::vector<Steps> steps;
    for (std::vector<double>& costs : all) steps.push_back(Distribution(std::move(costs)));
    panels.push_back(StepPanel("instances x targets reached", AxisName(cost), steps,
                               results.solvers, SmallestPlace(steps) / 1.5));
  }
  return panels;
}

std::vector<PlotPanel> PairPanels(const BenchResults& results, std::size_t target) {
  std::vector<PlotPanel> panels;
  for (std::size_t a = 0; a < results.solvers.size(); ++a) {
    for (std::size_t b = a + 1; b < results.solvers.size(); ++b) {
      const CostTable costs = PairCosts(results, target, BenchCost::kEvaluations, a, b);
      if (!AnyFinite(costs)) continue;
      panels.push_back(StepPanel(results.targets[target].label + ", one basin",
                                 "times the better one's evaluations", PairProfiles(costs, 0, 1),
                                 {results.solvers[a], results.solvers[b]}, 1.0));
    }
  }
  return panels;
}

FigureResult DrawOrRemove(const std::string& stem, const std::vector<PlotPanel>& panels,
                          int columns, FileBatch* batch) {
  if (panels.empty()) return NoFigure(stem, "", batch);
  return DrawPlot(stem, panels, columns, batch);
}

}  // namespace

std::vector<FigureResult> DrawBenchFigures(const BenchResults& results, const std::string& folder,
                                           FileBatch* batch) {
  const int costs = results.overlapped ? 1 : static_cast<int>(kBenchCosts.size());
  std::vector<FigureResult> figures = {
      DrawOrRemove(folder + "/performance_profiles", PerformancePanels(results), costs, batch),
      DrawOrRemove(folder + "/data_profiles", DataPanels(results), costs, batch),
      DrawOrRemove(folder + "/runtime_distributions", DistributionPanels(results), 1, batch)};
  const bool has_pairs = results.solvers.size() <= kMostPairSolvers && !results.targets.empty();
  // Of the strictest gap.
  std::size_t target = 0;
  for (std::size_t t = 0; t < results.targets.size(); ++t) {
    if (results.targets[t].gap > 0.0) target = t;
  }
  figures.push_back(DrawOrRemove(folder + "/pair_profiles",
                                 has_pairs ? PairPanels(results, target) : std::vector<PlotPanel>(),
                                 2, batch));
  return figures;
}

}  // namespace batten
