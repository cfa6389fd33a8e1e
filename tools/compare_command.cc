#include <gflags/gflags.h>

#include <map>
#include <set>
#include <string>
#include <tuple>

#include "solvers/solver_registry.h"
#include "tools/command.h"
#include "tools/comparison_session.h"
#include "tools/run_flags.h"
#include "tools/starts_run.h"

DEFINE_string(problems, "rhino,squirrel,dolphin,cat",
              "Problems of the catalogue (batten list problems) or problem files, separated by "
              "commas; all among them: the whole catalogue.");
DEFINE_string(solvers, "all",
              "Solvers with their options, separated by commas, as in lbfgs/memory=5,cg; all among "
              "them: every registered one, with its defaults.");
DEFINE_int32(repetitions, batten::ComparisonSpec().repetitions,
             "Runs of each solver, interleaved; times are medians.");
DEFINE_int32(
    starts, 0,
    "Problems whose E may have several minima: how often each solver finds which minimum "
    "from so many disturbed circles, and how many of its curves have loops, instead of the "
    "usual table.");
DEFINE_int32(
    keep_iterates, 0,
    "So many iterates of each run are kept, or all where it has no more, for the player of batten "
    "report; none where all of a run's, at --max_iterations, would need more than 256 MiB.");
DEFINE_bool(strict, false, "Exit status 1 if some solver did not reach what was asked.");
DEFINE_bool(figures, true,
            "Draw the results with gnuplot: convergence and fitted curves of compare, profiles and "
            "distributions of bench.");
DEFINE_bool(
    resume, false,
    "Take over the problems that an earlier run into the same folder has finished, as far as "
    "program, problem, data, solvers and rule are the same.");

namespace batten {
namespace {

bool ProblemNames(std::vector<std::string>* names, std::string* error) {
  for (const std::string& name : SplitAtCommas(FLAGS_problems)) {
    if (name != "all") {
      names->push_back(name);
      continue;
    }
    std::vector<std::string> catalogue;
    if (!ListCatalogue(&catalogue, error)) return false;
    names->insert(names->end(), catalogue.begin(), catalogue.end());
  }
  return true;
}

bool FindContests(std::vector<Contest>* contests, std::string* error) {
  std::vector<std::string> names;
  if (!ProblemNames(&names, error)) return false;
  for (const std::string& name : names) {
    Contest contest;
    contest.written = name;
    if (!FindProblem(name, &contest.entry, error)) {
      *error = "--problems: " + *error;
      return false;
    }
    contest.problem = LoadProblem(contest.entry, error);
    if (contest.problem == nullptr) return false;
    for (const Contest& other : *contests) {
      if (other.entry.name != contest.entry.name) continue;
      *error = RefusedFlag("problems", contest.entry.name + " twice", "each problem once");
      return false;
    }
    contests->push_back(std::move(contest));
  }
  return true;
}

bool CheckSolvers(const std::vector<NameSpec>& solvers, std::string* error) {
  // By what they mean: lbfgs is lbfgs/memory=10.
  std::set<std::tuple<std::string, std::map<std::string, std::string>, std::string>> meanings;
  for (const NameSpec& solver : solvers) {
    OptionValues options;
    if (SolverRegistry::Global().Make(solver, &options, error) == nullptr) return false;
    const std::string wrapped = solver.wrapped == nullptr ? "" : solver.wrapped->ToString();
    if (meanings.emplace(solver.name, options.ToText(), wrapped).second) continue;
    *error = RefusedFlag("solvers", solver.ToString() + " twice", "each solver once");
    return false;
  }
  return true;
}

int RunCompare(const std::vector<std::string>& positional, CommandOutput* output) {
  if (!positional.empty()) {
    return Refuse("compare: found " + positional.front() +
                      "; allowed: flags, as in --problems=" + FLAGS_problems,
                  output);
  }
  std::string* const error = &output->error;
  if (!CheckRunFlags(error)) return kBadInput;
  ComparisonSpec spec;
  spec.run = RunSpecFromFlags();
  spec.repetitions = FLAGS_repetitions;
  std::vector<Contest> contests;
  if (!SolversFromFlag("solvers", FLAGS_solvers, &spec.solvers, error) ||
      !CheckSolvers(spec.solvers, error) || !FindContests(&contests, error)) {
    return kBadInput;
  }
  if (FLAGS_resume && !WasGiven("out")) {
    return Refuse("--resume: found without --out; allowed: with the folder to go on in", output);
  }
  if (FLAGS_keep_iterates > 0 && (!WasGiven("out") || WasGiven("starts"))) {
    return Refuse("--keep_iterates: found " +
                      std::string(WasGiven("out") ? "with --starts" : "without --out") +
                      "; allowed: with the folder to keep them in, without --starts",
                  output);
  }
  spec.kept_iterates = FLAGS_keep_iterates;
  if (WasGiven("starts")) {
    std::vector<std::shared_ptr<const Problem>> problems;
    std::vector<std::string> written;
    for (const Contest& contest : contests) {
      problems.push_back(contest.problem);
      written.push_back(contest.written);
    }
    StartComparisonSpec starts;
    starts.solvers = spec.solvers;
    starts.run = spec.run;
    starts.run.keep_trace = false;
    starts.starts = FLAGS_starts;
    return RunStartComparisons(problems, written, std::move(starts), FLAGS_out, FLAGS_quiet,
                               output);
  }
  for (const Contest& contest : contests) spec.problems.push_back(contest.written);
  ComparisonSession session(std::move(contests), std::move(spec),
                            {FLAGS_out, FLAGS_figures, FLAGS_resume, FLAGS_strict, FLAGS_quiet});
  if (!session.Prepare(error)) return kBadInput;
  return session.Run(output);
}

}  // namespace

Command CompareCommand() {
  Command command;
  command.name = "compare";
  command.summary = "runs solvers on problems and prints one table";
  command.details = {
      "Writes OUT/table.csv, .json, .md and .tex, OUT/cells.jsonl (one row per problem and solver, "
      "written as each problem is finished), the trace of each run in OUT/traces, and for each "
      "problem OUT/PROBLEM_convergence and "
      "OUT/PROBLEM_fit: .svg with the gnuplot script (.gp) and the data (.dat) behind it. Rows are "
      "explained in docs/formats.md. Lengths are in the unit of the data, E in its square.",
      "Exit status 3: a claim failed its audit, or solvers that must agree do not. A solver that "
      "fails is a row, and counts only with --strict. Without gnuplot the status is 2, unless "
      "--nofigures is given; all but the pictures is written."};
  command.examples = {
      "batten compare --problems=rhino,squirrel,dolphin,cat --solvers=all --out=out/compare",
      "batten compare --problems=rhino --solvers=lbfgs/memory=5,cg --repetitions=1",
      "batten compare --problems=rhino_free --solvers=foot_newton,newton,anderson:pdm "
      "--starts=100"};
  command.flags = {
      TextFlag("problems", "LIST",
               "names of batten list problems, problem files, all; separated by commas"),
      TextFlag("solvers", "LIST", "solvers of batten list solvers, all; separated by commas"),
      NumberFlag("repetitions", "N", 1.0, 1000.0), NumberFlag("starts", "N", 1.0, 100'000.0),
      NumberFlag("keep_iterates", "N", 0.0, 1e9)};
  for (FlagInfo& flag : RunFlags()) command.flags.push_back(std::move(flag));
  command.flags.push_back(
      TextFlag("out", "FOLDER", "a folder",
               "Folder for tables and figures, created if missing. Not given: only the "
               "table is printed."));
  for (const char* name : {"figures", "resume", "strict", "quiet"}) {
    command.flags.push_back(SwitchFlag(name));
  }
  command.run = &RunCompare;
  return command;
}

}  // namespace batten
