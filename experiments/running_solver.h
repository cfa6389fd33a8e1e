#ifndef BATTEN_EXPERIMENTS_RUNNING_SOLVER_H_
#define BATTEN_EXPERIMENTS_RUNNING_SOLVER_H_

#include <string>

namespace batten {

/// While it lives, `name` is what RunningSolverName() says: for the last words of a program that a
/// solver ends. One at a time counts, the last one made.
class RunningSolver {
 public:
  explicit RunningSolver(const std::string& name);
  ~RunningSolver();
  RunningSolver(const RunningSolver&) = delete;
  RunningSolver& operator=(const RunningSolver&) = delete;
};

/// Empty where none runs. May be asked in a signal handler.
const char* RunningSolverName();

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_RUNNING_SOLVER_H_
