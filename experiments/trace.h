#ifndef BATTEN_EXPERIMENTS_TRACE_H_
#define BATTEN_EXPERIMENTS_TRACE_H_

#include <string>
#include <vector>

namespace batten {

struct Counts {
  long energy_calls = 0;
  long gradient_calls = 0;
  long jacobian_calls = 0;
  long products = 0;
  long projections = 0;
  long distinct_points = 0;  ///< Points at which E or g was asked for, equal ones once.
};

/// One row per iteration; everything in the user's units.
struct TraceRow {
  int iteration = 0;
  Counts counts;
  double seconds = 0.0;  ///< Solver's wall time since the run began, set-up included.
  double cpu_seconds = 0.0;
  double energy = 0.0;
  double gradient_norm = 0.0;
  double step_norm = 0.0;  ///< Largest move of a control point (of a variable, if no curve fit).
  double violation = 0.0;  ///< By which nonlinear constraints are missed; 0 without any.
  std::vector<double> term_energies;  ///< Empty with a single term: it is the energy.
};

/// CSV with the header of docs/formats.md, the violation of constraints in it where the problem is
/// constrained; numbers read back to the same double.
std::string TraceCsv(const std::vector<TraceRow>& trace, const std::vector<std::string>& term_names,
                     bool is_constrained = false);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_TRACE_H_
