#ifndef BATTEN_EXPERIMENTS_CONFORMANCE_H_
#define BATTEN_EXPERIMENTS_CONFORMANCE_H_

#include <functional>
#include <string>
#include <vector>

namespace batten {

/// What one check found. `detail` is one sentence or a few numbers, in either case.
struct CheckVerdict {
  bool passed = true;
  std::string detail;
};

inline CheckVerdict Failed(const std::string& detail) { return {false, detail}; }
/// Behind a sentence: the fit in which it was found.
inline std::string InText(const std::string& where) { return " (" + where + ")"; }

/// One check of the conformance suite. It runs what is checked, which may crash, hang or eat the
/// memory: the caller runs it in a process of its own with limits.
struct ConformanceCheck {
  std::string name;  ///< "gradient".
  std::string what;  ///< What is asked for, in one line.
  std::function<CheckVerdict()> run;
};

/// A word of an option often makes another method: what of a solver is checked.
enum class SolverVariants { kUsual, kEachWord };

/// The checks of a registered solver: docs/plugins.md says what each asks for.
std::vector<ConformanceCheck> SolverChecks(const std::string& registered, SolverVariants which);
/// The same of a registered term.
std::vector<ConformanceCheck> TermChecks(const std::string& registered);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_CONFORMANCE_H_
