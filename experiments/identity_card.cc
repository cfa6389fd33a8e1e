#include "experiments/identity_card.h"

#include <map>

#include "solvers/options_note.h"
#include "solvers/solver_registry.h"

namespace batten {
namespace {

/// That of the chain which has this name; null: none.
const NameSpec* FindInChain(const NameSpec& chain, const std::string& name) {
  if (chain.name == name) return &chain;
  return chain.wrapped == nullptr ? nullptr : FindInChain(*chain.wrapped, name);
}

std::string DifferenceOf(const NameSpec& chain, const std::string& note) {
  NameSpec ran;
  std::string error;
  if (!ParseNameSpec(note, &ran, &error)) return "ran " + note;
  const NameSpec* const asked = FindInChain(chain, ran.name);
  OptionValues values;
  if (asked == nullptr || SolverRegistry::Global().Make(*asked, &values, &error) == nullptr) {
    return "ran " + note;
  }
  const std::map<std::string, std::string> options = values.ToText();
  std::string text;
  for (const auto& [name, value] : ran.options) {
    const auto found = options.find(name);
    const std::string wanted = found == options.end() ? "no " + name : name + "=" + found->second;
    if (wanted == name + "=" + value) continue;
    text += (text.empty() ? "asked " : ", asked ") + wanted + ", ran " + name + "=" + value;
  }
  return text;
}

}  // namespace

std::string OptionsThatDiffer(const RunResult& run) {
  for (const auto& [name, value] : run.notes) {
    if (name != kOptionsThatRan) continue;
    std::string difference = DifferenceOf(run.solver, value);
    if (!difference.empty()) return difference;
  }
  return "";
}

}  // namespace batten
