#include <algorithm>
#include <cmath>

#include "cost_functions/options.h"
#include "experiments/bezier_paper.h"
#include "experiments/bezier_paper_curves.h"
#include "experiments/bezier_paper_runs.h"
#include "experiments/experiment_runs.h"
#include "experiments/ratio_statistics.h"
#include "experiments/run.h"
#include "experiments/short_number.h"

namespace batten {
namespace {

constexpr int kEqualErrorDegrees[] = {3, 8, 16, 25};
constexpr int kNumEqualErrorCurves = 20;
constexpr double kWanted = 1e-4;

struct AtError {
  RuleRun run;
  double error = 0.0;  // over what is wanted
};

/// The run with fewest pieces among some whose certified error is at most kWanted of the box: the
/// tolerance is changed by what the last one missed, since errors go with it.
AtError RunAtError(CutRule* rule, const BezierCurve& curve, int repetitions) {
  SubdivisionOptions options;
  options.relative_tolerance = kWanted;
  AtError best;
  double tolerance = kWanted;
  constexpr int kTries = 8;
  for (int k = 0; k < kTries; ++k) {
    const Subdivision found = RunRule(rule, curve, options, 0).result;
    const double error =
        ErrorOverTolerance(curve, options, found) * options.relative_tolerance / kWanted;
    const bool is_better = best.error == 0.0 || found.num_pieces() < best.run.result.num_pieces();
    if (error <= 1.0 && is_better) {
      best.run.result = found;
      best.error = error;
      tolerance = options.relative_tolerance;
    }
    // Halfway back where it was too much: errors of halving go by steps.
    options.relative_tolerance = error <= 1.0
                                     ? options.relative_tolerance / std::max(error, 0.25) * 1.01
                                     : std::sqrt(options.relative_tolerance * tolerance);
  }
  options.relative_tolerance = tolerance;
  best.run = RunRule(rule, curve, options, repetitions);
  return best;
}

bool RunEqualError(const ExperimentRun& run, ExperimentTables* tables, std::string* /*error*/) {
  CsvTable& table = (*tables)[""] =
      CsvTable({"family", "degree", "rule", "curves", "pieces_ratio", "pieces_low", "pieces_high",
                "seconds_ratio", "mean_error"});
  const std::vector<std::string> names = ComparedRules(SubdivisionSettings().back());
  double done = 0.0;
  const double cells = std::size(kEqualErrorDegrees) * static_cast<double>(CurveFamilies().size());
  for (const std::string& family : CurveFamilies()) {
    for (const int degree : kEqualErrorDegrees) {
      if (InterruptRequested()) return true;
      if (run.progress) run.progress(done++ / cells, family + " degree " + std::to_string(degree));
      std::vector<std::vector<double>> pieces(names.size()), seconds(names.size());
      std::vector<double> errors(names.size());
      for (int k = 0; k < kNumEqualErrorCurves; ++k) {
        const BezierCurve curve = FamilyCurve(family, degree, k);
        AtError half;
        for (std::size_t r = 0; r < names.size(); ++r) {
          const AtError found = RunAtError(CheckedCutRule(names[r]).get(), curve, run.repetitions);
          if (r == 0) half = found;
          pieces[r].push_back(static_cast<double>(found.run.result.num_pieces()) /
                              half.run.result.num_pieces());
          seconds[r].push_back(found.run.seconds / half.run.seconds);
          errors[r] += found.error / kNumEqualErrorCurves;
        }
      }
      for (std::size_t r = 0; r < names.size(); ++r) {
        const MedianWithInterval ratio = MedianOf(pieces[r]);
        table.AddRow({family, std::to_string(degree), names[r],
                      std::to_string(kNumEqualErrorCurves), NumberText(ratio.median),
                      NumberText(ratio.low), NumberText(ratio.high),
                      NumberText(MedianOf(seconds[r]).median), NumberText(errors[r])});
      }
    }
  }
  return true;
}

CsvTable ShownEqualError(const ExperimentTables& tables) {
  CsvTable shown({"family", "degree", "rule", "pieces", "95 %", "time", "mean error / wanted"});
  constexpr int kDigits = 3;
  const CsvTable& table = tables.at("");
  for (std::size_t k = 0; k < table.num_rows(); ++k) {
    const auto number = [&table, k](const char* column) {
      return ShortNumber(table.Number(k, column), kDigits);
    };
    shown.AddRow({table.Text(k, "family"), table.Text(k, "degree"), table.Text(k, "rule"),
                  number("pieces_ratio"), number("pieces_low") + " to " + number("pieces_high"),
                  number("seconds_ratio"), number("mean_error")});
  }
  return shown;
}

Judgement JudgePieces(const ExperimentTables& tables) {
  constexpr double kQuarterFewer = 0.75;
  const CsvTable rows = tables.at("").Where("rule", "longest");
  int good = 0;
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (const double ratio : rows.Numbers("pieces_ratio")) {
    good += ratio <= kQuarterFewer ? 1 : 0;
    least = std::min(least, ratio);
    most = std::max(most, ratio);
  }
  const auto all = static_cast<int>(rows.num_rows());
  Judgement judgement;
  if (all == 0) return judgement;
  judgement.because = "longest needs a quarter fewer pieces in " + std::to_string(good) + " of " +
                      std::to_string(all) + " families and degrees (medians from " +
                      Rounded(least, 2) + " to " + Rounded(most, 2) + ")";
  judgement.verdict = good == all ? ClaimVerdict::kHolds
                      : good > 0  ? ClaimVerdict::kInPart
                                  : ClaimVerdict::kDoesNotHold;
  return judgement;
}

}  // namespace

Experiment BezierPaperEqualError() {
  Experiment experiment;
  experiment.name = "equal_error";
  experiment.title = "The rules at equal true error";
  experiment.text =
      "At one tolerance a rule may come nearer to the curve than another. Here each rule gets, on "
      "each curve, the tolerance of `polygon` with which it needs fewest pieces, of eight that are "
      "tried, at a certified error of at most 1e-4 of the curve's box. 20 curves each of degrees "
      "3, "
      "8, 16 and 25 in each family, adaptive; ratios are to halving on the same curve.";
  experiment.run = &RunEqualError;
  experiment.shown = &ShownEqualError;
  experiment.claims = {
      {"at equal true error the longest passing first part needs a quarter fewer pieces than "
       "halving",
       "docs/cut_rules/longest.md",
       "holds where the median ratio is at most 0.75 in every family and degree; in part where in "
       "some",
       &JudgePieces}};
  return experiment;
}

}  // namespace batten
