#ifndef BATTEN_SOLVERS_LONGEST_CUT_RULE_H_
#define BATTEN_SOLVERS_LONGEST_CUT_RULE_H_

#include <optional>

#include "solvers/cut_rule.h"
#include "solvers/passing_length.h"

namespace batten {

/// The longest first piece that still passes, one after the other. Where every part of a piece that
/// passes passes too, no polyline whose vertices lie on the curve has fewer pieces.
/// docs/cut_rules/longest.md.
class LongestCutRule final : public CutRule {
 public:
  static CutRuleInfo ClassInfo();
  explicit LongestCutRule(const OptionValues& options);
  CutRuleInfo Info() const override { return ClassInfo(); }
  std::string WhyUnsupported(const BezierCurve& curve,
                             const SubdivisionOptions& options) const override;
  void Start(const BezierCurve& curve, const SubdivisionOptions& options) override;
  double Choose(CutTrial* trial) override;

 private:
  void Prepare(const CutTrial& trial);
  double FirstGuess(const CutTrial& trial) const;
  bool IsLongEnough(const StopValue& value) const;

  double least_;
  double least_value_ = 0.0;  // of the stop value over its limit
  double aim_;
  int num_trials_;
  std::optional<PassingLength> passing_;
  double previous_length_ = 0.0;  // of the piece before, on the curve's interval
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_LONGEST_CUT_RULE_H_
