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
#include "splines/brent_minimum.h"

namespace batten {
namespace {

constexpr int kMinimaDegrees[] = {4, 8, 12, 20};
constexpr int kNumMinimaCurves = 10;
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

/// A local minimum, and the valley around it: from the highest place on its left to that on its
/// right.
struct Valley {
  CutPlace minimum;
  double begin = 0.0;
  double end = 1.0;
};

/// The valleys on [1/64, 63/64] by looking everywhere: 4,001 values, and Brent's method around
/// those that both neighbours top. It shares nothing with the search by Bernstein forms.
std::vector<Valley> ValleysOf(CutValue* value) {
  constexpr int kSteps = 4000;
  constexpr double kFirst = 1.0 / 64.0, kLast = 63.0 / 64.0;
  const auto place = [](int k) { return kFirst + (kLast - kFirst) * k / kSteps; };
  std::vector<double> values;
  for (int k = 0; k <= kSteps; ++k) values.push_back((*value)(place(k)));
  std::vector<Valley> valleys;
  int highest = 0;  // since the last minimum
  for (int k = 0; k <= kSteps; ++k) {
    if (values[k] > values[highest]) highest = k;
    const bool falls = k == 0 || values[k] < values[k - 1];
    const bool rises = k == kSteps || values[k] <= values[k + 1];
    if (!falls || !rises) continue;
    Valley valley;
    valley.minimum = {place(k), values[k]};
    if (k > 0 && k < kSteps) {
      constexpr double kTolerance = 1e-9;
      constexpr int kMostCalls = 100;
      const auto [u, least] =
          BrentMinimum([value](double t) { return (*value)(t); }, place(k - 1), place(k), values[k],
                       place(k + 1), kTolerance, kMostCalls);
      valley.minimum = {u, least};
    }
    if (!valleys.empty()) valleys.back().end = valley.begin = place(highest);
    valleys.push_back(valley);
    highest = k;
  }
  return valleys;
}

/// What a method may be off and still have found a minimum: solvers stop where the slope is small,
/// which with a flat minimum is not yet its place; the grid has no places in between.
double ReachOf(const std::string& method) {
  constexpr double kGridSpacing = 0.05, kSamePlace = 1e-3;
  return method == "grid" ? kGridSpacing : kSamePlace;
}

/// "least": at a minimum that is as low as the least, to 1e-6; "other": at one that is not; "none":
/// farther than `reach` from the minimum of its valley, or outside of [1/64, 63/64].
std::string KindOf(double u, const std::vector<Valley>& valleys, double reach) {
  constexpr double kSameValue = 1.0 + 1e-6;
  double least = valleys.front().minimum.value;
  for (const Valley& valley : valleys) least = std::min(least, valley.minimum.value);
  for (const Valley& valley : valleys) {
    if (u < valley.begin || u > valley.end) continue;
    if (!(std::abs(valley.minimum.u - u) <= reach)) continue;
    return valley.minimum.value <= kSameValue * least ? "least" : "other";
  }
  return "none";
}

void AddCurve(CutMeasure measure, const std::string& family, int degree, int number,
              CsvTable* table) {
  const BezierCurve curve = FamilyCurve(family, degree, number);
  CutValue value(measure, degree, curve.dimension(), curve.control_points().data());
  const std::vector<Valley> valleys = ValleysOf(&value);
  double least = valleys.front().minimum.value;
  for (const Valley& valley : valleys) least = std::min(least, valley.minimum.value);
  const auto add = [&](const std::string& method, const Found& found) {
    table->AddRow({ToString(measure), family, std::to_string(degree), std::to_string(number),
                   std::to_string(valleys.size()), method, NumberText(found.u),
                   KindOf(found.u, valleys, ReachOf(method)), NumberText(value(found.u) / least),
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
  const double cells =
      2.0 * std::size(kMinimaDegrees) * static_cast<double>(CurveFamilies().size());
  for (const CutMeasure measure : {CutMeasure::kFlatness, CutMeasure::kHullArea}) {
    for (const std::string& family : CurveFamilies()) {
      for (const int degree : kMinimaDegrees) {
        if (InterruptRequested()) return true;
        if (run.progress) run.progress(done++ / cells, family + " " + ToString(measure));
        for (int k = 0; k < kNumMinimaCurves; ++k) AddCurve(measure, family, degree, k, &table);
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
      shown.AddRow({measure, method, std::to_string(rows.num_rows()), count("least"),
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

/// Rows of `method`, and how many of them are of each kind.
struct FoundCounts {
  std::size_t all = 0;
  std::size_t least = 0;
  std::size_t none = 0;
};
FoundCounts CountsOf(const CsvTable& rows) {
  return {rows.num_rows(), rows.Where("found", "least").num_rows(),
          rows.Where("found", "none").num_rows()};
}

Judgement JudgeExact(const ExperimentTables& tables) {
  Judgement judgement;
  bool all_least = true, all_low = true;
  for (const std::string& measure : tables.at("").Distinct("measure")) {
    const CsvTable rows = tables.at("").Where("measure", measure).Where("method", "exact");
    const FoundCounts kinds = CountsOf(rows);
    if (kinds.all == 0) return Judgement();
    constexpr double kSameValue = 1.0 + 1e-6;
    double worst = 0.0;
    for (const double ratio : rows.Numbers("value_over_least")) worst = std::max(worst, ratio);
    all_least &= kinds.least == kinds.all;
    all_low &= worst <= kSameValue;
    judgement.because += (judgement.because.empty() ? "" : "; ") + measure + ": the least on " +
                         std::to_string(kinds.least) + " of " + std::to_string(kinds.all) +
                         " curves, and at most " + Rounded(worst, 6) + " of its value";
  }
  if (judgement.because.empty()) return judgement;
  judgement.verdict = all_least && all_low   ? ClaimVerdict::kHolds
                      : all_least || all_low ? ClaimVerdict::kInPart
                                             : ClaimVerdict::kDoesNotHold;
  return judgement;
}

Judgement JudgeDescent(const ExperimentTables& tables) {
  Judgement judgement;
  bool at_minima = true, at_least = true;
  for (const std::string& measure : tables.at("").Distinct("measure")) {
    for (const char* solver : kSolvers) {
      const FoundCounts kinds =
          CountsOf(tables.at("").Where("measure", measure).Where("method", solver));
      if (kinds.all == 0) continue;
      at_minima &= kinds.none == 0;
      at_least &= kinds.least == kinds.all;
      judgement.because += (judgement.because.empty() ? "" : "; ") + measure + ", " + solver +
                           ": the least on " + std::to_string(kinds.least) + " of " +
                           std::to_string(kinds.all) + ", another on " +
                           std::to_string(kinds.all - kinds.least - kinds.none) + ", none on " +
                           std::to_string(kinds.none);
    }
  }
  if (judgement.because.empty()) return judgement;
  judgement.verdict = !at_minima ? ClaimVerdict::kDoesNotHold
                      : at_least ? ClaimVerdict::kHolds
                                 : ClaimVerdict::kInPart;
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
      "|g(start)|. All are judged by one list of minima, from 4,001 values on [1/64, 63/64] and "
      "Brent's method around the low ones. A method has found the minimum in whose valley it ended "
      "if it is within 1e-3 of its place, the grid within its spacing of 0.05; otherwise it has "
      "found none. Hull areas have kinks, at which methods for smooth functions stop.";
  experiment.run = &RunMinima;
  experiment.shown = &ShownMinima;
  experiment.claims = {
      {"13 values are enough to find the best cut", "section on the grid",
       "holds where on at least 95 % of the curves the best of the grid is within "
       "10 % of the least "
       "value, for both measures; in part where for one",
       &JudgeGrid},
      {"the bracketing search finds the least minimum", "docs/cut_rules/flatness.md",
       "holds where it does on every curve by the list of 4,001 values, to 1e-6 of "
       "the least value; in part where only place or value is right everywhere",
       &JudgeExact},
      {"descent from 1/2 ends in the least minimum", "ours",
       "holds where every solver does on every curve; in part where some end in "
       "another minimum; does not where some end in none",
       &JudgeDescent}};
  return experiment;
}

}  // namespace batten
