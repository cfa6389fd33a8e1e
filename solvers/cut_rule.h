#ifndef BATTEN_SOLVERS_CUT_RULE_H_
#define BATTEN_SOLVERS_CUT_RULE_H_

#include <string>
#include <vector>

#include "cost_functions/options.h"
#include "splines/bezier_subdivision.h"

namespace batten {

struct CutRuleInfo {
  std::string name;
  std::string summary;  ///< One line.
  std::string source;
  std::vector<OptionInfo> options;
};

/// Where the pieces of a curve are cut, under a name and with options. One object serves one
/// thread; it may remember earlier pieces of a curve.
class CutRule {
 public:
  virtual ~CutRule() = default;
  virtual CutRuleInfo Info() const = 0;
  /// Empty: `curve` can be subdivided so. Otherwise one sentence.
  virtual std::string WhyUnsupported(const BezierCurve& curve,
                                     const SubdivisionOptions& options) const;
  /// Before the first piece of a curve.
  virtual void Start(const BezierCurve& /*curve*/, const SubdivisionOptions& /*options*/) {}
  /// Choose() is 1/2 for every piece, and need not be called.
  virtual bool AlwaysHalves() const { return false; }
  /// Where the piece is cut, in (0, 1) of it.
  virtual double Choose(CutTrial* trial) = 0;
};

/// Subdivide() by `rule`. False with one sentence in `error` where WhyUnsupported() has one.
bool SubdivideBy(CutRule* rule, const BezierCurve& curve, const SubdivisionOptions& options,
                 Subdivision* result, std::string* error);

}  // namespace batten

#endif  // BATTEN_SOLVERS_CUT_RULE_H_
