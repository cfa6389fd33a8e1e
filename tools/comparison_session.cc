#include "tools/comparison_session.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "experiments/atomic_file.h"
#include "experiments/comparison_tables.h"
#include "experiments/figures.h"
#include "experiments/fit_plot.h"
#include "experiments/plot_file.h"
#include "tools/fit_summary.h"
#include "tools/interrupts.h"
#include "tools/output_files.h"
#include "tools/run_records.h"

namespace batten {
namespace {

/// The lowest energy; of several that are equal up to rounding the direct answer's, which the
/// others are held against, or else the first. Null if nobody has an answer.
const ComparisonRow* BestRow(const ComparisonResult& result) {
  constexpr double kRounding = 1e-9;
  const ComparisonRow* best = nullptr;
  for (const ComparisonRow& row : result.rows) {
    if (!row.run.skipped.empty() || !std::isfinite(row.run.energy)) continue;
    if (best == nullptr || row.run.energy < (1.0 - kRounding) * best->run.energy) best = &row;
  }
  for (const ComparisonRow& row : result.rows) {
    const bool is_direct = row.run.solver.name == "banded_qr" && row.run.skipped.empty();
    if (best != nullptr && is_direct && row.run.energy <= (1.0 + kRounding) * best->run.energy) {
      return &row;
    }
  }
  return best;
}

}  // namespace

ComparisonSession::ComparisonSession(std::vector<Contest> contests, ComparisonSpec spec,
                                     ComparisonFiles files)
    : contests_(std::move(contests)),
      spec_(std::move(spec)),
      files_(std::move(files)),
      cells_(InFolder("cells.jsonl")) {
  all_.spec = spec_;
}

std::string ComparisonSession::InFolder(const std::string& name) const {
  return (std::filesystem::path(files_.folder) / name).string();
}

std::vector<std::string> ComparisonSession::TableFiles() const {
  return {InFolder("table.csv"), InFolder("table.json"), InFolder("table.md"),
          InFolder("table.tex")};
}

std::vector<std::string> ComparisonSession::FigureFiles(const std::string& problem) const {
  std::vector<std::string> files = {InFolder(problem + "_fit.plot.json")};
  for (const char* kind : {"_convergence", "_fit"}) {
    for (const char* ending : {".svg", ".gp", ".dat"}) {
      files.push_back(InFolder(problem + kind + ending));
    }
  }
  return files;
}

bool ComparisonSession::Prepare(std::string* error) const {
  if (files_.folder.empty()) return true;
  if (!CheckName({"out", files_.folder}, error)) return false;
  if (!CreateDirectories(files_.folder, error)) {
    *error = "--out: " + *error;
    return false;
  }
  std::vector<OutputFile> outputs = {{"out", InFolder("cells.jsonl")}};
  for (const std::string& file : TableFiles()) outputs.push_back({"out", file});
  std::vector<std::string> inputs;
  for (const Contest& contest : contests_) {
    inputs.insert(inputs.end(), {contest.entry.path, contest.entry.data_path});
    if (!files_.figures) continue;
    for (const std::string& file : FigureFiles(contest.entry.name)) {
      outputs.push_back({"out", file});
    }
  }
  return CheckOutputs(outputs, inputs, error) && CheckRunRecords(files_.folder, spec_, error);
}

int ComparisonSession::Run(CommandOutput* output) {
  const bool writes = !files_.folder.empty();
  if (writes && files_.resume) cells_.Read();
  Progress progress(files_.quiet);
  for (size_t i = 0; i < contests_.size(); ++i) {
    ComparisonResult result;
    if (!RunOrTakeOver(i, &progress, &result, &output->error)) return kBadInput;
    if (result.interrupted) return EndEarly(i, output);
    Add(i, std::move(result));
  }
  if (writes && !WriteTables(&output->error)) return kBadInput;
  output->results = ComparisonText(all_);
  for (const std::string& note : notes_) output->results += note + "\n";
  if (writes) output->results += FileList();
  return Judge(output);
}

/// The tables of what is finished: older ones in the folder would show other rows than cells.jsonl.
int ComparisonSession::EndEarly(size_t num_finished, CommandOutput* output) {
  const bool has_tables = !files_.folder.empty() && num_finished > 0;
  all_.interrupted = true;
  if (has_tables && !WriteTables(&output->error)) return kInterruptedStatus;
  if (num_finished > 0) output->results = ComparisonText(all_);
  output->error = "interrupted after " + std::to_string(num_finished) + " of " +
                  std::to_string(contests_.size()) + " problems" +
                  (has_tables ? "; go on with --resume" : "");
  return kInterruptedStatus;
}

bool ComparisonSession::RunOrTakeOver(size_t index, Progress* progress, ComparisonResult* result,
                                      std::string* error) {
  const CatalogueEntry& entry = contests_[index].entry;
  const bool has_figures =
      !files_.figures || (HasFigures(entry.name) && cells_.AreLast(entry, spec_));
  if (files_.resume && has_figures && cells_.Find(entry, spec_, result) &&
      HasRunRecords(entry, *result, spec_, files_.folder)) {
    return true;
  }
  *result = {};
  if (!RunOne(index, progress, result, error)) return false;
  return files_.folder.empty() || result->interrupted || WriteProblem(index, *result, error);
}

bool ComparisonSession::WriteProblem(size_t index, const ComparisonResult& result,
                                     std::string* error) {
  const CatalogueEntry& entry = contests_[index].entry;
  FileBatch batch;
  // Until all is done the tables of an earlier run, which hold other rows, are gone.
  for (const std::string& file : TableFiles()) batch.Remove(file);
  if (files_.figures) {
    if (!DrawFigures(result, &batch, error)) return false;
  } else {
    // Those of an earlier run would show other rows.
    for (const std::string& file : FigureFiles(entry.name)) batch.Remove(file);
  }
  return WriteRunRecords(entry, result, files_.folder, &batch, error) &&
         cells_.Append(entry, result, &batch, error) && batch.Commit(error);
}

bool ComparisonSession::RunOne(size_t index, Progress* progress, ComparisonResult* result,
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

bool ComparisonSession::HasFigures(const std::string& problem) const {
  const std::vector<std::string> files = FigureFiles(problem);
  std::error_code ignored;
  return std::all_of(files.begin(), files.end(), [&ignored](const std::string& file) {
    return std::filesystem::is_regular_file(file, ignored);
  });
}

void ComparisonSession::Add(size_t index, ComparisonResult result) {
  for (ComparisonRow& row : result.rows) {
    row.problem_index = static_cast<int>(index);
    // Traces are in their files by now; those of many problems would fill the memory.
    row.run.trace = {};
    row.run.iterates = {};
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

bool ComparisonSession::DrawFigures(const ComparisonResult& result, FileBatch* batch,
                                    std::string* error) {
  const std::string& problem = result.rows.front().problem;
  const std::string fit_stem = InFolder(problem + "_fit");
  const ComparisonRow* best = BestRow(result);
  const FigureResult figures[] = {
      ConvergenceFigure(RowsOfProblem(result, 0), InFolder(problem + "_convergence"), batch),
      best == nullptr ? NoFigure(fit_stem, problem + ": no solver has an answer", batch)
                      : FitFigure(*result.problems[0], best->run, fit_stem, batch)};
  for (const FigureResult& figure : figures) {
    if (IsWriteError(figure)) {
      *error = figure.message;
      return false;
    }
    if (!figure.drawn) notes_.push_back("no figure: " + figure.message);
    if (figure.written && !figure.drawn && not_drawn_.empty()) not_drawn_ = figure.message;
  }
  // For the page of batten report, whose plots zoom and show values.
  const std::string numbers = fit_stem + ".plot.json";
  const std::vector<PlotPanel> panels =
      best == nullptr ? std::vector<PlotPanel>() : FitPanels(*result.problems[0], best->run);
  if (panels.empty()) {
    batch->Remove(numbers);
    return true;
  }
  return batch->Write(numbers, PlotJson(panels, static_cast<int>(panels.size())), error) != nullptr;
}

bool ComparisonSession::WriteTables(std::string* error) const {
  const std::string texts[] = {ComparisonCsv(all_), ComparisonJson(all_), ComparisonMarkdown(all_),
                               ComparisonLatex(all_)};
  const std::vector<std::string> files = TableFiles();
  for (size_t i = 0; i < files.size(); ++i) {
    if (!WriteFileAtomically(files[i], texts[i], error)) return false;
  }
  return true;
}

std::string ComparisonSession::FileList() const {
  std::string text = "\nFiles:\n";
  for (const std::string& file : TableFiles()) text += "  " + file + "\n";
  text += "  " + InFolder("cells.jsonl") + "  (traces beside it; batten report " + files_.folder +
          " shows all)\n";
  std::error_code ignored;
  for (const Contest& contest : contests_) {
    if (!files_.figures) break;
    for (const std::string& file : FigureFiles(contest.entry.name)) {
      const bool is_picture = std::filesystem::path(file).extension() == ".svg";
      if (!is_picture || !std::filesystem::exists(file, ignored)) continue;
      text += "  " + file + "  (.gp and .dat beside it)\n";
    }
  }
  return text;
}

int ComparisonSession::Judge(CommandOutput* output) const {
  if (!all_.disagreements.empty()) {
    output->error = "solvers disagree: " + all_.disagreements.front();
    return kDisagreement;
  }
  for (const ComparisonRow& row : all_.rows) {
    if (!row.report.audited || row.report.verdict.holds) continue;
    output->error = "audit: " + row.problem + ": " + row.solver + " " + row.report.verdict.failure;
    return kDisagreement;
  }
  if (!not_drawn_.empty()) return Refuse("--figures: " + not_drawn_ + ", or --nofigures", output);
  for (const ComparisonRow& row : all_.rows) {
    if (!files_.strict || !row.run.skipped.empty()) continue;
    if (ReachedTarget(row.run, spec_.run, row.report)) continue;
    output->error = row.problem + ": " + NotReachedMessage(row.run, spec_.run);
    return kNotReached;
  }
  return kDone;
}

}  // namespace batten
