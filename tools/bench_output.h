#ifndef BATTEN_TOOLS_BENCH_OUTPUT_H_
#define BATTEN_TOOLS_BENCH_OUTPUT_H_

#include <string>

#include "tools/command.h"

namespace batten {

/// Tables, notes and, if wanted, figures of a folder of `bench` or `merge`, from its rows and
/// traces alone; says in output->results what there is. An exit status: 3 where a claim failed or
/// solvers disagree, 1 if `strict` and some run did not reach what was asked.
int WriteBenchResults(const std::string& folder, bool figures, bool strict, CommandOutput* output);

}  // namespace batten

#endif  // BATTEN_TOOLS_BENCH_OUTPUT_H_
