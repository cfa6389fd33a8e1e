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

std::string EffectiveIdentity(const RunResult& run) {
  std::map<std::string, std::map<std::string, std::string>> ran;  // options by solver
  std::string others;
  std::string ignored;
  for (const auto& [name, value] : run.notes) {
    NameSpec note;
    if (name != kOptionsThatRan) continue;
    if (!ParseNameSpec(value, &note, &ignored) || FindInChain(run.solver, note.name) == nullptr) {
      others += " ran " + value;
      continue;
    }
    for (const auto& [option, text] : note.options) ran[note.name][option] = text;
  }
  std::string identity;
  for (const NameSpec* spec = &run.solver; spec != nullptr; spec = spec->wrapped.get()) {
    OptionValues values;
    if (SolverRegistry::Global().Make(*spec, &values, &ignored) == nullptr) return "";
    std::map<std::string, std::string> options = values.ToText();
    for (const auto& [option, text] : ran[spec->name]) options[option] = text;
    ran.erase(spec->name);  // of two with one name the outer one, as in FindInChain
    identity += (identity.empty() ? "" : ":") + spec->name;
    for (const auto& [option, text] : options) identity += "/" + option + "=" + text;
  }
  return identity + others;
}

}  // namespace batten
