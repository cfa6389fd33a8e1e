#ifndef BATTEN_SOLVERS_C_SOLVER_H_
#define BATTEN_SOLVERS_C_SOLVER_H_

#include <string>

#include "solvers/batten_c.h"
#include "solvers/plugin_registry.h"

namespace batten {

/// Calls a C plugin's register function and adds its solvers to `registry`. Empty, or one sentence:
/// a solver that is announced wrongly.
std::string RegisterCSolvers(void (*add)(const batten_host*), PluginRegistry* registry);

}  // namespace batten

#endif  // BATTEN_SOLVERS_C_SOLVER_H_
