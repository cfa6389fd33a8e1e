#ifndef BATTEN_SOLVERS_HALF_CUT_RULE_H_
#define BATTEN_SOLVERS_HALF_CUT_RULE_H_

#include "solvers/cut_rule.h"

namespace batten {

/// Every piece in the middle of its interval. docs/cut_rules/half.md.
class HalfCutRule final : public CutRule {
 public:
  static CutRuleInfo ClassInfo();
  explicit HalfCutRule(const OptionValues& /*options*/) {}
  CutRuleInfo Info() const override { return ClassInfo(); }
  bool AlwaysHalves() const override { return true; }
  double Choose(CutTrial* trial) override { return CutAtHalf(trial); }
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_HALF_CUT_RULE_H_
