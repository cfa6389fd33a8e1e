#ifndef BATTEN_EXPERIMENTS_RUN_H_
#define BATTEN_EXPERIMENTS_RUN_H_

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "cost_functions/options.h"
#include "experiments/trace.h"
#include "problems/evaluation_monitor.h"
#include "problems/problem.h"
#include "solvers/solver.h"

namespace batten {

/// race: one rule for all, applied outside. native: each method stops as its authors do.
enum class Mode { kRace, kNative };
const char* ToString(Mode mode);
bool FromString(const std::string& text, Mode* mode);

struct RunSpec {
  Mode mode = Mode::kRace;
  /// race: stop when |g| <= gradient_tolerance * |g(start)|; 0: at the rounding floor only.
  double gradient_tolerance = 1e-10;
  int max_iterations = 10000;  ///< >= 0
  double max_seconds = 60.0;   ///< > 0, of the solver's own wall time.
  /// native, absolute, in the user's units.
  double native_step = 1e-6;
  double native_gradient = 1e-6;
  std::uint64_t seed = 1;
  int threads = 1;
  bool compile = true;  ///< False: all evaluations through the autodiff functors.
  bool keep_trace = true;
  bool keep_iterates = false;
  /// Warm start: all variables, scaled as inside. Empty: the problem's own start.
  Eigen::VectorXd start;
  /// Called off the clock at iterations; may be empty.
  std::function<void(const TraceRow&)> progress;
};

struct Iterate {
  int iteration = 0;
  Eigen::VectorXd x;  ///< All variables, scaled as inside.
};

/// What one run gave; energies, gradients and steps in the user's units. Under nonlinear
/// constraints gradients are those of the Lagrangian, its multipliers the ones that make it least.
struct RunResult {
  NameSpec solver;
  std::map<std::string, std::string> options;  ///< As really used.
  std::string skipped;                         ///< Not empty: the solver does not apply, and why.
  Outcome outcome;
  Eigen::VectorXd x;  ///< All variables, scaled as inside.
  int iterations = 0;
  Counts counts;
  double setup_seconds = 0.0;  ///< Until iteration 0 was booked.
  double seconds = 0.0;        ///< All of the solver's wall time.
  double cpu_seconds = 0.0;
  double start_energy = 0.0;
  double start_gradient_norm = 0.0;
  double energy = 0.0;
  double gradient_norm = 0.0;
  double gradient_floor = 0.0;  ///< Rounding floor of |g|.
  /// |g| below which a step along -g no longer lowers E by more than its rounding. Known where a
  /// line search or a library ended the run, else 0.
  double line_search_floor = 0.0;
  /// By which nonlinear constraints are missed at the end, in the user's units; 0 without any.
  double violation = 0.0;
  double observed_rate = 0.0;  ///< Factor of |g| per iteration near the end; NaN: none.
  /// Of the points at which it evaluated and which it booked, in their order, equal ones that
  /// follow each other once: two solvers with one hash and count are one method.
  std::uint64_t stream_hash = 0;
  long stream_points = 0;
  /// The hashes after 4, 8, 16, ... points: what two runs have in common where limits cut one.
  std::vector<std::uint64_t> stream_prefixes;
  long calls_past_stop = 0;  ///< Evaluations and iterations after it was told to stop.
  std::vector<std::pair<std::string, std::string>> notes;
  std::vector<TraceRow> trace;
  std::vector<Iterate> iterates;
};

/// Told of each evaluation that run control has allowed, as EvaluationMonitor is. False: it is not
/// done, and the solver is to end.
using EvaluationWatch = std::function<bool(Evaluation kind, const Eigen::VectorXd* x)>;

/// Runs one solver from the problem's start under run control. False with one sentence in `error`
/// for an unknown solver or option; a solver that does not apply is a result with `skipped`, one
/// that throws an exception, but for want of memory, is one with kNumericalFailure. `watch`, if
/// there is one, is on the solver's clock.
bool Run(const Problem& problem, const NameSpec& solver, const RunSpec& spec, RunResult* result,
         std::string* error, const EvaluationWatch& watch = nullptr);

/// From the interrupt handler: every run ends at its next evaluation with kInterrupted.
void RequestInterrupt();
bool InterruptRequested();

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_RUN_H_
