#ifndef BATTEN_EXPERIMENTS_REPRODUCTION_H_
#define BATTEN_EXPERIMENTS_REPRODUCTION_H_

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "experiments/csv_table.h"
#include "experiments/plot.h"
#include "experiments/run_recorder.h"

namespace batten {

/// The tables of one experiment by name: "" is the main one, NAME.csv; "traces" is NAME_traces.csv.
using ExperimentTables = std::map<std::string, CsvTable>;

enum class ClaimVerdict { kHolds, kInPart, kDoesNotHold, kUndecided };
/// "holds", "holds in part", "does not hold", "undecided".
const char* ToString(ClaimVerdict verdict);

struct Judgement {
  ClaimVerdict verdict = ClaimVerdict::kUndecided;
  std::string because;  ///< The figures that decided, in one sentence.
};

/// A claim of a source, and the rule that judges it from the tables alone.
struct SourceClaim {
  std::string quote;  ///< One phrase: the source's figures, or what it says, not word for word.
  std::string place;  ///< Where it stands there: "Table 1".
  std::string rule;   ///< What `judge` computes, in words.
  std::function<Judgement(const ExperimentTables&)> judge;
};

struct ExperimentFigure {
  std::string name;     ///< Of the files: NAME.svg, .gp, .dat, .plot.json.
  std::string caption;  ///< What is to be seen.
  int columns = 2;      ///< Panels side by side.
  std::function<std::vector<PlotPanel>(const ExperimentTables&)> panels;
};

/// What an experiment knows of the command around it.
struct ExperimentRun {
  int repetitions = 5;  ///< Times are medians of so many runs.
  /// Told before each part of the work: this fraction is done; may be empty.
  std::function<void(double fraction, const std::string& text)> progress;
  RunRecorder* recorder = nullptr;  ///< Keeps the runs of solvers; may be null.
};

/// A list of runs whose results are tables, and what is read from them. Runs that must fail (a
/// method outside its condition) are rows like others.
struct Experiment {
  std::string name;  ///< Of files and on the command line: letters, digits, `_`.
  std::string title;
  std::string text;  ///< Markdown: what is run, on what data, by what rule.
  /// False with one sentence in `error` where data are missing. Ends early, with what it has, once
  /// InterruptRequested().
  std::function<bool(const ExperimentRun&, ExperimentTables*, std::string* error)> run;
  /// The table shown on the page; empty function: the main one.
  std::function<CsvTable(const ExperimentTables&)> shown;
  std::vector<SourceClaim> claims;
  std::vector<ExperimentFigure> figures;
};

struct Reproduction {
  std::string name;
  std::string title;
  std::string source;        ///< Citation.
  std::string introduction;  ///< Markdown.
  std::vector<Experiment> experiments;
};

/// The table of reproductions; null for an unknown name.
const std::vector<Reproduction>& Reproductions();
const Reproduction* FindReproduction(const std::string& name);

/// An experiment with its tables, as the page shows it.
struct ExperimentResult {
  const Experiment* experiment = nullptr;
  ExperimentTables tables;
  std::vector<Judgement> judgements;   ///< One per claim.
  std::vector<std::string> not_drawn;  ///< Per figure: empty, or why there is no picture.
  bool taken_over = false;             ///< From an earlier run's CSV files.
};

struct ReproductionSpec {
  std::string folder;
  std::vector<std::string> only;  ///< Names of experiments; empty: all.
  bool resume = false;            ///< Take over what an earlier run of this program has finished.
  ExperimentRun run;
};

struct ReproductionResult {
  std::vector<ExperimentResult> experiments;
  bool interrupted = false;
};

/// Runs the experiments; after each its runs, CSV files and figures are written, at the end NAME.md
/// and NAME.html (which needs no other file). False with one sentence in `error`.
bool Reproduce(const Reproduction& reproduction, const ReproductionSpec& spec,
               ReproductionResult* result, std::string* error);

/// Judges all claims of an experiment.
std::vector<Judgement> JudgeClaims(const Experiment& experiment, const ExperimentTables& tables);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_REPRODUCTION_H_
