#ifndef BATTEN_SOLVERS_LINE_SEARCH_H_
#define BATTEN_SOLVERS_LINE_SEARCH_H_

#include "cost_functions/block_family.h"

namespace batten {

/// phi(a) = E(x + a d) seen from a = 0: only differences, so that nothing cancels where the
/// objective can give them exactly.
struct LinePoint {
  double step = 0.0;    // a
  double change = 0.0;  // phi(a) - phi(0)
  double slope = 0.0;   // phi'(a)
};

class LineFunction {
 public:
  virtual ~LineFunction() = default;
  /// Fills change and slope at point->step > 0. kNonFinite: no value there.
  virtual Status Evaluate(LinePoint* point) = 0;
};

struct WolfeOptions {
  bool strong = false;                // |slope| bounded, not only from below
  double sufficient_decrease = 1e-4;  // c1
  double curvature = 0.9;             // c2, c1 < c2 < 1
  /// Changes of this size are rounding noise: below it the slopes alone decide (approximate Wolfe
  /// conditions, Hager and Zhang, SIAM J. Optim. 16, 2005, eq. 4.1).
  double noise = 0.0;
  int max_evaluations = 40;
};

enum class LineSearchEnd { kFound, kNoStep, kStopped };

/// Finds a step that meets the Wolfe conditions,
///   phi(a) <= phi(0) + c1 a phi'(0),  phi'(a) >= c2 phi'(0)  (strong: |phi'(a)| <= c2 |phi'(0)|),
/// by bracketing and safeguarded cubic interpolation (Nocedal & Wright, sec. 3.5). slope_at_zero <
/// 0. kNoStep: rounding leaves no such step. kStopped: run control said so.
LineSearchEnd SearchWolfe(const WolfeOptions& options, double slope_at_zero, double first_step,
                          LineFunction* function, LinePoint* found);

}  // namespace batten

#endif  // BATTEN_SOLVERS_LINE_SEARCH_H_
