#include "experiments/report_bench.h"

#include <cmath>

#include "experiments/bench_results.h"

namespace batten {

BenchFacts ReadBenchFacts(const std::string& folder) {
  BenchFacts facts;
  BenchData data;
  std::string ignored;
  if (!ReadBenchData(folder, &data, &ignored)) return facts;
  const BenchResults results = CollectResults(data);
  for (const BenchTarget& target : results.targets) facts.targets.push_back(target.gap);
  for (const BenchRun& run : results.runs) {
    const BenchInstance& instance = results.instances[run.instance];
    for (const nlohmann::json* row : run.rows) {
      const std::string key = TextAt(*row, "key");
      if (instance.unit_seconds > 0.0) facts.unit_seconds[key] = instance.unit_seconds;
      if (std::isfinite(instance.truth_energy)) facts.truth[key] = instance.truth_energy;
      if (std::isfinite(instance.num_variables)) facts.num_variables[key] = instance.num_variables;
      if (std::isfinite(instance.start_energy)) facts.start[key] = instance.start_energy;
      if (!instance.has_basins || !std::isfinite(instance.minimum_energy)) continue;
      facts.best[key] = instance.minimum_energy;
      if (run.basin < 0) continue;
      facts.own[key] = instance.basin_energies[static_cast<std::size_t>(run.basin)];
      facts.basin[key] = run.basin + 1;
    }
  }
  return facts;
}

}  // namespace batten
