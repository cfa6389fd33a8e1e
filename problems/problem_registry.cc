#include "problems/problem_registry.h"

#include <glog/logging.h>

namespace batten {

ProblemRegistry& ProblemRegistry::Global() {
  static ProblemRegistry& registry = *new ProblemRegistry;
  return registry;
}

void ProblemRegistry::Register(NamedProblem problem) {
  const std::string name = problem.name;
  CHECK(problems_.emplace(name, std::move(problem)).second) << "two problems are named " << name;
}

std::vector<std::string> ProblemRegistry::Names() const {
  std::vector<std::string> names;
  for (const auto& [name, problem] : problems_) names.push_back(name);
  return names;
}

const NamedProblem* ProblemRegistry::Find(const std::string& name) const {
  const auto found = problems_.find(name);
  return found == problems_.end() ? nullptr : &found->second;
}

}  // namespace batten
