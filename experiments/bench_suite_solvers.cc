#include <algorithm>
#include <set>

#include "experiments/bench_matrix.h"
#include "experiments/bench_suite.h"
#include "experiments/plugin_faults.h"
#include "problems/strict_json.h"
#include "solvers/solver_registry.h"

namespace batten {
namespace {

using Presence = StrictObject::Presence;

/// One value of an option and where it stands: "memory/1".
struct PlacedValue {
  std::string place;
  std::string text;
};

/// Values of one option: a number or a word, or a list of them.
bool ReadOptionValues(const StrictObject& options, const std::string& key,
                      std::vector<PlacedValue>* values) {
  constexpr char kAllowed[] = "a number or a word, or a list of them";
  std::vector<StrictObject> entries;
  if (!options.IsList(key)) {
    entries.push_back(options.Entry(key));
  } else if (!options.Entries(key, Presence::kRequired, kAllowed, &entries)) {
    return false;
  }
  for (std::size_t i = 0; i < entries.size(); ++i) {
    PlacedValue value = {options.IsList(key) ? key + "/" + std::to_string(i) : key, ""};
    double number = 0.0;
    if (entries[i].IsNumber(&number)) {
      value.text = NumberText(number);
    } else if (!entries[i].IsText(&value.text) || !IsSpecValue(value.text)) {
      return entries[i].Refuse("", options.IsList(key) ? "a number or a word" : kAllowed);
    }
    values->push_back(std::move(value));
  }
  std::vector<std::string> texts;
  for (const PlacedValue& value : *values) texts.push_back(value.text);
  return options.IsWithoutRepeats(key, texts);
}

/// Each of `solvers`, which are one with its options so far, with each value of the option.
bool SpreadOption(const StrictObject& options, const std::string& key,
                  std::vector<NameSpec>* solvers) {
  const SolverInfo& info = *SolverRegistry::Global().Find(solvers->front().name);
  std::vector<PlacedValue> values;
  OptionValues ignored;
  std::string why;
  const bool is_known =
      std::any_of(info.options.begin(), info.options.end(),
                  [&key](const OptionInfo& option) { return option.name == key; });
  if (!is_known) {
    ResolveOptions(info.options, {solvers->front().name, {{key, ""}}, nullptr}, &ignored, &why);
    return options.Complain(key, why);
  }
  for (const auto& [name, value] : solvers->front().options) {
    if (name != key) continue;
    return options.Refuse(key, "nothing, where `solver` has " + name + "=" + value);
  }
  if (!ReadOptionValues(options, key, &values)) return false;
  std::vector<NameSpec> spread;
  for (const NameSpec& spec : *solvers) {
    for (const PlacedValue& value : values) {
      NameSpec with = spec;
      with.options.emplace_back(key, value.text);
      if (!ResolveOptions(info.options, with, &ignored, &why)) {
        return options.Complain(value.place, why);
      }
      spread.push_back(std::move(with));
    }
  }
  *solvers = std::move(spread);
  return true;
}

/// Whether the solver can be made. What a plugin does to make one is tried in a process of its own
/// first: here it would end all cells, those of other solvers, too.
bool CanBeMade(const NameSpec& solver, std::string* why) {
  const SolverRegistry& registry = SolverRegistry::Global();
  if (IsOfPlugin(solver)) {
    const std::string end = WhyNoReturn([&] {
      std::string ignored;
      registry.Make(solver, nullptr, &ignored);
    });
    if (!end.empty()) {
      *why = "found " + solver.ToString() + ", a plugin's solver that " + end + " while it is made";
      return false;
    }
  }
  return registry.Make(solver, nullptr, why) != nullptr;
}

/// `solver` around each of "wraps".
bool WrapEach(const StrictObject& entry, const std::vector<std::string>& wrapped,
              const NameSpec& solver, std::vector<NameSpec>* solvers) {
  for (std::size_t i = 0; i < wrapped.size(); ++i) {
    const std::string place = "wraps/" + std::to_string(i);
    NameSpec inner;
    std::string why;
    if (!ParseNameSpec(wrapped[i], &inner, &why)) return entry.Complain(place, why);
    NameSpec with = solver;
    with.wrapped = std::make_shared<NameSpec>(inner);
    if (!CanBeMade(with, &why)) return entry.Complain(place, why);
    solvers->push_back(std::move(with));
  }
  return true;
}

/// {"solver": NAME, "options": {...}, "wraps": [...]}: the product of all lists.
bool ReadSolverGrid(const StrictObject& entry, std::vector<NameSpec>* solvers) {
  NameSpec base;
  std::string text, why;
  StrictObject options;
  std::vector<std::string> wrapped;
  if (!entry.HasOnly({"solver", "options", "wraps"}) ||
      !entry.Text("solver", Presence::kRequired, &text) ||
      !entry.Object("options", Presence::kOptional, &options) ||
      !entry.Texts("wraps", Presence::kOptional, &wrapped)) {
    return false;
  }
  if (!ParseNameSpec(text, &base, &why)) return entry.Complain("solver", why);
  if (SolverRegistry::Global().Find(base.name) == nullptr) {
    return entry.Complain(
        "solver", UnknownNameMessage("solver", base.name, SolverRegistry::Global().Names()));
  }
  OptionValues ignored;
  const SolverInfo& info = *SolverRegistry::Global().Find(base.name);
  if (!ResolveOptions(info.options, base, &ignored, &why)) return entry.Complain("solver", why);
  if (base.wrapped != nullptr && !wrapped.empty()) {
    return entry.Refuse("wraps", "nothing, where `solver` wraps " + base.wrapped->ToString());
  }
  std::vector<NameSpec> made = {base};
  for (const std::string& key : options.Keys()) {
    if (!SpreadOption(options, key, &made)) return false;
  }
  for (const NameSpec& spec : made) {
    if (wrapped.empty()) solvers->push_back(spec);
    if (!WrapEach(entry, wrapped, spec, solvers)) return false;
  }
  return true;
}

bool ReadSolverEntry(const StrictObject& entry, std::vector<NameSpec>* solvers) {
  const SolverRegistry& registry = SolverRegistry::Global();
  std::string text, why;
  if (entry.IsObject()) return ReadSolverGrid(entry, solvers);
  if (!entry.IsText(&text)) return entry.Refuse("", "a name with options, all, or an object");
  NameSpec spec;
  if (text == "all") {
    for (const std::string& name : registry.Names()) {
      if (!ParseNameSpec(registry.UsualName(name), &spec, &why)) return entry.Complain("", why);
      solvers->push_back(spec);
    }
    return true;
  }
  if (!ParseNameSpec(text, &spec, &why)) return entry.Complain("", why);
  if (registry.Find(spec.name) == nullptr) {
    std::vector<std::string> names = registry.Names();
    names.emplace_back("all");
    return entry.Complain("", UnknownNameMessage("solver", spec.name, names));
  }
  solvers->push_back(spec);
  return true;
}

}  // namespace

bool ReadBenchSolvers(const StrictObject& file, std::vector<NameSpec>* solvers) {
  std::vector<StrictObject> entries;
  if (!file.Entries("solvers", Presence::kRequired, "a list of solvers", &entries)) return false;
  std::set<std::string> identities;
  for (const StrictObject& entry : entries) {
    std::vector<NameSpec> read;
    if (!ReadSolverEntry(entry, &read)) return false;
    for (NameSpec& spec : read) {
      std::string why;
      if (!CanBeMade(spec, &why)) return entry.Complain("", why);
      // By what they mean: lbfgs is lbfgs/memory=10.
      if (!identities.insert(SolverIdentity(spec)).second) {
        return entry.Complain(
            "", "found " + spec.ToString() + " twice, by its options; allowed: each solver once");
      }
      solvers->push_back(std::move(spec));
    }
  }
  return true;
}

}  // namespace batten
