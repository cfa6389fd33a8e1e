#include "solvers/cut_rule_registry.h"

#include <glog/logging.h>

#include "solvers/best_cut_rule.h"
#include "solvers/half_cut_rule.h"
#include "solvers/longest_cut_rule.h"
#include "solvers/share_cut_rule.h"

namespace batten {
namespace {

// The built-in cut rules: one line each.
CutRuleEntry (*const kBuiltInCutRules[])() = {
    &MakeCutRuleEntry<HalfCutRule>,  &MakeCutRuleEntry<FlatnessCutRule>,
    &MakeCutRuleEntry<HullCutRule>,  &MakeCutRuleEntry<LongestCutRule>,
    &MakeCutRuleEntry<ShareCutRule>,
};

}  // namespace

CutRuleRegistry& CutRuleRegistry::Global() {
  static CutRuleRegistry& registry = *[] {
    auto* made = new CutRuleRegistry;
    for (const auto make : kBuiltInCutRules) made->Register(make());
    return made;
  }();
  return registry;
}

void CutRuleRegistry::Register(CutRuleEntry entry) {
  const std::string name = entry.info.name;
  CHECK(entries_.emplace(name, std::move(entry)).second) << "two cut rules are named " << name;
}

void CutRuleRegistry::Remove(const std::string& name) { entries_.erase(name); }

std::vector<std::string> CutRuleRegistry::Names() const {
  std::vector<std::string> names;
  for (const auto& [name, entry] : entries_) names.push_back(name);
  return names;
}

const CutRuleInfo* CutRuleRegistry::Find(const std::string& name) const {
  const auto found = entries_.find(name);
  return found == entries_.end() ? nullptr : &found->second.info;
}

std::unique_ptr<CutRule> CutRuleRegistry::Make(const NameSpec& spec, OptionValues* options_used,
                                               std::string* error) const {
  const auto found = entries_.find(spec.name);
  if (found == entries_.end()) {
    *error = UnknownNameMessage("cut rule", spec.name, Names());
    return nullptr;
  }
  if (spec.wrapped != nullptr) {
    *error = spec.name + " wraps nothing; found :" + spec.wrapped->ToString();
    return nullptr;
  }
  OptionValues options;
  if (!ResolveOptions(found->second.info.options, spec, &options, error)) return nullptr;
  if (options_used != nullptr) *options_used = options;
  return found->second.make(options);
}

}  // namespace batten
