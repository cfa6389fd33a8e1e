#include <cmath>
#include <set>

#include "experiments/bench_matrix.h"
#include "experiments/bench_suite.h"
#include "problems/strict_json.h"
#include "solvers/solver_registry.h"

namespace batten {
namespace {

using Presence = StrictObject::Presence;

/// Values of one option: a number or a word, or a list of them.
bool ReadOptionValues(const StrictObject& options, const std::string& key,
                      std::vector<std::string>* values) {
  if (!options.IsList(key)) {
    double number = 0.0;
    std::string word;
    if (options.IsNumber(key) &&
        options.Number(key, Presence::kRequired, -HUGE_VAL, HUGE_VAL, &number)) {
      *values = {NumberText(number)};
      return true;
    }
    if (!options.Text(key, Presence::kRequired, &word)) return false;
    *values = {word};
    return true;
  }
  std::vector<StrictObject> entries;
  if (!options.Entries(key, Presence::kRequired, "a list of numbers or words", &entries))
    return false;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    std::string text;
    double number = 0.0;
    if (entries[i].IsText(&text)) {
      values->push_back(text);
    } else if (entries[i].IsNumber(&number)) {
      values->push_back(NumberText(number));
    } else {
      return options.Refuse(key + "/" + std::to_string(i), "a number or a word");
    }
  }
  return true;
}

/// Each of `solvers` with each value of the option.
bool SpreadOption(const StrictObject& options, const std::string& key,
                  std::vector<NameSpec>* solvers) {
  std::vector<std::string> values;
  std::string why;
  if (!ReadOptionValues(options, key, &values)) return false;
  std::vector<NameSpec> spread;
  for (const NameSpec& spec : *solvers) {
    for (const std::string& value : values) {
      NameSpec with = spec;
      with.options.emplace_back(key, value);
      OptionValues ignored;
      const SolverInfo& info = *SolverRegistry::Global().Find(spec.name);
      if (!ResolveOptions(info.options, with, &ignored, &why)) return options.Complain(key, why);
      spread.push_back(std::move(with));
    }
  }
  *solvers = std::move(spread);
  return true;
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
    if (SolverRegistry::Global().Make(with, nullptr, &why) == nullptr) {
      return entry.Complain(place, why);
    }
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
  if (!entry.IsText(&text)) return ReadSolverGrid(entry, solvers);
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
      if (SolverRegistry::Global().Make(spec, nullptr, &why) == nullptr) {
        return entry.Complain("", why);
      }
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
