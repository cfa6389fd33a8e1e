#ifndef BATTEN_TOOLS_STARTS_RUN_H_
#define BATTEN_TOOLS_STARTS_RUN_H_

#include <memory>
#include <string>
#include <vector>

#include "experiments/start_comparison.h"
#include "tools/command.h"

namespace batten {

/// `compare --starts`: every problem, `written` so by the user, from many starts. Writes
/// FOLDER/starts_solvers.csv, starts_basins_PROBLEM.csv and starts_runs.csv unless `folder` is
/// empty. Returns an exit status.
int RunStartComparisons(const std::vector<std::shared_ptr<const Problem>>& problems,
                        const std::vector<std::string>& written, StartComparisonSpec spec,
                        const std::string& folder, bool quiet, CommandOutput* output);

}  // namespace batten

#endif  // BATTEN_TOOLS_STARTS_RUN_H_
