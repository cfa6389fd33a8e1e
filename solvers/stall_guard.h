#ifndef BATTEN_SOLVERS_STALL_GUARD_H_
#define BATTEN_SOLVERS_STALL_GUARD_H_

#include <limits>
#include <optional>
#include <vector>

#include "solvers/solver.h"

namespace batten {

/// Ends an iteration that goes on without coming nearer: its measure (the length of a residual or a
/// move) has had no new least value for kPatience iterations. Long enough for methods that rise for
/// a while, as those with momentum do for about the root of the condition number.
class StallGuard {
 public:
  static constexpr int kPatience = 1000;

  void Reset(int patience = kPatience) {
    *this = StallGuard();
    patience_ = patience;
  }
  /// Called once per iteration.
  std::optional<Outcome> Check(double measure) {
    if (measure < least_) {
      least_ = measure;
      waited_ = 0;
      return std::nullopt;
    }
    if (++waited_ < patience_) return std::nullopt;
    return Outcome{StopReason::kStalled, "no iteration of the last " + std::to_string(patience_) +
                                             " came nearer than the best before them"};
  }
  void AppendTo(std::vector<double>* state) const {
    state->push_back(least_);
    state->push_back(waited_);
  }
  /// The two numbers at `state`.
  void Restore(const double* state) {
    least_ = state[0];
    waited_ = static_cast<int>(state[1]);
  }

 private:
  double least_ = std::numeric_limits<double>::infinity();
  int waited_ = 0;
  int patience_ = kPatience;
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_STALL_GUARD_H_
