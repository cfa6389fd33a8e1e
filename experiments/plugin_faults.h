#ifndef BATTEN_EXPERIMENTS_PLUGIN_FAULTS_H_
#define BATTEN_EXPERIMENTS_PLUGIN_FAULTS_H_

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiments/run.h"

namespace batten {

// What `batten check` asks of a plugin at length, asked in short of the run at hand.

/// Whether the solver, or one that it wraps, is a plugin's.
bool IsOfPlugin(const NameSpec& solver);

/// Whether one of them is a plugin's.
bool HasTermOfPlugin(const std::vector<NameSpec>& terms);

/// Tries `work`, which calls code of a plugin, in a process of its own. Empty: it returned, or no
/// process can be made; else how it ended: "ended by signal 11 (Segmentation fault)", "killed after
/// 10 s of wall time".
std::string WhyNoReturn(const std::function<void()>& work);

/// Terms of plugins, as the problem names them, whose gradient is not that of their E near one of
/// `points` (all variables, scaled as inside): along two directions the Taylor remainder does not
/// fall with the square of the step. Some fifty evaluations of such a term per point; nothing if
/// they would take more than `max_seconds`.
std::optional<std::vector<std::string>> TermsWithWrongGradient(
    const Problem& problem, const std::vector<Eigen::VectorXd>& points, double max_seconds);

/// Whether what stands behind the end of x changes the first iterates of `solver`, or reading it
/// ends the program; tried in a process of its own. Nothing where it cannot be tried, takes longer
/// than `max_seconds` or gives other iterates each time.
std::optional<bool> ReadsPastX(const Problem& problem, const NameSpec& solver, const RunSpec& spec,
                               double max_seconds);

/// How many evaluations and iterates `solver` asks for after it was told to stop at its first
/// iterate behind the start, or at its fourth evaluation, whichever are more; tried in a process of
/// its own. Nothing where it cannot be tried or takes longer than `max_seconds`.
std::optional<int> CallsPastStop(const Problem& problem, const NameSpec& solver,
                                 const RunSpec& spec, double max_seconds);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_PLUGIN_FAULTS_H_
