#include "solvers/plugin_registry.h"

#include <algorithm>

#include "problems/catalogue.h"

namespace batten {
namespace {

/// What one kind of thing registers, and what is registered of it already.
struct Kind {
  std::string name;
  std::vector<std::string> added;
  std::vector<std::string> known;
};

std::string WhyNotOf(const Kind& kind) {
  for (std::size_t i = 0; i < kind.added.size(); ++i) {
    const std::string& name = kind.added[i];
    if (!IsSpecName(name)) {
      constexpr std::size_t kLongest = 60;
      return "registers a " + kind.name + " named " + Quoted(name, kLongest) +
             "; allowed: letters, digits, _ and -";
    }
    const auto before = kind.added.begin() + static_cast<std::ptrdiff_t>(i);
    if (std::find(kind.added.begin(), before, name) != before) {
      return "registers two " + kind.name + "s named " + name;
    }
    if (std::find(kind.known.begin(), kind.known.end(), name) != kind.known.end()) {
      return "registers a " + kind.name + " named " + name + ", which is there already";
    }
  }
  return "";
}

/// The files of the catalogue; a catalogue that cannot be read has no names to be taken.
std::vector<std::string> KnownProblems() {
  std::vector<std::string> names;
  std::string error;
  if (!ListCatalogue(&names, &error)) return ProblemRegistry::Global().Names();
  return names;
}

}  // namespace

std::string PluginRegistry::WhyNotOptions() const {
  const auto named = [](const std::string& kind, const std::string& name,
                        const std::vector<OptionInfo>& options) {
    std::string why = WhyNoOptionList(options);
    return why.empty() ? why : "registers a " + kind + " " + name + ", which " + why;
  };
  for (const SolverEntry& entry : solvers_) {
    std::string why = named("solver", entry.info.name, entry.info.options);
    if (!why.empty()) return why;
  }
  for (const CutRuleEntry& entry : cut_rules_) {
    std::string why = named("cut rule", entry.info.name, entry.info.options);
    if (!why.empty()) return why;
  }
  for (const auto& term : terms_) {
    // Those that every term has stand behind its own.
    std::vector<OptionInfo> options = term->Info().options;
    for (OptionInfo& common : CommonTermOptions()) options.push_back(std::move(common));
    std::string why = named("term", term->Info().name, options);
    if (!why.empty()) return why;
  }
  return "";
}

std::string PluginRegistry::WhyNot() const {
  Kind solvers = {"solver", {}, SolverRegistry::Global().Names()};
  for (const SolverEntry& entry : solvers_) solvers.added.push_back(entry.info.name);
  Kind rules = {"cut rule", {}, CutRuleRegistry::Global().Names()};
  for (const CutRuleEntry& entry : cut_rules_) rules.added.push_back(entry.info.name);
  Kind terms = {"term", {}, TermRegistry::Global().Names()};
  for (const auto& term : terms_) terms.added.push_back(term->Info().name);
  Kind problems = {"problem", {}, KnownProblems()};
  for (const NamedProblem& problem : problems_) problems.added.push_back(problem.name);
  Kind readers = {"data reader", {}, DataReaderRegistry::Global().Names()};
  for (const DataReader& reader : readers_) readers.added.push_back(reader.name);
  std::size_t count = 0;
  for (const Kind* kind : {&solvers, &rules, &terms, &problems, &readers}) {
    std::string why = WhyNotOf(*kind);
    if (!why.empty()) return why;
    count += kind->added.size();
  }
  if (count == 0) return "registers nothing";
  std::string bad_options = WhyNotOptions();
  if (!bad_options.empty()) return bad_options;
  for (const DataReader& reader : readers_) {
    std::string why = DataReaderRegistry::Global().WhyNot(reader);
    if (!why.empty()) return why;
  }
  return "";
}

std::string PluginRegistry::Commit(const std::string& path, std::vector<PluginName>* names) {
  std::string why = WhyNot();
  if (!why.empty()) return why;
  for (SolverEntry& entry : solvers_) {
    names->push_back({"solver", entry.info.name});
    SolverRegistry::Global().Register(std::move(entry));
  }
  for (CutRuleEntry& entry : cut_rules_) {
    names->push_back({"cut rule", entry.info.name});
    CutRuleRegistry::Global().Register(std::move(entry));
  }
  for (std::unique_ptr<Term>& term : terms_) {
    names->push_back({"term", term->Info().name});
    TermRegistry::Global().Register(std::move(term));
  }
  for (NamedProblem& problem : problems_) {
    names->push_back({"problem", problem.name});
    problem.plugin = path;
    ProblemRegistry::Global().Register(std::move(problem));
  }
  for (DataReader& reader : readers_) {
    names->push_back({"data reader", reader.name});
    DataReaderRegistry::Global().Register(std::move(reader));
  }
  return "";
}

}  // namespace batten
