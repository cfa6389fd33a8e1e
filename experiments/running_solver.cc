#include "experiments/running_solver.h"

#include <cstring>

namespace batten {
namespace {

// No std::string: a signal handler may come while one is being changed.
char running_name[200] = "";

}  // namespace

RunningSolver::RunningSolver(const std::string& name) {
  std::strncpy(running_name, name.c_str(), sizeof(running_name) - 1);
}

RunningSolver::~RunningSolver() { running_name[0] = '\0'; }

const char* RunningSolverName() { return running_name; }

}  // namespace batten
