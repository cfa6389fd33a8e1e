#include <gflags/gflags.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "experiments/atomic_file.h"
#include "experiments/comparison.h"
#include "experiments/comparison_tables.h"
#include "experiments/figures.h"
#include "tools/command.h"
#include "tools/comparison_cells.h"
#include "tools/fit_summary.h"
#include "tools/interrupts.h"
#include "tools/output_files.h"
#include "tools/progress.h"
#include "tools/run_flags.h"

DEFINE_string(problems, "rhino,squirrel,dolphin,cat",
              "Problems of the catalogue (batten list problems) or problem files, separated by "
              "commas; all: the whole catalogue.");
DEFINE_string(
    solvers, "all",
    "Solvers with their options, separated by commas, as in lbfgs/memory=5,cg; all: every "
    "registered one, with its defaults.");
DEFINE_int32(repetitions, batten::ComparisonSpec().repetitions,
             "Runs of each solver, interleaved; times are medians.");
DEFINE_bool(strict, false, "Exit status 1 if some solver did not reach what was asked.");
DEFINE_bool(figures, true, "Draw convergence and fitted curves with gnuplot.");
DEFINE_bool(
    resume, false,
    "Take over the problems that an earlier run into the same folder has finished, as far as "
    "program, problem, data, solvers and rule are the same.");

namespace batten {
namespace {

/// A problem to compare on, checked before anything runs.
struct Contest {
  std::string written;  // name or path, by the user
  CatalogueEntry entry;
  std::shared_ptr<const Problem> problem;
};

std::string InFolder(const std::string& name) {
  return (std::filesystem::path(FLAGS_out) / name).string();
}

const std::vector<std::string> kTableEndings = {"csv", "json", "md", "tex"};
const std::vector<std::string> kFigureEndings = {"svg", "gp", "dat"};

std::vector<std::string> FigureFiles(const std::string& problem) {
  std::vector<std::string> files;
  for (const char* kind : {"_convergence.", "_fit."}) {
    for (const std::string& ending : kFigureEndings) {
      files.push_back(InFolder(problem + kind + ending));
    }
  }
  return files;
}

bool FindContests(std::vector<Contest>* contests, std::string* error) {
  const bool all = FLAGS_problems == "all";
  for (const std::string& name : all ? CatalogueNames() : SplitAtCommas(FLAGS_problems)) {
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
  for (size_t i = 0; i < solvers.size(); ++i) {
    for (size_t j = 0; j < i; ++j) {
      if (solvers[i].ToString() != solvers[j].ToString()) continue;
      *error = RefusedFlag("solvers", solvers[i].ToString() + " twice", "each solver once");
      return false;
    }
  }
  return true;
}

bool PrepareFolder(const std::vector<Contest>& contests, std::string* error) {
  if (!CreateDirectories(FLAGS_out, error)) {
    *error = "--out: " + *error;
    return false;
  }
  std::vector<OutputFile> outputs = {{"out", InFolder("cells.jsonl")}};
  for (const std::string& ending : kTableEndings) {
    outputs.push_back({"out", InFolder("table." + ending)});
  }
  std::vector<std::string> inputs;
  for (const Contest& contest : contests) {
    inputs.insert(inputs.end(), {contest.entry.path, contest.entry.data_path});
    if (!FLAGS_figures) continue;
    for (const std::string& file : FigureFiles(contest.entry.name))
      outputs.push_back({"out", file});
  }
  return CheckOutputs(outputs, inputs, error);
}

/// The comparison, problem by problem, so that what is finished is written.
class Comparison {
 public:
  Comparison(std::vector<Contest> contests, ComparisonSpec spec)
      : contests_(std::move(contests)), spec_(std::move(spec)), cells_(InFolder("cells.jsonl")) {}

  /// An exit status.
  int Run(CommandOutput* output);

 private:
  bool RunOne(size_t index, Progress* progress, ComparisonResult* result, std::string* error);
  bool HasFigures(const std::string& problem) const;
  void Add(size_t index, ComparisonResult result);
  bool WriteFigures(const ComparisonResult& result, std::string* error);
  bool WriteTables(std::string* error);
  int Judge(CommandOutput* output) const;

  std::vector<Contest> contests_;
  ComparisonSpec spec_;
  ComparisonCells cells_;
  ComparisonResult all_;
  std::vector<std::string> written_;
};

int Comparison::Run(CommandOutput* output) {
  const bool writes = WasGiven("out");
  if (writes && FLAGS_resume) cells_.Read();
  all_.spec = spec_;
  Progress progress(FLAGS_quiet);
  for (size_t i = 0; i < contests_.size(); ++i) {
    const CatalogueEntry& entry = contests_[i].entry;
    ComparisonResult result;
    const bool is_finished = writes && FLAGS_resume && (!FLAGS_figures || HasFigures(entry.name)) &&
                             cells_.Find(entry, spec_, &result);
    if (!is_finished) {
      if (!RunOne(i, &progress, &result, &output->error)) return kBadInput;
      if (result.interrupted) {
        output->error = "interrupted after " + std::to_string(i) + " of " +
                        std::to_string(contests_.size()) + " problems" +
                        (writes && i > 0 ? "; go on with --resume" : "");
        return kInterruptedStatus;
      }
      // The rows come last: a problem that has them has its figures.
      if (writes && FLAGS_figures && !WriteFigures(result, &output->error)) return kBadInput;
      if (writes && !cells_.Append(entry, result, &output->error)) return kBadInput;
    }
    Add(i, std::move(result));
  }
  if (writes && !WriteTables(&output->error)) return kBadInput;
  output->results = ComparisonText(all_);
  if (writes) output->results += "\nFiles:\n";
  for (const std::string& file : written_) output->results += "  " + file + "\n";
  return Judge(output);
}

bool Comparison::RunOne(size_t index, Progress* progress, ComparisonResult* result,
                        std::string* error) {
  const InterruptibleRun interruptible;
  const auto num_problems = static_cast<double>(contests_.size());
  std::string running;
  double begin = 0.0;
  double part = 0.0;
  ComparisonSpec spec = spec_;
  spec.problems = {spec_.problems[index]};
  spec.progress = [&](int done, int total, const std::string& text) {
    part = 1.0 / total / num_problems;
    begin = index / num_problems + done * part;
    running = text;
    progress->Show(begin, running);
  };
  spec.run.progress = [&](const TraceRow& row) {
    if (!progress->IsDue()) return;
    const double of_run = std::min(1.0, row.seconds / spec.run.max_seconds);
    progress->Show(begin + part * of_run, running + ", iteration " + std::to_string(row.iteration));
  };
  return Compare(spec, result, error);
}

bool Comparison::HasFigures(const std::string& problem) const {
  const std::vector<std::string> files = FigureFiles(problem);
  std::error_code ignored;
  return std::all_of(files.begin(), files.end(), [&ignored](const std::string& file) {
    return std::filesystem::is_regular_file(file, ignored);
  });
}

void Comparison::Add(size_t index, ComparisonResult result) {
  for (ComparisonRow& row : result.rows) {
    row.problem_index = static_cast<int>(index);
    // Traces are in the figures by now; those of many problems would fill the memory.
    row.run.trace = {};
    row.excess_energies = {};
    all_.rows.push_back(std::move(row));
  }
  all_.problems.push_back(contests_[index].problem);
  all_.minimum_energies.push_back(result.minimum_energies.empty() ? std::nan("")
                                                                  : result.minimum_energies[0]);
  for (std::string& sentence : result.disagreements) {
    all_.disagreements.push_back(std::move(sentence));
  }
}

bool Comparison::WriteFigures(const ComparisonResult&, std::string*) { return true; }  // TODO

bool Comparison::WriteTables(std::string* error) {
  const std::string texts[] = {ComparisonCsv(all_), ComparisonJson(all_), ComparisonMarkdown(all_),
                               ComparisonLatex(all_)};
  for (size_t i = 0; i < kTableEndings.size(); ++i) {
    const std::string path = InFolder("table." + kTableEndings[i]);
    if (!WriteFileAtomically(path, texts[i], error)) return false;
    written_.push_back(path);
  }
  written_.push_back(InFolder("cells.jsonl"));
  for (const Contest& contest : contests_) {
    if (!FLAGS_figures) break;
    for (const std::string& file : FigureFiles(contest.entry.name)) written_.push_back(file);
  }
  return true;
}

int Comparison::Judge(CommandOutput* output) const {
  if (!all_.disagreements.empty()) {
    output->error = "solvers disagree: " + all_.disagreements.front();
    return kDisagreement;
  }
  for (const ComparisonRow& row : all_.rows) {
    if (!row.report.audited || row.report.verdict.holds) continue;
    output->error = "audit: " + row.problem + ": " + row.solver + " " + row.report.verdict.failure;
    return kDisagreement;
  }
  for (const ComparisonRow& row : all_.rows) {
    if (!FLAGS_strict || !row.run.skipped.empty()) continue;
    if (ReachedTarget(row.run, spec_.run, row.report)) continue;
    output->error = row.problem + ": " + NotReachedMessage(row.run, spec_.run);
    return kNotReached;
  }
  return kDone;
}

int RunCompare(const std::vector<std::string>& positional, CommandOutput* output) {
  if (!positional.empty()) {
    return Refuse("compare: found " + positional.front() +
                      "; allowed: flags, as in --problems=" + FLAGS_problems,
                  output);
  }
  std::string* const error = &output->error;
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
  if (WasGiven("out") && !PrepareFolder(contests, error)) return kBadInput;
  for (const Contest& contest : contests) spec.problems.push_back(contest.written);
  return Comparison(std::move(contests), std::move(spec)).Run(output);
}

}  // namespace

Command CompareCommand() {
  Command command;
  command.name = "compare";
  command.summary = "runs solvers on problems and prints one table";
  command.details = {
      "Writes OUT/table.csv, .json, .md and .tex, OUT/cells.jsonl (one row per problem and solver, "
      "written as each problem is finished), and for each problem OUT/PROBLEM_convergence and "
      "OUT/PROBLEM_fit: .svg with the gnuplot script (.gp) and the data (.dat) behind it. Rows are "
      "explained in docs/formats.md. Lengths are in the unit of the data, E in its square.",
      "Exit status 3: a claim failed its audit, or solvers that must agree do not. A solver that "
      "fails is a row, and counts only with --strict."};
  command.examples = {
      "batten compare --problems=rhino,squirrel,dolphin,cat --solvers=all --out=out/compare",
      "batten compare --problems=rhino --solvers=lbfgs/memory=5,cg --repetitions=1"};
  command.flags = {TextFlag("problems", "LIST"), TextFlag("solvers", "LIST"),
                   NumberFlag("repetitions", "N", 1.0, 1000.0)};
  for (FlagInfo& flag : RunFlags()) command.flags.push_back(std::move(flag));
  command.flags.push_back(
      TextFlag("out", "FOLDER",
               "Folder for tables and figures, created if missing. Not given: only the "
               "table is printed."));
  for (const char* name : {"figures", "resume", "strict", "quiet"}) {
    command.flags.push_back(SwitchFlag(name));
  }
  command.run = &RunCompare;
  return command;
}

}  // namespace batten
