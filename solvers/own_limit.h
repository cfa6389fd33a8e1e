#ifndef BATTEN_SOLVERS_OWN_LIMIT_H_
#define BATTEN_SOLVERS_OWN_LIMIT_H_

#include <Eigen/Core>
#include <limits>
#include <vector>

namespace batten {

/// Ends an iteration whose limit is not the minimum of E, so that |g| does not vanish there: the
/// race's rule, put to its own moves.
class OwnLimit {
 public:
  void Reset() { first_move_ = -1.0; }
  /// Called once per iteration, with the length of the move from x: whether that is 1e-10 of the
  /// first one, or the rounding of x.
  bool Reached(double move, const Eigen::VectorXd& x) {
    constexpr double kSmall = 1e-10;
    const double rounding = std::numeric_limits<double>::epsilon() * x.norm();
    if (first_move_ < 0.0) first_move_ = move;
    return move <= kSmall * first_move_ || move <= rounding;
  }
  void AppendTo(std::vector<double>* state) const { state->push_back(first_move_); }
  /// The number at `state`.
  void Restore(const double* state) { first_move_ = *state; }

 private:
  double first_move_ = -1.0;  // below 0: none yet
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_OWN_LIMIT_H_
