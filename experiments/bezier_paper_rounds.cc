#include <algorithm>
#include <cmath>

#include "cost_functions/options.h"
#include "experiments/bezier_paper.h"
#include "experiments/bezier_paper_curves.h"
#include "experiments/bezier_paper_runs.h"
#include "experiments/experiment_runs.h"
#include "experiments/ratio_statistics.h"
#include "experiments/run.h"

namespace batten {
namespace {

constexpr int kMostRounds = 8;
constexpr int kNumRoundCurves = 40;
constexpr int kRoundDegrees[] = {12, 16, 20, 25};
constexpr const char* kRules[] = {"flatness", "hull"};

bool RunRounds(const ExperimentRun& run, ExperimentTables* tables, std::string* /*error*/) {
  CsvTable& table = (*tables)[""] = CsvTable({"family", "rule", "N", "seconds_ratio", "seconds_low",
                                              "seconds_high", "pieces_ratio", "mean_rounds"});
  const SubdivisionOptions options = PaperSubdivision(SubdivisionMode::kUniform);
  double done = 0.0;
  const double cells = std::size(kRules) * static_cast<double>(CurveFamilies().size());
  for (const std::string& family : CurveFamilies()) {
    for (const char* rule : kRules) {
      if (InterruptRequested()) return true;
      if (run.progress) run.progress(done++ / cells, family + " " + rule);
      std::vector<std::vector<double>> seconds(kMostRounds + 1), pieces(kMostRounds + 1);
      std::vector<double> rounds(kMostRounds + 1);
      for (const int degree : kRoundDegrees) {
        for (int k = 0; k < kNumRoundCurves; ++k) {
          const BezierCurve curve = FamilyCurve(family, degree, k);
          RuleRun without;
          for (int n = 0; n <= kMostRounds; ++n) {
            const std::string name = std::string(rule) + "/rounds=" + std::to_string(n);
            const RuleRun found =
                RunRule(CheckedCutRule(name).get(), curve, options, run.repetitions);
            if (n == 0) without = found;
            seconds[n].push_back(found.seconds / without.seconds);
            pieces[n].push_back(static_cast<double>(found.result.num_pieces()) /
                                without.result.num_pieces());
            rounds[n] += found.result.rounds;
          }
        }
      }
      for (int n = 0; n <= kMostRounds; ++n) {
        const MedianWithInterval ratio = MedianOf(seconds[n]);
        table.AddRow({family, rule, std::to_string(n), NumberText(ratio.median),
                      NumberText(ratio.low), NumberText(ratio.high),
                      NumberText(MedianOf(pieces[n]).median),
                      NumberText(rounds[n] / (kNumRoundCurves * std::size(kRoundDegrees)))});
      }
    }
  }
  return true;
}

Judgement JudgeFallsThenRises(const ExperimentTables& tables) {
  Judgement judgement;
  int holding = 0, all = 0;
  for (const std::string& family : tables.at("").Distinct("family")) {
    const CsvTable rows = tables.at("").Where("family", family).Where("rule", "flatness");
    const std::vector<double> ratios = rows.Numbers("seconds_ratio");
    if (ratios.size() != kMostRounds + 1) return Judgement();
    const auto least = std::min_element(ratios.begin(), ratios.end());
    const auto best = static_cast<int>(least - ratios.begin());
    constexpr double kSeen = 0.02;
    ++all;
    holding +=
        best > 0 && best < kMostRounds && *least <= 1.0 - kSeen && ratios.back() >= *least + kSeen
            ? 1
            : 0;
    judgement.because += (judgement.because.empty() ? "" : "; ") + family +
                         ": least at N = " + std::to_string(best) + " with " + Rounded(*least, 2) +
                         " of the time of N = 0, at N = 8 " + Rounded(ratios.back(), 2);
  }
  judgement.verdict = all == 0         ? ClaimVerdict::kUndecided
                      : holding == all ? ClaimVerdict::kHolds
                      : holding > 0    ? ClaimVerdict::kInPart
                                       : ClaimVerdict::kDoesNotHold;
  return judgement;
}

std::vector<PlotPanel> RoundsPanels(const ExperimentTables& tables) {
  std::vector<PlotPanel> panels;
  for (const std::string& family : tables.at("").Distinct("family")) {
    PlotPanel panel;
    panel.title = family;
    panel.x_label = "N, rounds cut at the best place";
    panel.y_label = "time over that of N = 0, median";
    int color = 0;
    for (const char* rule : kRules) {
      const CsvTable rows = tables.at("").Where("family", family).Where("rule", rule);
      panel.series.push_back({rule, rows.Numbers("N"), rows.Numbers("seconds_ratio"),
                              PlotSeries::Style::kLinePoints, color++});
    }
    panels.push_back(std::move(panel));
  }
  return panels;
}

}  // namespace

Experiment BezierPaperRounds() {
  Experiment experiment;
  experiment.name = "rounds";
  experiment.title = "How many rounds are cut at the best place: N from 0 to 8";
  experiment.text =
      "Uniform rounds; 40 curves each of degrees 12, 16, 20 and 25 in each family. A search costs "
      "13 "
      "cuts, so that from some N on it must cost more than it can save.";
  experiment.run = &RunRounds;
  experiment.claims = {{"time falls, then rises with N", "section on N",
                        "holds where in every family the median time of the flatness rule is least "
                        "at an N from 1 to "
                        "7, at least 2 % below N = 0 and N = 8; in part where in some",
                        &JudgeFallsThenRises}};
  experiment.figures = {
      {"rounds_time", "Median time against N, over that of N = 0.", 3, &RoundsPanels}};
  return experiment;
}

}  // namespace batten
