#include <algorithm>
#include <cmath>

#include "experiments/accelerated_gim.h"
#include "experiments/experiment_runs.h"

namespace batten {
namespace {

/// Table 1 of the paper.
struct PublishedRow {
  const char* problem;
  double gim_iterations, gim_ms, lbfgs_iterations, lbfgs_ms;
};
constexpr PublishedRow kTable1[] = {{"rhino", 276, 19834, 23, 2163},
                                    {"squirrel", 314, 30312, 20, 2390},
                                    {"dolphin", 105, 3281, 20, 906},
                                    {"cat", 297, 22750, 24, 2250}};
// The iterations whose curves are drawn, beside the last one.
constexpr int kFirst = 0;
constexpr int kSecond = 3;
constexpr int kCurveSamples = 400;

void AddCurve(const Problem& problem, const std::string& solver, const std::string& iteration,
              const Eigen::VectorXd& x, CsvTable* curves) {
  const BsplineCurve curve = problem.curve_fit()->Curve(x);
  const BsplineBasis& basis = problem.curve_fit()->basis();
  for (int k = 0; k <= kCurveSamples; ++k) {
    Eigen::VectorXd t(1);
    t[0] = basis.domain_begin() + basis.domain_length() * k / kCurveSamples;
    const Points point = curve.Sample(t);
    curves->AddRow(
        {problem.name(), solver, iteration, NumberText(point(0, 0)), NumberText(point(0, 1))});
  }
}

void AddCurves(const Problem& problem, const std::string& solver, const RunResult& run,
               CsvTable* curves) {
  for (const int iteration : {kFirst, kSecond}) {
    if (iteration >= static_cast<int>(run.iterates.size())) continue;
    AddCurve(problem, solver, std::to_string(iteration),
             run.iterates[static_cast<std::size_t>(iteration)].x, curves);
  }
  AddCurve(problem, solver, "last", run.x, curves);
}

void AddDataPoints(const Problem& problem, CsvTable* curves) {
  const Points& points = problem.curve_fit()->data().points;
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    curves->AddRow(
        {problem.name(), "data", "", NumberText(points(i, 0)), NumberText(points(i, 1))});
  }
}

bool RunOutlines(const ExperimentRun& run, ExperimentTables* tables, std::string* error) {
  CsvTable& runs = (*tables)[""] = CsvTable(RunColumnsBehind({"rule"}));
  CsvTable& traces = (*tables)["traces"] = CsvTable(TraceColumns());
  CsvTable& curves = (*tables)["curves"] = CsvTable({"problem", "solver", "iteration", "x", "y"});
  double done = 0.0;
  for (const PublishedRow& published : kTable1) {
    if (run.progress) run.progress(done / std::size(kTable1), published.problem);
    done += 1.0;
    std::shared_ptr<const Problem> problem = CatalogueProblem(published.problem, error);
    if (problem == nullptr) return false;
    ProblemRuns on(published.problem, problem, run.repetitions, run.recorder);
    AddDataPoints(*problem, &curves);
    for (const StopRule& rule : PaperRules()) {
      for (const char* solver : {"lspia", "lspia/step=max_column", "lspia/step=optimal", "lbfgs",
                                 "lbfgs/wolfe=strong", "cg", "banded_cholesky"}) {
        if (InterruptRequested()) return true;
        const std::string name(solver);
        if (!RuleConcerns(rule, name)) continue;
        const bool is_native = rule.name == std::string(kPaperRule);
        const bool drawn = name == kLspia || name == kLbfgs;
        const bool traced = drawn && rule.name != std::string(kStrictRule);
        RunSpec keeping = rule.spec;
        keeping.keep_iterates = drawn;
        CsvTable rows(RunColumns());
        const RunResult result = on.Run(name, keeping, &rows, traced ? &traces : nullptr);
        AddRowsBehind({rule.name}, rows, &runs);
        if (drawn && is_native) AddCurves(*problem, name, result, &curves);
      }
    }
  }
  return true;
}

/// One number of the native run of `solver` on `problem`; NaN if there is none.
double Native(const ExperimentTables& tables, const std::string& problem, const std::string& solver,
              const std::string& column) {
  const CsvTable rows =
      tables.at("").Where("rule", kPaperRule).Where("problem", problem).Where("solver", solver);
  return rows.num_rows() == 1 ? rows.Number(0, column) : std::nan("");
}

/// How many of the four measured ratios lspia / lbfgs of `column` are at least half the published
/// one, and at least 1.
Judgement JudgeRatios(const ExperimentTables& tables, const std::string& column,
                      double (*published)(const PublishedRow&)) {
  Judgement judgement;
  int agree = 0;
  int fewer = 0;
  for (const PublishedRow& row : kTable1) {
    const double slow = Native(tables, row.problem, kLspia, column);
    const double ratio = slow / Native(tables, row.problem, kLbfgs, column);
    if (std::isnan(ratio)) return judgement;
    agree += ratio >= 0.5 * published(row) ? 1 : 0;
    fewer += ratio > 1.0 ? 1 : 0;
    judgement.because += (judgement.because.empty() ? "ratios " : "; ") + std::string(row.problem) +
                         " " + Rounded(ratio, 1) + " (paper " + Rounded(published(row), 1) + ")";
  }
  const int all = static_cast<int>(std::size(kTable1));
  judgement.verdict = agree == all ? ClaimVerdict::kHolds
                      : fewer > 0  ? ClaimVerdict::kInPart
                                   : ClaimVerdict::kDoesNotHold;
  return judgement;
}

std::vector<PlotPanel> Curves(const ExperimentTables& tables) {
  std::vector<PlotPanel> panels;
  const CsvTable& curves = tables.at("curves");
  for (const std::string& problem : curves.Distinct("problem")) {
    const CsvTable on = curves.Where("problem", problem);
    for (const char* solver : {kLspia, kLbfgs}) {
      PlotPanel panel;
      panel.title = problem + ", " + solver;
      panel.equal_scale = true;
      const CsvTable data = on.Where("solver", "data");
      panel.series.push_back(
          {"data", data.Numbers("x"), data.Numbers("y"), PlotSeries::Style::kPoints, 0});
      const CsvTable drawn = on.Where("solver", solver);
      const auto draw = [&](const std::string& iteration, const std::string& label,
                            PlotSeries::Style style, int color) {
        const CsvTable curve = drawn.Where("iteration", iteration);
        panel.series.push_back({label, curve.Numbers("x"), curve.Numbers("y"), style, color});
      };
      // Dashed on top: the third iteration is near the last.
      const std::string first = std::to_string(kFirst), second = std::to_string(kSecond);
      draw(first, "iteration " + first, PlotSeries::Style::kLine, 5);
      draw("last", "last iteration", PlotSeries::Style::kLine, 1);
      draw(second, "iteration " + second, PlotSeries::Style::kDashed, 6);
      panels.push_back(std::move(panel));
    }
  }
  return panels;
}

std::vector<PlotPanel> Convergence(const ExperimentTables& tables) {
  std::vector<PlotPanel> panels;
  const CsvTable race = tables.at("traces").Where("mode", "race");
  for (const std::string& problem : race.Distinct("problem")) {
    const CsvTable on = race.Where("problem", problem);
    for (const char* column : {"gap", "gradient_norm"}) {
      PlotPanel panel;
      panel.title = problem;
      panel.x_label = "iteration";
      panel.y_label = std::string(column) == "gap" ? "gap of E" : "|g|";
      panel.log_y = true;
      int color = 0;
      for (const char* solver : {kLspia, kLbfgs}) {
        const CsvTable rows = on.Where("solver", solver);
        panel.series.push_back({solver, rows.Numbers("iteration"), rows.Numbers(column),
                                PlotSeries::Style::kLine, color++});
      }
      panels.push_back(std::move(panel));
    }
  }
  return panels;
}

}  // namespace

Experiment AcceleratedGimOutlines() {
  Experiment experiment;
  experiment.name = "table_1";
  experiment.title = "Figures 2 to 5 and Table 1: four outlines";
  experiment.text =
      "Rhinoceros (100 points, 80 control points), squirrel (120, 80), dolphin (80, 40), cat (110, "
      "83), closed uniform cubics. The paper's GIM for more points than control points is LSPIA; "
      "which of its steps it takes is not said: `lspia` (1 / column sum), `max_column` and "
      "`optimal` stand beside each other. Times are of this machine, without reading and drawing; "
      "the paper's are those of an interactive program.";
  experiment.run = &RunOutlines;
  experiment.shown = [](const ExperimentTables& tables) {
    return tables.at("").Select({"problem", "rule", "solver", "status", "iterations", "seconds",
                                 "times_cholesky", "energy", "gradient_norm", "gap"});
  };
  experiment.claims = {
      {"276, 314, 105, 297 iterations against 23, 20, 20, 24", "Table 1",
       "ratio of the native iterations of lspia and lbfgs: holds where all four are at least half "
       "the published ratio, in part where L-BFGS needs fewer on some",
       [](const ExperimentTables& tables) {
         return JudgeRatios(tables, "iterations", [](const PublishedRow& row) {
           return row.gim_iterations / row.lbfgs_iterations;
         });
       }},
      {"times 9.2, 12.7, 3.6, 10.1 apart", "Table 1",
       "ratio of the native times of lspia and lbfgs: holds where all four are at least half the "
       "published ratio, in part where L-BFGS is faster on some",
       [](const ExperimentTables& tables) {
         return JudgeRatios(tables, "seconds",
                            [](const PublishedRow& row) { return row.gim_ms / row.lbfgs_ms; });
       }}};
  experiment.figures = {
      {"table_1_curves",
       "Start, iteration 3 (dashed) and end of LSPIA (left) and L-BFGS (right), native stop rules.",
       2, &Curves},
      {"table_1_convergence", "Gap of E and |g| against iteration, race.", 2, &Convergence}};
  return experiment;
}

}  // namespace batten
