#include "solvers/half_cut_rule.h"

namespace batten {

CutRuleInfo HalfCutRule::ClassInfo() {
  CutRuleInfo info;
  info.name = "half";
  info.summary = "in the middle of the piece's interval";
  info.source = "Lane & Riesenfeld, IEEE PAMI 2, 1980";
  return info;
}

}  // namespace batten
