#ifndef BATTEN_EXPERIMENTS_SPARSE_RUN_H_
#define BATTEN_EXPERIMENTS_SPARSE_RUN_H_

#include <cstddef>
#include <string>

#include "experiments/run.h"

namespace batten {

/// As Run(); of the iterates the result holds, at any time, at most `most` >= 2, the first and the
/// last among them, spread geometrically over the iterations (LeastMissed). With 0 for `most` it
/// holds all or none, as `spec.keep_iterates` says.
bool RunKeepingSome(const Problem& problem, const NameSpec& solver, const RunSpec& spec,
                    std::size_t most, RunResult* result, std::string* error);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_SPARSE_RUN_H_
