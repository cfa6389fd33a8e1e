#include "experiments/bezier_paper_runs.h"

#include <glog/logging.h>

#include <algorithm>
#include <chrono>

#include "cost_functions/options.h"
#include "experiments/ratio_statistics.h"
#include "solvers/cut_rule_registry.h"
#include "solvers/half_cut_rule.h"
#include "splines/bezier_distance.h"
#include "splines/bezier_measures.h"

namespace batten {
namespace {

class AskedHalf final : public CutRule {
 public:
  CutRuleInfo Info() const override { return HalfCutRule::ClassInfo(); }
  double Choose(CutTrial* trial) override { return CutAtHalf(trial); }
};

}  // namespace

std::unique_ptr<CutRule> RuleIn(const SubdivisionSetting& setting, const std::string& name) {
  if (name == "half" && setting.options.stop == StopMeasure::kControlPoints) {
    return std::make_unique<AskedHalf>();
  }
  return CheckedCutRule(name);
}

std::unique_ptr<CutRule> CheckedCutRule(const std::string& name) {
  NameSpec spec;
  std::string error;
  CHECK(ParseNameSpec(name, &spec, &error)) << error;
  std::unique_ptr<CutRule> rule = CutRuleRegistry::Global().Make(spec, nullptr, &error);
  CHECK(rule != nullptr) << error;
  return rule;
}

SubdivisionOptions PaperSubdivision(SubdivisionMode mode) {
  SubdivisionOptions options;
  options.stop = StopMeasure::kControlPoints;
  options.mode = mode;
  return options;
}

RuleRun RunRule(CutRule* rule, const BezierCurve& curve, const SubdivisionOptions& options,
                int repetitions) {
  RuleRun run;
  std::vector<double> seconds;
  std::string error;
  CHECK(SubdivideBy(rule, curve, options, &run.result, &error)) << error;  // fills the caches
  for (int k = 0; k < repetitions; ++k) {
    const auto begin = std::chrono::steady_clock::now();
    CHECK(SubdivideBy(rule, curve, options, &run.result, &error)) << error;
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
    seconds.push_back(taken.count());
  }
  run.seconds = MedianOf(seconds).median;
  return run;
}

double ErrorOverTolerance(const BezierCurve& curve, const SubdivisionOptions& options,
                          const Subdivision& result) {
  const Eigen::Map<const Eigen::VectorXd> parameters(
      result.parameters.data(), static_cast<Eigen::Index>(result.parameters.size()));
  const double side = BoxSide(curve.degree(), curve.dimension(), curve.control_points().data());
  return BoundHausdorffDistance(curve, parameters, result.vertices).upper /
         (options.relative_tolerance * side);
}

std::vector<std::string> CellStatistics::Columns() {
  return {"curves",
          "pieces_ratio",
          "pieces_low",
          "pieces_high",
          "seconds_ratio",
          "seconds_low",
          "seconds_high",
          "time_wins",
          "time_losses",
          "mean_pieces",
          "mean_rounds",
          "cuts_per_piece",
          "error_over_tolerance",
          "failing"};
}

void CellStatistics::Add(const RuleRun& run, const RuleRun& half) {
  piece_ratios_.push_back(static_cast<double>(run.result.num_pieces()) / half.result.num_pieces());
  second_ratios_.push_back(run.seconds / half.seconds);
  rounds_ += run.result.rounds;
  cuts_ += static_cast<double>(run.result.cuts);
  pieces_ += run.result.num_pieces();
  num_failing_ += run.result.num_failing;
}

void CellStatistics::AddError(double error_over_tolerance) {
  largest_error_ = std::max(largest_error_, error_over_tolerance);
}

std::vector<std::string> CellStatistics::Cells() const {
  const MedianWithInterval pieces = MedianOf(piece_ratios_), seconds = MedianOf(second_ratios_);
  const WinCounts wins = CountWins(second_ratios_);
  const auto count = static_cast<double>(piece_ratios_.size());
  return {NumberText(count),           NumberText(pieces.median),   NumberText(pieces.low),
          NumberText(pieces.high),     NumberText(seconds.median),  NumberText(seconds.low),
          NumberText(seconds.high),    std::to_string(wins.wins),   std::to_string(wins.losses),
          NumberText(pieces_ / count), NumberText(rounds_ / count), NumberText(cuts_ / pieces_),
          NumberText(largest_error_),  std::to_string(num_failing_)};
}

const std::vector<SubdivisionSetting>& SubdivisionSettings() {
  static const auto& settings = *[] {
    SubdivisionOptions certified = PaperSubdivision(SubdivisionMode::kAdaptive);
    certified.stop = StopMeasure::kPolygon;
    return new std::vector<SubdivisionSetting>{
        {"uniform", PaperSubdivision(SubdivisionMode::kUniform)},
        {"adaptive", PaperSubdivision(SubdivisionMode::kAdaptive)},
        {"certified", certified}};
  }();
  return settings;
}

std::vector<std::string> ComparedRules(const SubdivisionSetting& setting) {
  std::vector<std::string> rules = {"half", "flatness", "flatness/rounds=8/choice=automatic",
                                    "hull", "share"};
  if (setting.options.mode == SubdivisionMode::kAdaptive) rules.emplace_back("longest");
  return rules;
}

void CompareRules(const std::vector<BezierCurve>& curves, const std::vector<std::string>& first,
                  int repetitions, int certified, CsvTable* table) {
  for (const SubdivisionSetting& setting : SubdivisionSettings()) {
    const SubdivisionOptions& options = setting.options;
    const std::vector<std::string> names = ComparedRules(setting);
    std::vector<std::unique_ptr<CutRule>> rules;
    for (const std::string& name : names) rules.push_back(RuleIn(setting, name));
    std::vector<CellStatistics> cells(names.size());
    for (std::size_t k = 0; k < curves.size(); ++k) {
      const RuleRun half = RunRule(rules[0].get(), curves[k], options, repetitions);
      for (std::size_t r = 0; r < rules.size(); ++r) {
        const RuleRun run =
            r == 0 ? half : RunRule(rules[r].get(), curves[k], options, repetitions);
        cells[r].Add(run, half);
        if (k % static_cast<std::size_t>(certified) != 0) continue;
        cells[r].AddError(ErrorOverTolerance(curves[k], options, run.result));
      }
    }
    for (std::size_t r = 0; r < rules.size(); ++r) {
      std::vector<std::string> row = first;
      row.insert(row.end(), {setting.name, names[r]});
      for (std::string& cell : cells[r].Cells()) row.push_back(std::move(cell));
      table->AddRow(std::move(row));
    }
  }
}

CsvTable RowsOf(const CsvTable& table, const std::string& setting, const std::string& rule) {
  return table.Where("setting", setting).Where("rule", rule);
}

}  // namespace batten
