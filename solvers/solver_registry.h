#ifndef BATTEN_SOLVERS_SOLVER_REGISTRY_H_
#define BATTEN_SOLVERS_SOLVER_REGISTRY_H_

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "solvers/solver.h"

namespace batten {

/// One registered solver: what it is, and how an object for one run is made. `base` is the wrapped
/// solver of NAME:BASE, null for the others.
struct SolverEntry {
  SolverInfo info;
  std::function<std::unique_ptr<Solver>(const OptionValues& options, std::unique_ptr<Solver> base)>
      make;
};

/// The row of a solver class with `static SolverInfo ClassInfo()` and a constructor from options.
template <typename SolverClass>
SolverEntry MakeSolverEntry() {
  return {SolverClass::ClassInfo(), [](const OptionValues& options, std::unique_ptr<Solver>) {
            return std::make_unique<SolverClass>(options);
          }};
}

/// All registered solvers, by name; built-in ones come from the table in solver_registry.cc.
class SolverRegistry {
 public:
  static SolverRegistry& Global();
  void Register(SolverEntry entry);
  void Remove(const std::string& name);  ///< For solvers that come and go, as in tests.
  std::vector<std::string> Names() const;
  const SolverInfo* Find(const std::string& name) const;  ///< Null for an unknown name.
  /// What "all solvers" means by a known name: with its usual base where it wraps a solver.
  std::string UsualName(const std::string& name) const;
  /// A solver for one run and the options it really uses (of the outermost one); null with one
  /// sentence in `error`. `options_used` may be null.
  std::unique_ptr<Solver> Make(const NameSpec& spec, OptionValues* options_used,
                               std::string* error) const;

 private:
  std::map<std::string, SolverEntry> entries_;
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_SOLVER_REGISTRY_H_
