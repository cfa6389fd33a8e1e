#ifndef BATTEN_SOLVERS_BEST_CUT_RULE_H_
#define BATTEN_SOLVERS_BEST_CUT_RULE_H_

#include "solvers/cut_rule.h"
#include "splines/bezier_cut_value.h"

namespace batten {

/// Where the sum of a measure over both parts is least, in the first N rounds; at 1/2 from then on.
/// N is fixed or taken from the piece: while some leg of its control polygon stands at more than 45
/// degrees to the chord. Pieces below that are nearly parabolas, whose best cut is near 1/2.
class BestCutRule : public CutRule {
 public:
  double Choose(CutTrial* trial) override;

 protected:
  BestCutRule(CutMeasure measure, const OptionValues& options);
  static std::vector<OptionInfo> Options();

 private:
  bool IsSearched(const CutTrial& trial) const;

  CutMeasure measure_;
  bool is_exact_;
  bool is_automatic_;
  int num_rounds_;
};

/// The two control polygons that are flattest. docs/cut_rules/flatness.md.
class FlatnessCutRule final : public BestCutRule {
 public:
  static CutRuleInfo ClassInfo();
  explicit FlatnessCutRule(const OptionValues& options)
      : BestCutRule(CutMeasure::kFlatness, options) {}
  CutRuleInfo Info() const override { return ClassInfo(); }
};

/// The two smallest hulls; planar curves. docs/cut_rules/hull.md.
class HullCutRule final : public BestCutRule {
 public:
  static CutRuleInfo ClassInfo();
  explicit HullCutRule(const OptionValues& options) : BestCutRule(CutMeasure::kHullArea, options) {}
  CutRuleInfo Info() const override { return ClassInfo(); }
  std::string WhyUnsupported(const BezierCurve& curve,
                             const SubdivisionOptions& options) const override;
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_BEST_CUT_RULE_H_
