#include <glog/logging.h>

#include <algorithm>
#include <cmath>

#include "experiments/accelerated_gim.h"
#include "experiments/experiment_runs.h"

namespace batten {
namespace {

constexpr double kFactors[] = {1e-3, 1.0, 10.0, 1e3, 1e6};

std::shared_ptr<const Problem> InOtherUnits(const Problem& outline, double factor) {
  DataSet data = outline.curve_fit()->data();
  data.points *= factor;
  return CheckedFit(std::move(data), outline.curve_fit()->spec());
}

bool RunUnits(const ExperimentRun& run, ExperimentTables* tables, std::string* error) {
  CsvTable& runs = (*tables)[""] = CsvTable(RunColumnsBehind({"factor", "rule"}));
  double done = 0.0;
  for (const char* name : {"rhino", "dolphin"}) {
    const std::shared_ptr<const Problem> outline = CatalogueProblem(name, error);
    if (outline == nullptr) return false;
    for (const double factor : kFactors) {
      if (run.progress) run.progress(done / (2.0 * std::size(kFactors)), name);
      done += 1.0;
      ProblemRuns on(name, InOtherUnits(*outline, factor), run.repetitions, run.recorder);
      for (const StopRule& rule : PaperRules()) {
        for (const char* solver : {"lspia", "lbfgs", "cg"}) {
          if (InterruptRequested()) return true;
          if (!RuleConcerns(rule, solver)) continue;
          CsvTable rows(RunColumns());
          on.Run(solver, rule.spec, &rows);
          AddRowsBehind({NumberText(factor), rule.name}, rows, &runs);
        }
      }
    }
  }
  return true;
}

/// Least and most iterations of `solver` on `problem` by `rule` over the units, how many runs have
/// a count, and how many of the runs did not end by the rule.
struct Spread {
  double least = 0.0, most = 0.0;
  int runs = 0;
  int missed = 0;
};

Spread SpreadOf(const ExperimentTables& tables, const char* problem, const char* rule,
                const char* solver) {
  const CsvTable rows =
      tables.at("").Where("problem", problem).Where("rule", rule).Where("solver", solver);
  Spread spread;
  for (std::size_t row = 0; row < rows.num_rows(); ++row) {
    const double count = rows.Number(row, "iterations");
    if (std::isnan(count)) continue;
    spread.least = spread.runs == 0 ? count : std::min(spread.least, count);
    ++spread.runs;
    spread.most = std::max(spread.most, count);
    const std::string& status = rows.Text(row, "status");
    spread.missed += status == "gradient_small" || status == "step_small" ? 0 : 1;
  }
  return spread;
}

std::string Text(const char* solver, const Spread& spread) {
  return std::string(solver) + " " + NumberText(spread.least) + " to " + NumberText(spread.most);
}

Judgement JudgeUnits(const ExperimentTables& tables) {
  Judgement judgement;
  const Spread lspia = SpreadOf(tables, "rhino", kPaperRule, "lspia");
  const Spread coarse = SpreadOf(tables, "rhino", kPaperRule, "lbfgs");
  const Spread fine = SpreadOf(tables, "rhino", kStrictRule, "lbfgs");
  const Spread race = SpreadOf(tables, "rhino", kRaceRule, "lbfgs");
  // One unit cannot show a dependence on it.
  if (std::min({lspia.runs, coarse.runs, fine.runs}) < 2) return judgement;
  judgement.because =
      "rhinoceros in units from 1e-3 to 1e6: " + Text("lspia", lspia) + " iterations, " +
      Text("lbfgs to 1e-6", coarse) + ", " + Text("to 1e-10", fine) + " (" +
      std::to_string(fine.missed) + " of " + std::to_string(fine.runs) +
      " end at the rounding floor above it); by the race's relative rule " + Text("lbfgs", race);
  // A tenth, and the 1 that rounding can make.
  const auto is_steady = [](const Spread& spread) {
    return spread.missed == 0 && spread.most - spread.least <= 1.0 + 0.1 * spread.least;
  };
  const int steady =
      (is_steady(lspia) ? 1 : 0) + (is_steady(coarse) ? 1 : 0) + (is_steady(fine) ? 1 : 0);
  judgement.verdict = steady == 3  ? ClaimVerdict::kHolds
                      : steady > 0 ? ClaimVerdict::kInPart
                                   : ClaimVerdict::kDoesNotHold;
  return judgement;
}

std::vector<PlotPanel> AgainstUnit(const ExperimentTables& tables) {
  std::vector<PlotPanel> panels;
  for (const char* problem : {"rhino", "dolphin"}) {
    PlotPanel panel;
    panel.title = problem;
    panel.x_label = "factor of the data";
    panel.y_label = "iterations";
    panel.log_x = panel.log_y = true;
    const CsvTable on = tables.at("").Where("problem", problem);
    int color = 0;
    PlotSeries at_floor = {"ended at the rounding floor", {}, {}, PlotSeries::Style::kCircles, 6};
    for (const auto& [solver, rule] : {std::pair("lspia", kPaperRule),
                                       {"lspia", kRaceRule},
                                       {"lbfgs", kPaperRule},
                                       {"lbfgs", kStrictRule},
                                       {"lbfgs", kRaceRule}}) {
      const CsvTable rows = on.Where("solver", solver).Where("rule", rule);
      panel.series.push_back({std::string(solver) + ": " + rule, rows.Numbers("factor"),
                              rows.Numbers("iterations"), PlotSeries::Style::kLinePoints, color++});
      const CsvTable floor = rows.Where("status", "rounding_floor");
      for (std::size_t row = 0; row < floor.num_rows(); ++row) {
        at_floor.x.push_back(floor.Number(row, "factor"));
        at_floor.y.push_back(floor.Number(row, "iterations"));
      }
    }
    panel.series.push_back(std::move(at_floor));
    panels.push_back(std::move(panel));
  }
  return panels;
}

}  // namespace

Experiment AcceleratedGimUnits() {
  Experiment experiment;
  experiment.name = "units";
  experiment.title = "Absolute stop rules and the unit of the data";
  experiment.text =
      "The rhinoceros and the dolphin as they are (about 120 and 500 units wide), and in units in "
      "which they are 1e-3, 10, 1e3 and 1e6 times as large. |g| has the unit of the data: in a "
      "unit "
      "1000 times finer |g| < 1e-6 asks for 1000 times less, and from some size on for less than "
      "rounding leaves. Runs that the rule cannot end anymore stop at the rounding floor and say "
      "so.";
  experiment.run = &RunUnits;
  experiment.shown = [](const ExperimentTables& tables) {
    CsvTable shown(
        {"problem", "factor", "rule", "solver", "status", "iterations", "x cholesky", "|g|"});
    const CsvTable& all = tables.at("");
    for (std::size_t row = 0; row < all.num_rows(); ++row) {
      if (all.Text(row, "solver") == "cg") continue;
      shown.AddRow({all.Text(row, "problem"), all.Text(row, "factor"), all.Text(row, "rule"),
                    all.Text(row, "solver"), all.Text(row, "status"), all.Text(row, "iterations"),
                    all.Text(row, "times_cholesky"), all.Text(row, "gradient_norm")});
    }
    return shown;
  };
  experiment.claims = {{"step < 1e-6, |g| < 1e-6 and |g| < 1e-10 say when to stop",
                        "stop rules of all its experiments",
                        "holds where by each of the three rules the counts on the rhinoceros in "
                        "all units are within "
                        "a tenth and every run ends by the rule, in part where this is so by one",
                        &JudgeUnits}};
  experiment.figures = {{"units_counts",
                         "Iterations against the factor by which the data are enlarged.", 2,
                         &AgainstUnit}};
  return experiment;
}

}  // namespace batten
