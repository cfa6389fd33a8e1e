#ifndef BATTEN_EXPERIMENTS_REPLAY_H_
#define BATTEN_EXPERIMENTS_REPLAY_H_

#include <limits>
#include <string>
#include <vector>

#include "experiments/run.h"

namespace batten {

/// The points at which one run of a solver asked for E or its gradient, in their order; requests
/// at one point that follow each other are one. Free variables, scaled as inside.
struct Tape {
  std::vector<Eigen::VectorXd> points;
  RunResult run;
};

/// Runs `solver` once under run control, as Run() does, and records its tape. False with one
/// sentence in `error` for what Run() refuses, for a solver that does not apply, and for one whose
/// work a tape does not hold: Jacobians, Hessian products, projected parameters, or no evaluation.
bool RecordTape(const Problem& problem, const NameSpec& solver, const RunSpec& spec, Tape* tape,
                std::string* error);

/// Where two tapes part.
struct Parting {
  static constexpr std::size_t kNever = std::numeric_limits<std::size_t>::max();
  /// Index from 0 of the first points that differ by more than `tolerance` times the largest |x|
  /// of the first tape; 0: that are not the same bits. kNever: none in what both tapes have.
  std::size_t index = kNever;
  double tolerance = 0.0;
  double difference = 0.0;  ///< Largest |x - y| there, relative to that size.
};

/// `tolerance` >= 0. The points of one tape are all of one size, which both tapes share.
Parting FindParting(const Tape& first, const Tape& second, double tolerance);

/// E and |g| at a point of a tape, as the problem evaluates them, in the units inside.
struct ValueAtPoint {
  double energy = std::numeric_limits<double>::quiet_NaN();
  double gradient_norm = std::numeric_limits<double>::quiet_NaN();
};
ValueAtPoint EvaluateAt(const Problem& problem, const RunSpec& spec, const Eigen::VectorXd& x);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_REPLAY_H_
