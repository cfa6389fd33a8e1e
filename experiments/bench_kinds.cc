#include "experiments/bench_kinds.h"

#include <algorithm>
#include <map>

namespace batten {

std::vector<std::string> ParameterKinds(const BenchResults& results) {
  std::vector<std::string> kinds;
  for (const BenchInstance& instance : results.instances) {
    if (std::find(kinds.begin(), kinds.end(), instance.kind) == kinds.end()) {
      kinds.push_back(instance.kind);
    }
  }
  return kinds;
}

BenchResults OfKind(const BenchResults& results, const std::string& kind) {
  BenchResults part;
  part.suite = results.suite;
  part.targets = results.targets;
  part.overlapped = results.overlapped;
  std::map<std::size_t, std::size_t> instances, solvers;  // old to new places
  for (std::size_t i = 0; i < results.instances.size(); ++i) {
    if (results.instances[i].kind != kind) continue;
    instances[i] = part.instances.size();
    part.instances.push_back(results.instances[i]);
  }
  std::vector<bool> applies(results.solvers.size(), false);
  for (const BenchRun& run : results.runs) {
    if (instances.count(run.instance) > 0 && TextAt(*run.first, "stop") != "skipped") {
      applies[run.solver] = true;
    }
  }
  for (std::size_t s = 0; s < applies.size(); ++s) {
    if (!applies[s]) continue;
    solvers[s] = part.solvers.size();
    part.solvers.push_back(results.solvers[s]);
  }
  for (const BenchRun& run : results.runs) {
    if (instances.count(run.instance) == 0 || !applies[run.solver]) continue;
    part.runs.push_back(run);
    part.runs.back().instance = instances[run.instance];
    part.runs.back().solver = solvers[run.solver];
  }
  return part;
}

bool HasBasins(const BenchResults& results) {
  return std::any_of(results.instances.begin(), results.instances.end(),
                     [](const BenchInstance& instance) { return instance.has_basins; });
}

}  // namespace batten
