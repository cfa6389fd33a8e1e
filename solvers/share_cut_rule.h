#ifndef BATTEN_SOLVERS_SHARE_CUT_RULE_H_
#define BATTEN_SOLVERS_SHARE_CUT_RULE_H_

#include <optional>

#include "solvers/cut_rule.h"
#include "solvers/passing_length.h"

namespace batten {

/// Counts how many pieces a piece will come to, and gives each part a whole number of them; in
/// uniform rounds half of them.
/// docs/cut_rules/share.md.
class ShareCutRule final : public CutRule {
 public:
  static CutRuleInfo ClassInfo();
  explicit ShareCutRule(const OptionValues& options);
  CutRuleInfo Info() const override { return ClassInfo(); }
  void Start(const BezierCurve& curve, const SubdivisionOptions& options) override;
  double Choose(CutTrial* trial) override;

 private:
  double DensityAt(const CutTrial& trial, double s) const;

  double aim_;
  bool is_uniform_ = false;
  std::optional<PassingLength> passing_;
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_SHARE_CUT_RULE_H_
