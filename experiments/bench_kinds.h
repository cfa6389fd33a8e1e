#ifndef BATTEN_EXPERIMENTS_BENCH_KINDS_H_
#define BATTEN_EXPERIMENTS_BENCH_KINDS_H_

#include <string>
#include <vector>

#include "experiments/bench_results.h"

namespace batten {

// Fits with fixed, free and projected parameters are different problems: what counts solvers over
// instances counts them by kind.

/// The kinds of parameters that instances have, in their order.
std::vector<std::string> ParameterKinds(const BenchResults& results);

/// Instances of one kind with their runs, and of the solvers those that apply to one of them; no
/// notes. Needs what `results` was collected from, as that does.
BenchResults OfKind(const BenchResults& results, const std::string& kind);

/// Some instance has no direct answer, so that runs may end in different minima.
bool HasBasins(const BenchResults& results);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_BENCH_KINDS_H_
