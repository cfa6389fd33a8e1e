#include <glog/logging.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "cost_functions/options.h"
#include "experiments/bezier_paper.h"
#include "experiments/bezier_paper_curves.h"
#include "experiments/experiment_runs.h"
#include "experiments/ratio_statistics.h"
#include "experiments/run.h"
#include "problems/cut_problem.h"
#include "solvers/cut_search.h"

namespace batten {
namespace {

constexpr int kDegrees[] = {4, 8, 12, 20};
constexpr int kCurves = 10;
constexpr const char* kSolvers[] = {"lbfgs", "ceres_lbfgs", "ceres_lm"};

/// Where a method ended, and what it took.
struct Found {
  double u = 0.0;
  double evaluations = 0.0;
  double seconds = 0.0;
};

template <typename Search>
Found BySearch(CutMeasure measure, const BezierCurve& curve, const Search& search) {
  CutValue value(measure, curve.degree(), curve.dimension(), curve.control_points().data());
  const auto begin = std::chrono::steady_clock::now();
  const double u = search(&value).u;
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  return {u, static_cast<double>(value.num_evaluations()), taken.count()};
}

/// Nothing where the solver does not apply.
std::optional<Found> BySolver(const std::string& solver, CutMeasure measure,
                              const BezierCurve& curve) {
  std::string error;
  constexpr double kStart = 0.5;
  const std::unique_ptr<Problem> problem = MakeCutProblem(measure, curve, kStart, &error);
  CHECK(problem != nullptr) << error;
  NameSpec spec;
  CHECK(ParseNameSpec(solver, &spec, &error)) << error;
  RunSpec run_spec = RaceSpec(1e-10);
  run_spec.keep_trace = false;
  constexpr int kMostIterations = 200;
  run_spec.max_iterations = kMostIterations;
  RunResult run;
  CHECK(Run(*problem, spec, run_spec, &run, &error)) << error;
  if (!run.skipped.empty()) return std::nullopt;
  return Found{run.x[0], static_cast<double>(run.counts.distinct_points), run.seconds};
}

/// Which of the local minima, counted from the least, `u` is at: "global", "other", "none".
std::string KindOf(double u, const std::vector<CutPlace>& minima) {
  // Solvers stop where the slope is small: with a flat minimum that is not yet its place.
  constexpr double kSamePlace = 1e-3;
  const CutPlace* nearest = &minima.front();
  const CutPlace* least = &minima.front();
  for (const CutPlace& place : minima) {
    if (std::abs(place.u - u) < std::abs(nearest->u - u)) nearest = &place;
    if (place.value < least->value) least = &place;
  }
  if (!(std::abs(nearest->u - u) <= kSamePlace)) return "none";
  return nearest == least ? "global" : "other";
}

void AddCurve(CutMeasure measure, const std::string& family, int degree, int number,
              CsvTable* table) {
  const BezierCurve curve = FamilyCurve(family, degree, number);
  CutValue value(measure, degree, curve.dimension(), curve.control_points().data());
  const std::vector<CutPlace> minima = AllMinima(&value);
  const double least = ExactMinimum(&value).value;
  const auto add = [&](const std::string& method, const Found& found) {
    table->AddRow({ToString(measure), family, std::to_string(degree), std::to_string(number),
                   std::to_string(minima.size()), method, NumberText(found.u),
                   KindOf(found.u, minima), NumberText(value(found.u) / least),
                   NumberText(found.evaluations), NumberText(found.seconds)});
  };
  add("exact", BySearch(measure, curve, &ExactMinimum));
  add("grid", BySearch(measure, curve, &GridMinimum));
  for (const char* solver : kSolvers) {
    if (const std::optional<Found> found = BySolver(solver, measure, curve)) add(solver, *found);
  }
}

bool RunMinima(const ExperimentRun& run, ExperimentTables* tables, std::string* /*error*/) {
  CsvTable& table = (*tables)[""] =
      CsvTable({"measure", "family", "degree", "curve", "minima", "method", "u", "found",
                "value_over_least", "evaluations", "seconds"});
  double done = 0.0;
  const double cells = 2.0 * std::size(kDegrees) * static_cast<double>(CurveFamilies().size());
  for (const CutMeasure measure : {CutMeasure::kFlatness, CutMeasure::kHullArea}) {
    for (const std::string& family : CurveFamilies()) {
      for (const int degree : kDegrees) {
        if (InterruptRequested()) return true;
        if (run.progress) run.progress(done++ / cells, family + " " + ToString(measure));
        for (int k = 0; k < kCurves; ++k) AddCurve(measure, family, degree, k, &table);
      }
    }
  }
  return true;
}

CsvTable ShownMinima(const ExperimentTables& tables) {
  CsvTable shown({"measure", "method", "curves", "least minimum", "another minimum", "no minimum",
                  "median evaluations", "median us", "median value / least"});
  constexpr double kMicroseconds = 1e6;
  for (const std::string& measure : tables.at("").Distinct("measure")) {
    for (const std::string& method : tables.at("").Distinct("method")) {
      const CsvTable rows = tables.at("").Where("measure", measure).Where("method", method);
      if (rows.num_rows() == 0) continue;
      const auto count = [&rows](const char* kind) {
        return std::to_string(rows.Where("found", kind).num_rows());
      };
      shown.AddRow({measure, method, std::to_string(rows.num_rows()), count("global"),
                    count("other"), count("none"),
                    NumberText(MedianOf(rows.Numbers("evaluations")).median),
                    Rounded(kMicroseconds * MedianOf(rows.Numbers("seconds")).median, 1),
                    Rounded(MedianOf(rows.Numbers("value_over_least")).median, 4)});
    }
  }
  return shown;
}

Judgement JudgeGrid(const ExperimentTables& tables) {
  constexpr double kNear = 1.1, kNearlyAll = 0.95;
  Judgement judgement;
  int holding = 0, measures = 0;
  for (const std::string& measure : tables.at("").Distinct("measure")) {
    const CsvTable rows = tables.at("").Where("measure", measure).Where("method", "grid");
    if (rows.num_rows() == 0) return Judgement();
    double near = 0.0;
    for (const double ratio : rows.Numbers("value_over_least")) near += ratio <= kNear ? 1.0 : 0.0;
    const double share = near / static_cast<double>(rows.num_rows());
    ++measures;
    holding += share >= kNearlyAll ? 1 : 0;
    judgement.because += (judgement.because.empty() ? "" : "; ") + measure +
                         ": within 10 % of the "
                         "least value on " +
                         Rounded(100.0 * share, 0) + " % of the curves";
  }
  judgement.verdict = measures == 0         ? ClaimVerdict::kUndecided
                      : holding == measures ? ClaimVerdict::kHolds
                      : holding > 0         ? ClaimVerdict::kInPart
                                            : ClaimVerdict::kDoesNotHold;
  return judgement;
}

}  // namespace

Experiment BezierPaperMinima() {
  Experiment experiment;
  experiment.name = "minima";
  experiment.title = "Which minimum each method finds";
  experiment.text =
      "The cut as a problem of one variable, from u = 1/2: ten curves each of degrees 4, 8, 12 and "
      "20 in each family. `exact` brackets all stationary points in Bernstein form on panels; "
      "`grid` "
      "takes the best of 13 values; `lbfgs`, `ceres_lbfgs` and `ceres_lm` descend to |g| <= 1e-10 "
      "|g(start)|. \"No minimum\" is a place more than 1e-3 from all minima. Hull areas have "
      "kinks, at "
      "which methods for smooth functions stop.";
  experiment.run = &RunMinima;
  experiment.shown = &ShownMinima;
  experiment.claims = {{"13 values are enough to find the best cut", "section on the grid",
                        "holds where on at least 95 % of the curves the best of the grid is within "
                        "10 % of the least "
                        "value, for both measures; in part where for one",
                        &JudgeGrid}};
  return experiment;
}

}  // namespace batten
