#ifndef BATTEN_SOLVERS_CUT_RULE_REGISTRY_H_
#define BATTEN_SOLVERS_CUT_RULE_REGISTRY_H_

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "solvers/cut_rule.h"

namespace batten {

/// One registered cut rule: what it is, and how it is made.
struct CutRuleEntry {
  CutRuleInfo info;
  std::function<std::unique_ptr<CutRule>(const OptionValues& options)> make;
};

/// The row of a class with `static CutRuleInfo ClassInfo()` and a constructor from options.
template <typename RuleClass>
CutRuleEntry MakeCutRuleEntry() {
  return {RuleClass::ClassInfo(),
          [](const OptionValues& options) { return std::make_unique<RuleClass>(options); }};
}

/// All registered cut rules, by name; built-in ones come from the table in cut_rule_registry.cc.
class CutRuleRegistry {
 public:
  static CutRuleRegistry& Global();
  void Register(CutRuleEntry entry);
  void Remove(const std::string& name);  ///< For rules that come and go, as in tests.
  std::vector<std::string> Names() const;
  const CutRuleInfo* Find(const std::string& name) const;  ///< Null for an unknown name.
  /// A rule and the options it really uses (may be null); null with one sentence in `error`.
  std::unique_ptr<CutRule> Make(const NameSpec& spec, OptionValues* options_used,
                                std::string* error) const;

 private:
  std::map<std::string, CutRuleEntry> entries_;
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_CUT_RULE_REGISTRY_H_
