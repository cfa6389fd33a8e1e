#include "solvers/cut_rule.h"

namespace batten {

std::string CutRule::WhyUnsupported(const BezierCurve& /*curve*/,
                                    const SubdivisionOptions& /*options*/) const {
  return "";
}

bool SubdivideBy(CutRule* rule, const BezierCurve& curve, const SubdivisionOptions& options,
                 Subdivision* result, std::string* error) {
  const std::string why_not = rule->WhyUnsupported(curve, options);
  if (!why_not.empty()) {
    *error = why_not;
    return false;
  }
  rule->Start(curve, options);
  CutChoice choice;
  if (!rule->AlwaysHalves()) choice = [rule](CutTrial* trial) { return rule->Choose(trial); };
  return Subdivide(curve, choice, options, result, error);
}

}  // namespace batten
