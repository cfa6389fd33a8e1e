#ifndef BATTEN_EXPERIMENTS_REPLAY_H_
#define BATTEN_EXPERIMENTS_REPLAY_H_

#include <limits>
#include <string>
#include <vector>

#include "experiments/run.h"

namespace batten {

/// What one run of a solver asked for, in its order. Free variables, scaled as inside.
struct Tape {
  static constexpr std::size_t kNoPoint = std::numeric_limits<std::size_t>::max();
  struct Request {
    Evaluation kind = Evaluation::kEnergy;
    std::size_t point = kNoPoint;  ///< Index into points; Hessian products have none.
  };
  std::vector<Request> requests;
  /// Where E or its gradient was asked for; requests at one point that follow each other share it.
  std::vector<Eigen::VectorXd> points;
  RunResult run;

  int Count(Evaluation kind) const;
};

/// Runs `solver` once under run control, as Run() does, and records its tape. False with one
/// sentence in `error` for what Run() refuses, for a solver that does not apply, and for one whose
/// work a tape does not hold: Jacobians, projected parameters, or no evaluation of E or g.
bool RecordTape(const Problem& problem, const NameSpec& solver, const RunSpec& spec, Tape* tape,
                std::string* error);

/// Where the time of a run goes, in seconds of the wall; medians over runs. What is compiled when
/// it is first asked for belongs to evaluation.
struct TimeSplit {
  double run = 0.0;         ///< The solver under run control.
  double evaluation = 0.0;  ///< The tape's requests made again, with no solver.
  double solver = 0.0;      ///< Median of the differences of pairs: the solver's own work.
};

/// Runs the solver and replays its tape in turn, `repetitions` >= 1 times after a first time that
/// does not count. A product is replayed with another vector, which costs the same. False with one
/// sentence in `error` if a run ends elsewhere than the recorded one: it is not repeatable, and
/// its tape says nothing about it.
bool MeasureSplit(const Problem& problem, const Tape& tape, const RunSpec& spec, int repetitions,
                  TimeSplit* split, std::string* error);

/// Where two tapes part.
struct Parting {
  static constexpr std::size_t kNever = std::numeric_limits<std::size_t>::max();
  /// Index from 0 of the first points that differ by more than `tolerance` times the largest |x|
  /// of the first tape; 0: that are not the same bits. kNever: none in what both tapes have.
  std::size_t index = kNever;
  double tolerance = 0.0;
  double difference = 0.0;  ///< Largest |x - y| there, relative to that size.
};

/// Per point that both tapes have: largest |x - y| relative to the largest |x| of the first tape.
std::vector<double> Differences(const Tape& first, const Tape& second);

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
