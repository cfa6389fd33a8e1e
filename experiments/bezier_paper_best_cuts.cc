#include <algorithm>
#include <array>
#include <cmath>

#include "cost_functions/options.h"
#include "experiments/bezier_paper.h"
#include "experiments/bezier_paper_curves.h"
#include "experiments/experiment_runs.h"
#include "experiments/run.h"
#include "solvers/cut_search.h"
#include "splines/bezier_subdivision.h"

namespace batten {
namespace {

constexpr int kRounds = 6;
constexpr int kBins = 20;
constexpr int kNumCutCurves = 50;
constexpr int kCutDegrees[] = {12, 20};
constexpr int kPapersRounds = 3;
using Histogram = std::array<std::array<int, kBins>, kRounds>;

void CountBestCuts(const BezierCurve& curve, CutMeasure measure, Histogram* histogram) {
  SubdivisionOptions options;
  options.mode = SubdivisionMode::kUniform;
  options.max_depth = kRounds;
  options.relative_tolerance = 0.0;
  Subdivision unused;
  Subdivide(
      curve,
      [&](CutTrial* trial) {
        CutValue value(measure, trial->degree(), trial->dimension(), trial->points());
        const double u = ExactMinimum(&value).u;
        const int bin = std::clamp(static_cast<int>(u * kBins), 0, kBins - 1);
        ++(*histogram)[static_cast<std::size_t>(trial->depth())][static_cast<std::size_t>(bin)];
        return u;
      },
      options, &unused, nullptr);
}

bool RunBestCuts(const ExperimentRun& run, ExperimentTables* tables, std::string* /*error*/) {
  CsvTable& table = (*tables)[""] = CsvTable({"measure", "family", "round", "u", "cuts"});
  double done = 0.0;
  const double cells = 2.0 * static_cast<double>(CurveFamilies().size());
  for (const CutMeasure measure : {CutMeasure::kFlatness, CutMeasure::kHullArea}) {
    for (const std::string& family : CurveFamilies()) {
      if (run.progress) run.progress(done++ / cells, family);
      Histogram histogram{};
      for (const int degree : kCutDegrees) {
        for (int k = 0; k < kNumCutCurves; ++k) {
          if (InterruptRequested()) return true;
          // Kinks of the hull take a hundred times as long to search.
          if (measure == CutMeasure::kHullArea && k >= kNumCutCurves / 10) break;
          CountBestCuts(FamilyCurve(family, degree, k), measure, &histogram);
        }
      }
      for (int round = 0; round < kRounds; ++round) {
        for (int bin = 0; bin < kBins; ++bin) {
          table.AddRow({ToString(measure), family, std::to_string(round),
                        NumberText((bin + 0.5) / kBins), std::to_string(histogram[round][bin])});
        }
      }
    }
  }
  return true;
}

/// Share of the cuts of `rows` with low < u < high.
double ShareBetween(const CsvTable& rows, double low, double high, int first_round) {
  double inside = 0.0, all = 0.0;
  for (std::size_t k = 0; k < rows.num_rows(); ++k) {
    if (rows.Number(k, "round") < first_round) continue;
    const double u = rows.Number(k, "u"), cuts = rows.Number(k, "cuts");
    all += cuts;
    if (u > low && u < high) inside += cuts;
  }
  return all > 0.0 ? inside / all : NAN;
}

Judgement JudgeShares(const ExperimentTables& tables, double low, double high, int first_round,
                      double wanted) {
  Judgement judgement;
  int holding = 0, all = 0;
  for (const std::string& measure : tables.at("").Distinct("measure")) {
    for (const std::string& family : tables.at("").Distinct("family")) {
      const CsvTable rows = tables.at("").Where("measure", measure).Where("family", family);
      const double share = ShareBetween(rows, low, high, first_round);
      if (std::isnan(share)) return Judgement();
      ++all;
      holding += share >= wanted ? 1 : 0;
      judgement.because += (judgement.because.empty() ? "" : "; ") + measure + ", " + family +
                           ": " + Rounded(100.0 * share, 0) + " %";
    }
  }
  judgement.verdict = all == 0         ? ClaimVerdict::kUndecided
                      : holding == all ? ClaimVerdict::kHolds
                      : holding > 0    ? ClaimVerdict::kInPart
                                       : ClaimVerdict::kDoesNotHold;
  return judgement;
}

Judgement JudgeInside(const ExperimentTables& tables) {
  constexpr double kLow = 0.2, kHigh = 0.8, kNearlyAll = 0.95;
  return JudgeShares(tables, kLow, kHigh, 0, kNearlyAll);
}

Judgement JudgeNearHalf(const ExperimentTables& tables) {
  constexpr double kLow = 0.4, kHigh = 0.6, kMost = 0.9;
  return JudgeShares(tables, kLow, kHigh, kPapersRounds, kMost);
}

CsvTable ShownShares(const ExperimentTables& tables) {
  CsvTable shown({"measure", "family", "round", "cuts", "in 0.2 to 0.8, %", "in 0.4 to 0.6, %"});
  constexpr double kLow = 0.2, kHigh = 0.8, kNearLow = 0.4, kNearHigh = 0.6;
  for (const std::string& measure : tables.at("").Distinct("measure")) {
    for (const std::string& family : tables.at("").Distinct("family")) {
      const CsvTable rows = tables.at("").Where("measure", measure).Where("family", family);
      for (const std::string& round : rows.Distinct("round")) {
        const CsvTable of_round = rows.Where("round", round);
        double cuts = 0.0;
        for (const double count : of_round.Numbers("cuts")) cuts += count;
        shown.AddRow({measure, family, round, NumberText(cuts),
                      Rounded(100.0 * ShareBetween(of_round, kLow, kHigh, 0), 1),
                      Rounded(100.0 * ShareBetween(of_round, kNearLow, kNearHigh, 0), 1)});
      }
    }
  }
  return shown;
}

std::vector<PlotPanel> HistogramPanels(const ExperimentTables& tables, CutMeasure measure) {
  std::vector<PlotPanel> panels;
  for (const std::string& family : tables.at("").Distinct("family")) {
    PlotPanel panel;
    panel.title = family + ", " + ToString(measure) + " by round";
    panel.x_label = "place of the best cut";
    panel.y_label = "share of the round's cuts";
    const CsvTable rows = tables.at("").Where("measure", ToString(measure)).Where("family", family);
    int color = 0;
    for (const std::string& round : rows.Distinct("round")) {
      const CsvTable of_round = rows.Where("round", round);
      std::vector<double> shares = of_round.Numbers("cuts");
      double all = 0.0;
      for (const double count : shares) all += count;
      for (double& share : shares) share /= all;
      panel.series.push_back({"round " + round, of_round.Numbers("u"), shares,
                              PlotSeries::Style::kLinePoints, color++});
    }
    panels.push_back(std::move(panel));
  }
  return panels;
}

}  // namespace

Experiment BezierPaperBestCuts() {
  Experiment experiment;
  experiment.name = "best_cuts";
  experiment.title = "Where the best cuts are, round by round";
  experiment.text =
      "50 curves each of degrees 12 and 20 in each family (five where hulls are measured), cut in "
      "six uniform rounds at the exact minimum; counted in twenty bins of [0, 1].";
  experiment.run = &RunBestCuts;
  experiment.shown = &ShownShares;
  experiment.claims = {
      {"nearly all best cuts are in [0.2, 0.8]", "section on the grid",
       "holds where at least 95 % are, for each measure and family; in part where for some",
       &JudgeInside},
      {"after N = 3 rounds the best cut is near 0.5", "section on N",
       "holds where from the fourth round on at least 90 % are in [0.4, 0.6], for each measure and "
       "family; in part where for some",
       &JudgeNearHalf}};
  const auto panels_of = [](CutMeasure measure) {
    return [measure](const ExperimentTables& tables) { return HistogramPanels(tables, measure); };
  };
  experiment.figures = {{"best_cuts_flatness", "Places of the flattest cuts, by round.", 3,
                         panels_of(CutMeasure::kFlatness)},
                        {"best_cuts_hull", "Places of the cuts with the smallest hulls, by round.",
                         3, panels_of(CutMeasure::kHullArea)}};
  return experiment;
}

}  // namespace batten
