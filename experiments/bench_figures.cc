#include <algorithm>
#include <cmath>
#include <functional>

#include "experiments/bench_kinds.h"
#include "experiments/bench_tables.h"
#include "experiments/plot_file.h"

namespace batten {
namespace {

constexpr std::size_t kMostPairSolvers = 4;
constexpr double kMargin = 1.5;  // a factor, so that first and last steps are seen

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

/// In the middle of up to three steps, where lines differ most; without any at `part` of the axis.
void AddMarks(const Steps& steps, double part, PlotSeries* series) {
  constexpr std::size_t kMost = 3;
  const double begin = series->x.front(), end = series->x.back();
  const auto first = static_cast<std::size_t>(
      std::upper_bound(steps.x.begin(), steps.x.end(), begin) - steps.x.begin());
  const std::size_t count = steps.x.size() - first;
  for (std::size_t k = 0; k < std::min(kMost, count); ++k) {
    const std::size_t step = first + (2 * k + 1) * count / (2 * std::min(kMost, count));
    series->mark_x.push_back(steps.x[step]);
    series->mark_y.push_back(0.5 * (steps.y[step] + (step > 0 ? steps.y[step - 1] : 0.0)));
  }
  if (count > 0) return;
  series->mark_x = {begin * std::pow(end / begin, part)};
  series->mark_y = {series->y.back()};
}

/// A step function as a line from `begin` to `end` > `begin` > 0, the `index`-th of `count`.
PlotSeries StepLine(const Steps& steps, const std::string& label, std::size_t index,
                    std::size_t count, double begin, double end) {
  PlotSeries series;
  series.label = label;
  series.color = static_cast<int>(index);
  series.style = PlotSeries::Style::kOneOfMany;
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
  AddMarks(steps, (static_cast<double>(index) + 0.5) / static_cast<double>(count), &series);
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
  panel.is_share = true;
  const double end = kMargin * LargestPlace(profiles, begin);
  for (std::size_t s = 0; s < profiles.size(); ++s) {
    panel.series.push_back(StepLine(profiles[s], names[s], s, profiles.size(), begin, end));
  }
  return panel;
}

bool AnyFinite(const CostTable& costs) {
  return std::any_of(costs.begin(), costs.end(), [](const std::vector<double>& row) {
    return std::any_of(row.begin(), row.end(), [](double cost) { return std::isfinite(cost); });
  });
}

/// Where an axis begins so that first steps are seen; 1 where there are none.
double FirstPlace(const std::vector<Steps>& profiles) {
  double smallest = HUGE_VAL;
  for (const Steps& steps : profiles) {
    if (!steps.x.empty()) smallest = std::min(smallest, steps.x.front());
  }
  return std::isfinite(smallest) ? smallest / kMargin : 1.0;
}

/// To the best basin, and where there are several to a run's own one beside it.
std::vector<BenchGoal> GoalsOf(const BenchResults& results) {
  if (!HasBasins(results)) return {BenchGoal::kBestBasin};
  return {BenchGoal::kBestBasin, BenchGoal::kOwnBasin};
}

std::string Title(const BenchResults& results, const std::string& what, BenchGoal goal) {
  if (!HasBasins(results)) return what;
  return what + (goal == BenchGoal::kBestBasin ? ", best basin" : ", own basin");
}

/// A panel for each target, cost and goal, goals side by side, of what somebody reaches.
using MakePanel = std::function<PlotPanel(const std::string& title, std::size_t target,
                                          BenchCost cost, BenchGoal goal)>;
std::vector<PlotPanel> PanelsOf(const BenchResults& results, const MakePanel& make) {
  std::vector<PlotPanel> panels;
  for (std::size_t t = 0; t < results.targets.size(); ++t) {
    for (const BenchCost cost : kBenchCosts) {
      // Whoever comes to the best basin comes to its own one: panels of both, or of none.
      if (!AnyFinite(CostsOf(results, t, cost, nullptr, GoalsOf(results).back()))) continue;
      for (const BenchGoal goal : GoalsOf(results)) {
        const std::string what = results.targets[t].label + ", " + AxisName(cost);
        panels.push_back(make(Title(results, what, goal), t, cost, goal));
      }
    }
  }
  return panels;
}

std::vector<PlotPanel> PerformancePanels(const BenchResults& results) {
  return PanelsOf(results, [&results](const std::string& title, std::size_t target, BenchCost cost,
                                      BenchGoal goal) {
    return StepPanel(title, "times the best solver's " + AxisName(cost),
                     PerformanceProfiles(CostsOf(results, target, cost, nullptr, goal)),
                     results.solvers, 1.0);
  });
}

std::vector<PlotPanel> DataPanels(const BenchResults& results) {
  return PanelsOf(results, [&results](const std::string& title, std::size_t target, BenchCost cost,
                                      BenchGoal goal) {
    std::vector<std::size_t> rows_of;
    const CostTable costs = CostsOf(results, target, cost, &rows_of, goal);
    const bool is_counted = cost == BenchCost::kEvaluations;
    std::vector<double> units(costs.size(), 1.0);
    for (std::size_t k = 0; is_counted && k < units.size(); ++k) {
      units[k] = results.instances[rows_of[k]].num_variables + 1.0;
    }
    const std::vector<Steps> profiles = DataProfiles(costs, units);
    return StepPanel(title, AxisName(cost) + (is_counted ? " / (n + 1)" : ""), profiles,
                     results.solvers, FirstPlace(profiles));
  });
}

/// Of each solver, on all instances and to all targets.
CostTable AllCosts(const BenchResults& results, BenchCost cost, BenchGoal goal) {
  CostTable all(results.solvers.size());
  for (std::size_t t = 0; t < results.targets.size(); ++t) {
    for (const std::vector<double>& row : CostsOf(results, t, cost, nullptr, goal)) {
      for (std::size_t s = 0; s < row.size(); ++s) all[s].push_back(row[s]);
    }
  }
  return all;
}

std::vector<PlotPanel> DistributionPanels(const BenchResults& results) {
  std::vector<PlotPanel> panels;
  for (const BenchCost cost : kBenchCosts) {
    if (!AnyFinite(AllCosts(results, cost, GoalsOf(results).back()))) continue;
    for (const BenchGoal goal : GoalsOf(results)) {
      std::vector<Steps> steps;
      for (const std::vector<double>& costs : AllCosts(results, cost, goal)) {
        steps.push_back(Distribution(costs));
      }
      panels.push_back(
          StepPanel(Title(results, "instances x targets reached, " + AxisName(cost), goal),
                    AxisName(cost), steps, results.solvers, FirstPlace(steps)));
    }
  }
  return panels;
}

std::vector<PlotPanel> PairPanelsOf(const BenchResults& results, std::size_t target) {
  std::vector<PlotPanel> panels;
  for (std::size_t a = 0; a < results.solvers.size(); ++a) {
    for (std::size_t b = a + 1; b < results.solvers.size(); ++b) {
      const CostTable costs = PairCosts(results, target, BenchCost::kEvaluations, a, b);
      if (!AnyFinite(costs)) continue;
      const std::string what =
          results.solvers[a] + " and " + results.solvers[b] + ", " + results.targets[target].label;
      panels.push_back(StepPanel(Title(results, what, BenchGoal::kOwnBasin),
                                 "times the better one's evaluations", PairProfiles(costs, 0, 1),
                                 {results.solvers[a], results.solvers[b]}, 1.0));
    }
  }
  return panels;
}

/// Of the strictest gap.
std::vector<PlotPanel> PairPanels(const BenchResults& results) {
  std::size_t target = 0;
  for (std::size_t t = 0; t < results.targets.size(); ++t) {
    if (results.targets[t].gap > 0.0) target = t;
  }
  const bool has_pairs = results.solvers.size() <= kMostPairSolvers && !results.targets.empty();
  return has_pairs ? PairPanelsOf(results, target) : std::vector<PlotPanel>();
}

/// Without those of time where all runs overlapped. At least 1.
int NumCosts(const BenchResults& results) {
  const auto count = std::count_if(kBenchCosts.begin(), kBenchCosts.end(), [&](BenchCost cost) {
    return AnyFinite(AllCosts(results, cost, GoalsOf(results).back()));
  });
  return std::max(1, static_cast<int>(count));
}

struct BenchFigure {
  const char* name;
  std::vector<PlotPanel> (*panels)(const BenchResults& results);
  int columns;  // where there are no basins, which stand in two
};

}  // namespace

std::vector<FigureResult> DrawBenchFigures(const BenchResults& results, const std::string& folder,
                                           FileBatch* batch) {
  std::vector<FigureResult> figures;
  for (const char* kind : {"fixed", "free", "projected"}) {
    const BenchResults part = OfKind(results, kind);
    const int costs = NumCosts(part);
    const BenchFigure all[] = {{"performance_profiles", &PerformancePanels, costs},
                               {"data_profiles", &DataPanels, costs},
                               {"runtime_distributions", &DistributionPanels, 1},
                               {"pair_profiles", &PairPanels, 2}};
    for (const BenchFigure& figure : all) {
      figures.push_back(DrawPlotForReport(folder + "/" + figure.name + "_" + kind,
                                          figure.panels(part), HasBasins(part) ? 2 : figure.columns,
                                          batch));
    }
  }
  return figures;
}

}  // namespace batten
