#ifndef BATTEN_SOLVERS_PLUGIN_REGISTRY_H_
#define BATTEN_SOLVERS_PLUGIN_REGISTRY_H_

#include <memory>
#include <string>
#include <vector>

#include "cost_functions/term.h"
#include "problems/data_reader.h"
#include "problems/problem_registry.h"
#include "solvers/cut_rule_registry.h"
#include "solvers/solver_registry.h"

namespace batten {

/// Something that a plugin has registered: "solver", "my_solver".
struct PluginName {
  std::string kind;
  std::string name;
};

/// What a plugin hands to the program: kept here until it is known that all of it can be
/// registered, so that a plugin is there whole or not at all.
class PluginRegistry {
 public:
  /// A class as in solvers/cg.h: `static SolverInfo ClassInfo()`, a constructor from OptionValues.
  template <typename SolverClass>
  void AddSolver() {
    Add(MakeSolverEntry<SolverClass>());
  }
  /// A class as in solvers/half_cut_rule.h.
  template <typename RuleClass>
  void AddCutRule() {
    Add(MakeCutRuleEntry<RuleClass>());
  }
  void Add(SolverEntry entry) { solvers_.push_back(std::move(entry)); }
  void Add(CutRuleEntry entry) { cut_rules_.push_back(std::move(entry)); }
  void Add(std::unique_ptr<Term> term) { terms_.push_back(std::move(term)); }
  void Add(NamedProblem problem) { problems_.push_back(std::move(problem)); }
  void Add(DataReader reader) { readers_.push_back(std::move(reader)); }

  /// Moves all of it to the registries of the program, `path` being the plugin's. Empty and *names
  /// extended, or, with nothing registered, one sentence: a name that is taken or is none.
  std::string Commit(const std::string& path, std::vector<PluginName>* names);

 private:
  std::string WhyNot() const;
  std::string WhyNotOptions() const;

  std::vector<SolverEntry> solvers_;
  std::vector<CutRuleEntry> cut_rules_;
  std::vector<std::unique_ptr<Term>> terms_;
  std::vector<NamedProblem> problems_;
  std::vector<DataReader> readers_;
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_PLUGIN_REGISTRY_H_
