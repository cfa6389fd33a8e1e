#include <gflags/gflags.h>

#include <algorithm>

#include "experiments/replay.h"
#include "experiments/short_number.h"
#include "problems/catalogue.h"
#include "tools/command.h"
#include "tools/interrupts.h"
#include "tools/run_flags.h"

DECLARE_string(problem);
DECLARE_string(solver);
DEFINE_string(against, "",
              "A second solver: where the points at which the two evaluate part. Not given: "
              "the solver against itself.");

namespace batten {
namespace {

constexpr double kTolerances[] = {0.0, 1e-15, 1e-12, 1e-8};

bool OneSolver(const std::string& flag, const std::string& text, NameSpec* solver,
               std::string* error) {
  std::vector<NameSpec> solvers;
  if (!SolversFromFlag(flag, text, &solvers, error)) return false;
  if (solvers.size() == 1) {
    *solver = solvers.front();
    return true;
  }
  *error = RefusedFlag(flag, text, "one solver");
  return false;
}

std::string ValueText(const std::string& name, const ValueAtPoint& value) {
  return name + " E = " + ShortNumber(value.energy, 6) +
         ", |g| = " + ShortNumber(value.gradient_norm, 3);
}

std::string PartingText(const Problem& problem, const RunSpec& spec, const Tape& first,
                        const Tape& second) {
  const std::size_t shorter = std::min(first.points.size(), second.points.size());
  const bool is_equal_length = first.points.size() == second.points.size();
  std::string text;
  for (const double tolerance : kTolerances) {
    const Parting parting = FindParting(first, second, tolerance);
    const std::string measure =
        tolerance == 0.0 ? "bit for bit" : "to " + ShortNumber(tolerance, 1);
    if (parting.index == Parting::kNever) {
      text += (is_equal_length ? "the same " : "the same first ") + std::to_string(shorter) +
              " points, " + measure + "\n";
      if (tolerance == 0.0) return text;
      continue;
    }
    const Eigen::VectorXd& x = first.points[parting.index];
    const Eigen::VectorXd& y = second.points[parting.index];
    text += measure + ": part at evaluation " + std::to_string(parting.index + 1) + ", by " +
            ShortNumber(parting.difference, 3) + " of the largest |x|; " +
            ValueText("first", EvaluateAt(problem, spec, x)) + "; " +
            ValueText("second", EvaluateAt(problem, spec, y)) + "\n";
  }
  return text;
}

std::string TapeText(const Tape& tape) {
  return tape.run.solver.ToString() + ": " + std::to_string(tape.points.size()) + " points, " +
         ToString(tape.run.outcome.reason) + "\n";
}

int RunReplay(const std::vector<std::string>& positional, CommandOutput* output) {
  if (!positional.empty()) {
    return Refuse("replay: found " + positional.front() + "; allowed: flags, as in --problem=rhino",
                  output);
  }
  if (!WasGiven("problem")) {
    return Refuse("replay: found no --problem; allowed: a name of batten list problems", output);
  }
  std::string* const error = &output->error;
  NameSpec solver, other;
  CatalogueEntry entry;
  if (!OneSolver("solver", FLAGS_solver, &solver, error) ||
      !OneSolver("against", WasGiven("against") ? FLAGS_against : FLAGS_solver, &other, error)) {
    return kBadInput;
  }
  if (!FindProblem(FLAGS_problem, &entry, error)) {
    *error = "--problem: " + *error;
    return kBadInput;
  }
  const std::unique_ptr<Problem> problem = LoadProblem(entry, error);
  if (problem == nullptr) return kBadInput;
  const InterruptibleRun run;
  RunSpec spec = RunSpecFromFlags();
  spec.keep_trace = false;
  Tape first, second;
  const bool is_recorded = RecordTape(*problem, solver, spec, &first, error) &&
                           !InterruptRequested() &&
                           RecordTape(*problem, other, spec, &second, error);
  if (InterruptRequested()) return kInterruptedStatus;
  if (!is_recorded) return kBadInput;
  output->results = TapeText(first) + TapeText(second) + PartingText(*problem, spec, first, second);
  return kDone;
}

}  // namespace

Command ReplayCommand() {
  Command command;
  command.name = "replay";
  command.summary = "finds the first evaluation where two solvers part";
  command.details = {
      "Runs both solvers on the problem, records the points at which each asks for E or its "
      "gradient, and tells where these are first not the same, bit for bit and by more than "
      "1e-15, 1e-12 and 1e-8 of the largest |x|. E and |g| at the two points are evaluated "
      "afterwards, scaled as inside. Without --against the solver is run twice: one that parts "
      "from itself is not repeatable.",
      "Solvers that ask for more than E and its gradient are refused, with what they ask for."};
  command.examples = {
      "batten replay --problem=rhino --solver=lbfgs --against=ceres_lbfgs --nocompile",
      "batten replay --problem=rhino --solver=ceres_lbfgs --against=ceres_lbfgs/form=problem "
      "--nocompile"};
  command.flags = {
      TextFlag("problem", "NAME", "a name of batten list problems, a problem file",
               "A problem of the catalogue (batten list problems) or a problem file."),
      TextFlag("solver", "SOLVER", "a solver of batten list solvers, with options or without"),
      TextFlag("against", "SOLVER", "a solver of batten list solvers, with options or without")};
  for (FlagInfo& flag : RunFlags()) command.flags.push_back(std::move(flag));
  command.run = &RunReplay;
  return command;
}

}  // namespace batten
