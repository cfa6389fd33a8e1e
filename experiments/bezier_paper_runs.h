#ifndef BATTEN_EXPERIMENTS_BEZIER_PAPER_RUNS_H_
#define BATTEN_EXPERIMENTS_BEZIER_PAPER_RUNS_H_

#include <memory>
#include <string>
#include <vector>

#include "experiments/csv_table.h"
#include "experiments/reproduction.h"
#include "solvers/cut_rule.h"

namespace batten {

/// A registered rule by NAME/OPTION=VALUE; an unknown one is our bug: CHECK.
std::unique_ptr<CutRule> CheckedCutRule(const std::string& name);

/// The paper's stop: control points within 1e-5 of the chord, relative to the box; in its uniform
/// rounds or adaptive.
SubdivisionOptions PaperSubdivision(SubdivisionMode mode);

/// One curve cut by one rule.
struct RuleRun {
  Subdivision result;
  double seconds = 0.0;  ///< Median of the repetitions behind one run that is not counted.
};
RuleRun RunRule(CutRule* rule, const BezierCurve& curve, const SubdivisionOptions& options,
                int repetitions);

/// The certified true error over the tolerance times the curve's box: at most 1 where all is well.
double ErrorOverTolerance(const BezierCurve& curve, const SubdivisionOptions& options,
                          const Subdivision& result);

/// What a rule came to on the curves of one cell, beside halving on the same curves.
class CellStatistics {
 public:
  static std::vector<std::string> Columns();

  void Add(const RuleRun& run, const RuleRun& half);
  void AddError(double error_over_tolerance);
  /// Medians of the ratios to halving with their intervals, wins by time, means.
  std::vector<std::string> Cells() const;

 private:
  std::vector<double> piece_ratios_;
  std::vector<double> second_ratios_;
  double rounds_ = 0.0;
  double cuts_ = 0.0;
  double pieces_ = 0.0;
  double largest_error_ = 0.0;
  int num_failing_ = 0;
};

/// How curves are subdivided: "uniform", "adaptive", both by the paper's stop, and "certified",
/// adaptive by the polygon's distance from the chord's segment, which bounds the true error.
struct SubdivisionSetting {
  std::string name;
  SubdivisionOptions options;
};
const std::vector<SubdivisionSetting>& SubdivisionSettings();

/// Rules that are compared in a setting; halving is the first.
std::vector<std::string> ComparedRules(const SubdivisionSetting& setting);

/// The rule as it runs in a setting. In those of the paper halving is asked about each piece, as
/// the rules beside it are, since times compare rules there; in "certified" it is what users run,
/// which asks nobody and is faster.
std::unique_ptr<CutRule> RuleIn(const SubdivisionSetting& setting, const std::string& name);

/// Runs the rules of all settings on each curve, one after the other on the same curve, and adds a
/// row per setting and rule behind `first` to `table`, whose columns are first, setting, rule and
/// CellStatistics::Columns(). Every `certified`-th curve's true error is certified.
void CompareRules(const std::vector<BezierCurve>& curves, const std::vector<std::string>& first,
                  int repetitions, int certified, CsvTable* table);

/// The rows of a setting and rule.
CsvTable RowsOf(const CsvTable& table, const std::string& setting, const std::string& rule);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_BEZIER_PAPER_RUNS_H_
