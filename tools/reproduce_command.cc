#include <gflags/gflags.h>

#include <algorithm>

#include "experiments/atomic_file.h"
#include "experiments/reproduction.h"
#include "tools/command.h"
#include "tools/interrupts.h"
#include "tools/output_files.h"
#include "tools/progress.h"
#include "tools/run_flags.h"

DECLARE_string(out);
DECLARE_bool(quiet);
DECLARE_bool(resume);
DECLARE_int32(repetitions);
DEFINE_string(only, "", "Experiments to run, separated by commas. Not given: all.");

namespace batten {
namespace {

std::vector<std::string> ReproductionNames() {
  std::vector<std::string> names;
  for (const Reproduction& reproduction : Reproductions()) names.push_back(reproduction.name);
  return names;
}

std::string KnownReproductions() {
  std::string text;
  for (const std::string& name : ReproductionNames()) text += (text.empty() ? "" : ", ") + name;
  return text;
}

bool ChosenExperiments(const Reproduction& reproduction, std::vector<std::string>* only,
                       std::string* error) {
  if (!WasGiven("only")) return true;
  std::vector<std::string> known;
  for (const Experiment& experiment : reproduction.experiments) known.push_back(experiment.name);
  for (const std::string& name : SplitAtCommas(FLAGS_only)) {
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      *error = "--only: " + UnknownNameMessage("experiment", name, known);
      return false;
    }
    if (std::find(only->begin(), only->end(), name) == only->end()) only->push_back(name);
  }
  return true;
}

/// Makes the folder and tries the files in it, before anything runs.
bool Prepare(const Reproduction& reproduction, const ReproductionSpec& spec, std::string* error) {
  if (!CheckName({"out", spec.folder}, error)) return false;
  if (!CreateDirectories(spec.folder, error)) {
    *error = "--out: " + *error;
    return false;
  }
  std::vector<OutputFile> outputs = {{"out", spec.folder + "/" + reproduction.name + ".md"},
                                     {"out", spec.folder + "/" + reproduction.name + ".html"},
                                     {"out", spec.folder + "/cells.jsonl"}};
  for (const Experiment& experiment : reproduction.experiments) {
    outputs.push_back({"out", spec.folder + "/" + experiment.name + ".csv"});
  }
  return CheckOutputs(outputs, {}, error);
}

/// Two lines per claim: its verdict, and what decided.
std::string VerdictLines(const ReproductionResult& result) {
  std::string text;
  for (const ExperimentResult& experiment : result.experiments) {
    text += experiment.experiment->title + (experiment.taken_over ? " (taken over)" : "") + "\n";
    for (std::size_t k = 0; k < experiment.judgements.size(); ++k) {
      const Judgement& judgement = experiment.judgements[k];
      text += "  " + experiment.experiment->claims[k].quote + ": " + ToString(judgement.verdict) +
              "\n    " + judgement.because + "\n";
    }
  }
  return text;
}

int RunReproduce(const std::vector<std::string>& positional, CommandOutput* output) {
  std::string* const error = &output->error;
  if (positional.size() != 1) {
    return Refuse("reproduce: found " + std::to_string(positional.size()) +
                      " names; allowed: one of " + ReproductionNames().front(),
                  output);
  }
  const Reproduction* reproduction = FindReproduction(positional.front());
  if (reproduction == nullptr) {
    return Refuse(UnknownNameMessage("reproduction", positional.front(), ReproductionNames()),
                  output);
  }
  ReproductionSpec spec;
  spec.folder = WasGiven("out") ? FLAGS_out : "out/" + reproduction->name;
  spec.resume = FLAGS_resume;
  spec.run.repetitions = FLAGS_repetitions;
  if (!ChosenExperiments(*reproduction, &spec.only, error)) return kBadInput;
  if (!Prepare(*reproduction, spec, error)) return kBadInput;
  ReproductionResult result;
  {
    const InterruptibleRun interruptible;
    Progress progress(FLAGS_quiet);
    spec.run.progress = [&progress](double fraction, const std::string& text) {
      progress.Show(fraction, text);
    };
    if (!Reproduce(*reproduction, spec, &result, error)) return kBadInput;
  }
  if (result.interrupted) {
    *error = "interrupted after " + std::to_string(result.experiments.size()) +
             " experiments; go on with --resume";
    return kInterruptedStatus;
  }
  output->results = VerdictLines(result) + "\nPage: " + spec.folder + "/" + reproduction->name +
                    ".html, .md; figures and the CSV files behind them beside it\n";
  for (const ExperimentResult& experiment : result.experiments) {
    for (const std::string& why : experiment.not_drawn) {
      if (!why.empty()) return Refuse(why, output);
    }
  }
  return kDone;
}

}  // namespace

Command ReproduceCommand() {
  Command command;
  command.name = "reproduce";
  command.arguments = "NAME";
  command.summary = "runs a paper's experiments again and judges its claims";
  command.details = {
      "Writes OUT/NAME.html (one file, pictures put in), OUT/NAME.md, and for each experiment its "
      "CSV files and figures: .svg with the gnuplot script (.gp) and the data (.dat) behind it. "
      "Runs of solvers are kept as compare keeps them: cells.jsonl, traces/, iterates/; batten "
      "report OUT makes a page of all. "
      "Each verdict is computed from the CSV by the rule stated beside it. Runs that an experiment "
      "expects to fail are no failures.",
      "Reproductions: " + KnownReproductions() + "."};
  command.examples = {"batten reproduce accelerated-gim --out=out/accelerated-gim",
                      "batten reproduce accelerated-gim --only=figure_1 --repetitions=1"};
  FlagInfo repetitions = NumberFlag("repetitions", "N", 1.0, 1000.0);
  repetitions.help = "Runs of each solver, one after the other; times are medians.";
  command.flags = {
      TextFlag("only", "LIST", "names of experiments, separated by commas"), repetitions,
      TextFlag("out", "FOLDER", "a folder",
               "Folder for page, figures and CSV files, created if missing. Not given: "
               "out/NAME."),
      SwitchFlag("resume"), SwitchFlag("quiet")};
  command.run = &RunReproduce;
  return command;
}

}  // namespace batten
