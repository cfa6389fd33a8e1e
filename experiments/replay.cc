#include "experiments/replay.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>

#include "experiments/comparison.h"
#include "problems/objective.h"

namespace batten {
namespace {

bool SameBits(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return a.size() == b.size() &&
         std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<std::size_t>(a.size())) == 0;
}

/// Writes down what a solver asks for. False for what a tape cannot hold, with its name: the run
/// ends in a refusal, and the rest of it would be work for nothing.
bool Record(Evaluation kind, const Eigen::VectorXd* x, Tape* tape, std::string* not_held) {
  if (kind == Evaluation::kJacobian) *not_held = "Jacobians";
  if (kind == Evaluation::kProjection) *not_held = "projections of parameters";
  Tape::Request request{kind, Tape::kNoPoint};
  if (kind == Evaluation::kEnergy || kind == Evaluation::kGradient) {
    if (x == nullptr) {
      *not_held = "evaluations at no known point";
    } else {
      if (tape->points.empty() || !SameBits(tape->points.back(), *x)) tape->points.push_back(*x);
      request.point = tape->points.size() - 1;
    }
  }
  tape->requests.push_back(request);
  return not_held->empty();
}

/// The tape's requests through an evaluator of their own: seconds of the wall.
double Replay(const Problem& problem, const Tape& tape, const RunSpec& spec) {
  Objective objective(&problem, nullptr, Objective::Options{spec.compile});
  double energy = 0.0;
  Eigen::VectorXd gradient;
  Eigen::VectorXd product;
  const std::vector<Tape::Request>& requests = tape.requests;
  const Eigen::VectorXd* x = &tape.points.front();
  const auto begin = std::chrono::steady_clock::now();
  for (std::size_t i = 0; i < requests.size(); ++i) {
    const Tape::Request& request = requests[i];
    if (request.point != Tape::kNoPoint) x = &tape.points[request.point];
    if (request.kind == Evaluation::kProduct) {
      objective.HessianTimes(*x, tape.points.front(), &product);
    } else if (request.kind == Evaluation::kGradient) {
      objective.Gradient(*x, &gradient);
    } else if (i + 1 < requests.size() && requests[i + 1].kind == Evaluation::kGradient &&
               requests[i + 1].point == request.point) {
      objective.EnergyAndGradient(*x, &energy, &gradient);
      ++i;
    } else {
      objective.Energy(*x, &energy);
    }
  }
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Of the largest |x| of a tape; 1 where all are zero.
double Size(const Tape& tape) {
  double size = 0.0;
  for (const Eigen::VectorXd& x : tape.points) size = std::max(size, x.cwiseAbs().maxCoeff());
  return size > 0.0 ? size : 1.0;
}

}  // namespace

int Tape::Count(Evaluation kind) const {
  return static_cast<int>(std::count_if(requests.begin(), requests.end(),
                                        [kind](const Request& r) { return r.kind == kind; }));
}

bool MeasureSplit(const Problem& problem, const Tape& tape, const RunSpec& spec, int repetitions,
                  TimeSplit* split, std::string* error) {
  std::vector<double> run, evaluation, solver;
  for (int i = 0; i <= repetitions; ++i) {
    RunResult result;
    if (!Run(problem, tape.run.solver, spec, &result, error)) return false;
    if (result.outcome.reason == StopReason::kInterrupted) break;
    const bool both_unknown = std::isnan(result.energy) && std::isnan(tape.run.energy);
    if ((result.energy != tape.run.energy && !both_unknown) ||
        result.iterations != tape.run.iterations) {
      *error = tape.run.solver.ToString() + " is not repeatable: after " +
               std::to_string(tape.run.iterations) +
               " iterations it was at E = " + NumberText(tape.run.energy) + ", now after " +
               std::to_string(result.iterations) + " at " + NumberText(result.energy);
      return false;
    }
    const double seconds = Replay(problem, tape, spec);
    if (i == 0) continue;
    run.push_back(result.seconds);
    evaluation.push_back(seconds);
    solver.push_back(result.seconds - seconds);
  }
  if (!run.empty()) *split = {Median(run), Median(evaluation), Median(solver)};
  return true;
}

bool RecordTape(const Problem& problem, const NameSpec& solver, const RunSpec& spec, Tape* tape,
                std::string* error) {
  *tape = Tape();
  std::string what;
  const EvaluationWatch record = [&](Evaluation kind, const Eigen::VectorXd* x) {
    return Record(kind, x, tape, &what);
  };
  if (!Run(problem, solver, spec, &tape->run, error, record)) return false;
  if (!tape->run.skipped.empty()) {
    *error = solver.ToString() + " does not apply: " + tape->run.skipped;
    return false;
  }
  if (what.empty() && tape->points.empty()) what = "no evaluation of E or its gradient";
  if (what.empty()) return true;
  *error = solver.ToString() + " makes " + what +
           "; a tape holds evaluations of E and its gradient and Hessian products";
  return false;
}

std::vector<double> Differences(const Tape& first, const Tape& second) {
  const double size = Size(first);
  std::vector<double> differences(std::min(first.points.size(), second.points.size()));
  for (std::size_t i = 0; i < differences.size(); ++i) {
    const Eigen::VectorXd step = first.points[i] - second.points[i];
    differences[i] = step.cwiseAbs().maxCoeff() / size;
  }
  return differences;
}

Parting FindParting(const Tape& first, const Tape& second, double tolerance) {
  Parting parting;
  parting.tolerance = tolerance;
  const std::vector<double> differences = Differences(first, second);
  for (std::size_t i = 0; i < differences.size(); ++i) {
    // Written so that NaN parts, too.
    const bool same = tolerance == 0.0 ? SameBits(first.points[i], second.points[i])
                                       : differences[i] <= tolerance;
    if (same) continue;
    parting.index = i;
    parting.difference = differences[i];
    return parting;
  }
  return parting;
}

ValueAtPoint EvaluateAt(const Problem& problem, const RunSpec& spec, const Eigen::VectorXd& x) {
  Objective objective(&problem, nullptr, Objective::Options{spec.compile});
  ValueAtPoint value;
  Eigen::VectorXd gradient;
  if (objective.EnergyAndGradient(x, &value.energy, &gradient) == Status::kOk) {
    value.gradient_norm = gradient.norm();
  }
  return value;
}

}  // namespace batten
