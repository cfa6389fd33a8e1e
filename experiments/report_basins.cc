#include "experiments/report_basins.h"

#include <cmath>

#include "experiments/bench_results.h"

namespace batten {

BasinMinima ReadBasinMinima(const std::string& folder) {
  BasinMinima minima;
  BenchData data;
  std::string ignored;
  if (!ReadBenchData(folder, &data, &ignored)) return minima;
  const BenchResults results = CollectResults(data);
  for (const BenchRun& run : results.runs) {
    const BenchInstance& instance = results.instances[run.instance];
    if (!instance.has_basins || !std::isfinite(instance.minimum_energy)) continue;
    for (const nlohmann::json* row : run.rows) {
      const std::string key = TextAt(*row, "key");
      minima.best[key] = instance.minimum_energy;
      if (run.basin < 0) continue;
      minima.own[key] = instance.basin_energies[static_cast<std::size_t>(run.basin)];
    }
  }
  return minima;
}

}  // namespace batten
