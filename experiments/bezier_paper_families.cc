#include <algorithm>
#include <cmath>

#include "cost_functions/options.h"
#include "experiments/bezier_paper.h"
#include "experiments/bezier_paper_curves.h"
#include "experiments/bezier_paper_runs.h"
#include "experiments/experiment_runs.h"
#include "experiments/run.h"
#include "experiments/short_number.h"

namespace batten {
namespace {

constexpr int kNumFamilyCurves = 1000;
// Certifying an error takes longer than subdividing.
constexpr int kCertified = 20;
constexpr int kLowDegrees[] = {3, 6};

std::vector<std::string> TableColumns(const std::string& first, const std::string& second) {
  std::vector<std::string> columns = {first, second, "setting", "rule"};
  for (std::string& column : CellStatistics::Columns()) columns.push_back(std::move(column));
  return columns;
}

bool RunFamilies(const ExperimentRun& run, ExperimentTables* tables, std::string* /*error*/) {
  CsvTable& table = (*tables)[""] = CsvTable(TableColumns("family", "degree"));
  std::vector<int> degrees(std::begin(kLowDegrees), std::end(kLowDegrees));
  degrees.insert(degrees.end(), std::begin(kPaperDegrees), std::end(kPaperDegrees));
  double done = 0.0;
  const double cells = static_cast<double>(degrees.size() * CurveFamilies().size());
  for (const std::string& family : CurveFamilies()) {
    for (const int degree : degrees) {
      if (InterruptRequested()) return true;
      if (run.progress) run.progress(done++ / cells, family + " degree " + std::to_string(degree));
      std::vector<BezierCurve> curves;
      for (int k = 0; k < kNumFamilyCurves; ++k) curves.push_back(FamilyCurve(family, degree, k));
      CompareRules(curves, {family, std::to_string(degree)}, run.repetitions, kCertified, &table);
    }
  }
  return true;
}

bool RunGlyphs(const ExperimentRun& run, ExperimentTables* tables, std::string* error) {
  CsvTable& table = (*tables)[""] = CsvTable(TableColumns("font", "degree"));
  for (const char* name : {"ebgaramond_italic", "noto_mono"}) {
    std::vector<BezierCurve> curves;
    if (!GlyphCurves(name, &curves, error)) return false;
    for (const int degree : {2, 3}) {
      std::vector<BezierCurve> of_degree;
      std::copy_if(curves.begin(), curves.end(), std::back_inserter(of_degree),
                   [degree](const BezierCurve& curve) { return curve.degree() == degree; });
      if (of_degree.empty() || InterruptRequested()) continue;
      CompareRules(of_degree, {name, std::to_string(degree)}, run.repetitions, 1, &table);
    }
  }
  return true;
}

/// Cells of the paper's degrees, in which the median of `column` is at most `limit`; also all.
struct CellCount {
  int good = 0;
  int all = 0;
  double least = HUGE_VAL;
  double most = -HUGE_VAL;
};
CellCount CountCells(const CsvTable& rows, const std::string& column, double limit,
                     bool papers_degrees) {
  CellCount count;
  for (std::size_t k = 0; k < rows.num_rows(); ++k) {
    if (papers_degrees && rows.Number(k, "degree") < kPaperDegrees[0]) continue;
    const double value = rows.Number(k, column);
    if (std::isnan(value)) continue;
    ++count.all;
    count.good += value <= limit ? 1 : 0;
    count.least = std::min(count.least, value);
    count.most = std::max(count.most, value);
  }
  return count;
}

ClaimVerdict VerdictOfCells(const CellCount& count) {
  if (count.all == 0) return ClaimVerdict::kUndecided;
  return count.good == count.all ? ClaimVerdict::kHolds
         : count.good > 0        ? ClaimVerdict::kInPart
                                 : ClaimVerdict::kDoesNotHold;
}

std::string InCells(const CellCount& count) {
  return std::to_string(count.good) + " of " + std::to_string(count.all) + " cells (medians from " +
         Rounded(count.least, 2) + " to " + Rounded(count.most, 2) + ")";
}

Judgement JudgeHalfTheTime(const ExperimentTables& tables) {
  constexpr double kHalf = 0.5;
  const CellCount count =
      CountCells(RowsOf(tables.at(""), "uniform", "flatness"), "seconds_ratio", kHalf, true);
  return {VerdictOfCells(count), "flatness takes half of the time or less in " + InCells(count)};
}

Judgement JudgeHullSavesNothing(const ExperimentTables& tables) {
  constexpr double kJustBelow = 0.95;
  CellCount count =
      CountCells(RowsOf(tables.at(""), "uniform", "hull"), "seconds_ratio", kJustBelow, true);
  const std::string because = "hull saves 5 % of the time or more in " + InCells(count);
  count.good = count.all - count.good;
  return {VerdictOfCells(count), because};
}

Judgement JudgeNoWinnerAdaptive(const ExperimentTables& tables) {
  constexpr double kTenth = 0.1;
  const CsvTable rows = RowsOf(tables.at(""), "adaptive", "flatness");
  CellCount count = CountCells(rows, "pieces_ratio", 1.0 + kTenth, true);
  const CellCount below = CountCells(rows, "pieces_ratio", 1.0 - kTenth, true);
  count.good -= below.good;
  return {VerdictOfCells(count),
          "pieces of flatness and halving are within 10 % in " + InCells(count)};
}

Judgement JudgeLongest(const ExperimentTables& tables) {
  constexpr double kPieces = 0.75, kSeconds = 1.2;
  const CsvTable rows = RowsOf(tables.at(""), "certified", "longest");
  const CellCount pieces = CountCells(rows, "pieces_ratio", kPieces, false);
  const CellCount seconds = CountCells(rows, "seconds_ratio", kSeconds, false);
  const CellCount errors = CountCells(rows, "error_over_tolerance", 1.0, false);
  Judgement judgement;
  if (pieces.all == 0) return judgement;
  std::vector<double> all_pieces = rows.Numbers("pieces_ratio");
  std::vector<double> all_seconds = rows.Numbers("seconds_ratio");
  const auto middle = [](std::vector<double>* values) {
    const auto at = values->begin() + static_cast<std::ptrdiff_t>(values->size() / 2);
    std::nth_element(values->begin(), at, values->end());
    return *at;
  };
  const double piece_median = middle(&all_pieces), second_median = middle(&all_seconds);
  judgement.because = "over all cells " + Rounded(piece_median, 3) + " of halving's pieces in " +
                      Rounded(second_median, 2) + " times its time; at most 0.75 in " +
                      InCells(pieces) + ", at most 1.2 in " + InCells(seconds) +
                      "; certified errors up to " + Rounded(errors.most, 3) + " of the tolerance";
  const bool is_certified = errors.good == errors.all;
  judgement.verdict = is_certified && piece_median <= kPieces && second_median <= kSeconds
                          ? ClaimVerdict::kHolds
                      : is_certified && piece_median <= kPieces ? ClaimVerdict::kInPart
                                                                : ClaimVerdict::kDoesNotHold;
  return judgement;
}

Judgement JudgePapersStop(const ExperimentTables& tables) {
  const CellCount count =
      CountCells(RowsOf(tables.at(""), "adaptive", "half"), "error_over_tolerance", 1.0, false);
  return {VerdictOfCells(count),
          "the largest certified error of halving is within the tolerance in " + InCells(count) +
              ": the rule measures from the chord's line, and control points may overshoot its "
              "ends, where the curve turns back"};
}

CsvTable ShownCells(const ExperimentTables& tables, const std::string& first) {
  CsvTable shown({first, "degree", "setting", "rule", "pieces", "95 %", "time", "95 % (time)",
                  "wins : losses", "mean rounds", "cuts per piece", "true error"});
  constexpr int kDigits = 3;
  const CsvTable& table = tables.at("");
  for (std::size_t k = 0; k < table.num_rows(); ++k) {
    if (table.Text(k, "rule") == "half") continue;
    const auto number = [&table, k](const char* column) {
      return ShortNumber(table.Number(k, column), kDigits);
    };
    shown.AddRow({table.Text(k, first), table.Text(k, "degree"), table.Text(k, "setting"),
                  table.Text(k, "rule"), number("pieces_ratio"),
                  number("pieces_low") + " to " + number("pieces_high"), number("seconds_ratio"),
                  number("seconds_low") + " to " + number("seconds_high"),
                  table.Text(k, "time_wins") + " : " + table.Text(k, "time_losses"),
                  number("mean_rounds"), number("cuts_per_piece"), number("error_over_tolerance")});
  }
  return shown;
}

std::vector<PlotPanel> RatioPanels(const ExperimentTables& tables) {
  std::vector<PlotPanel> panels;
  for (const SubdivisionSetting& setting : SubdivisionSettings()) {
    for (const std::string& family : tables.at("").Distinct("family")) {
      PlotPanel panel;
      panel.title = family + ", " + setting.name;
      panel.x_label = "degree";
      panel.y_label = "time over halving's, median";
      int color = 0;
      for (const std::string& rule : ComparedRules(setting)) {
        if (rule == "half") continue;
        const CsvTable rows = RowsOf(tables.at("").Where("family", family), setting.name, rule);
        panel.series.push_back({rule, rows.Numbers("degree"), rows.Numbers("seconds_ratio"),
                                PlotSeries::Style::kLinePoints, color++});
      }
      panels.push_back(std::move(panel));
    }
  }
  return panels;
}

std::vector<SourceClaim> FamilyClaims() {
  return {
      {"the flatness rule saves half the time and more on complex curves of degree 12 to 25",
       "abstract",
       "holds where the median time of uniform rounds is at most half of halving's in every family "
       "and degree from 12 on; in part where in some",
       &JudgeHalfTheTime},
      {"the hull rule saves nothing", "Table",
       "holds where the median time of uniform rounds is above 0.95 of halving's in every family "
       "and degree from 12 on; in part where in some",
       &JudgeHullSavesNothing},
      {"with adaptive stopping flatness and halving need pieces within 10 % of each other",
       "a trial of ours",
       "holds where the median ratio of pieces is within 10 % of 1 in every family and degree from "
       "12 on; in part where in some",
       &JudgeNoWinnerAdaptive},
      {"pieces that pass the paper's stop rule are within the tolerance of the curve", "stop rule",
       "holds where no certified error of halving is above the tolerance; in part where in some "
       "families and degrees none is",
       &JudgePapersStop},
      {"the longest passing first part needs a quarter fewer pieces than halving in 1.2 times its "
       "time or less",
       "docs/cut_rules/longest.md",
       "by the certified stop: holds where the medians over all families and degrees say so and no "
       "certified error is above the tolerance; in part where only the time is longer",
       &JudgeLongest}};
}

}  // namespace

Experiment BezierPaperFamilies() {
  Experiment experiment;
  experiment.name = "families";
  experiment.title = "1,000 curves per degree and family";
  experiment.text =
      "Degrees of the paper's table, and 3 and 6, from three families: `uniform` (control points "
      "uniform in a square), `walk` (a random walk), `wave` (a sine of random amplitude, frequency "
      "and phase). Every rule cuts the same curves, one after the other; the error of every "
      "20th curve is certified. Wins and losses are by time.";
  experiment.run = &RunFamilies;
  experiment.shown = [](const ExperimentTables& tables) { return ShownCells(tables, "family"); };
  experiment.claims = FamilyClaims();
  experiment.figures = {{"families_time",
                         "Median time over that of halving: uniform rounds, adaptive, adaptive by "
                         "the certified stop.",
                         3, &RatioPanels}};
  return experiment;
}

Experiment BezierPaperGlyphs() {
  Experiment experiment;
  experiment.name = "glyphs";
  experiment.title = "Outlines of glyphs";
  experiment.text =
      "The curves of eight characters each of EB Garamond Italic (cubics) and Noto Mono "
      "(quadratics), from `data/glyphs`, straight lines left out; tolerance relative to the box of "
      "each curve. All errors are certified.";
  experiment.run = &RunGlyphs;
  experiment.shown = [](const ExperimentTables& tables) { return ShownCells(tables, "font"); };
  experiment.claims = {
      {"the longest passing first part needs a quarter fewer pieces than halving in 1.2 times its "
       "time or less",
       "docs/cut_rules/longest.md",
       "by the certified stop: holds where the median of fonts and degrees says so and no "
       "certified error is above the "
       "tolerance; in part where only the time is longer",
       &JudgeLongest}};
  return experiment;
}

}  // namespace batten
