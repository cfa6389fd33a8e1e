#include "experiments/reproduction.h"

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "experiments/accelerated_gim.h"
#include "experiments/anderson_paper.h"
#include "experiments/atomic_file.h"
#include "experiments/bezier_paper.h"
#include "experiments/build_info.h"
#include "experiments/fairing_paper.h"
#include "experiments/plot_file.h"
#include "experiments/reproduction_page.h"
#include "experiments/run.h"
#include "problems/input_file.h"

namespace batten {
namespace {

std::string InFolder(const ReproductionSpec& spec, const std::string& name) {
  return (std::filesystem::path(spec.folder) / name).string();
}

/// First line of each CSV file: one of another build or experiment is not taken over.
std::string Stamp(const Reproduction& reproduction, const Experiment& experiment,
                  const ReproductionSpec& spec) {
  return "# batten reproduce " + reproduction.name + " " + experiment.name + "; version " +
         kVersion + " (" + kGitCommit + "), repetitions " + std::to_string(spec.run.repetitions);
}

std::string TableFile(const Experiment& experiment, const std::string& table) {
  return experiment.name + (table.empty() ? "" : "_" + table) + ".csv";
}

/// The names of the tables stand in the main one's second line.
bool TakeOver(const Reproduction& reproduction, const Experiment& experiment,
              const ReproductionSpec& spec, ExperimentTables* tables) {
  const std::string stamp = Stamp(reproduction, experiment, spec);
  std::string text, error;
  if (!ReadWholeFile(InFolder(spec, TableFile(experiment, "")), &text, &error)) return false;
  std::istringstream lines(text);
  std::string first, second;
  std::getline(lines, first);
  std::getline(lines, second);
  if (first != stamp || second.rfind("# tables:", 0) != 0) return false;
  std::istringstream names(second.substr(9));
  std::string name;
  if (!CsvTable::FromCsv(text, &(*tables)[""], &error)) return false;
  while (names >> name) {
    if (!ReadWholeFile(InFolder(spec, TableFile(experiment, name)), &text, &error) ||
        text.rfind(stamp + "\n", 0) != 0 || !CsvTable::FromCsv(text, &(*tables)[name], &error)) {
      return false;
    }
  }
  return true;
}

bool WriteTables(const std::string& stamp, const ReproductionSpec& spec,
                 const ExperimentResult& result, FileBatch* batch, std::string* error) {
  std::string names;
  for (const auto& [name, table] : result.tables) names += name.empty() ? "" : " " + name;
  for (const auto& [name, table] : result.tables) {
    const std::string header = stamp + "\n" + (name.empty() ? "# tables:" + names + "\n" : "");
    const std::string path = InFolder(spec, TableFile(*result.experiment, name));
    if (batch->Write(path, header + table.ToCsv(), error) == nullptr) return false;
  }
  return true;
}

bool DrawFigures(const ReproductionSpec& spec, ExperimentResult* result, FileBatch* batch,
                 std::string* error) {
  for (const ExperimentFigure& figure : result->experiment->figures) {
    const FigureResult drawn = DrawPlotForReport(
        InFolder(spec, figure.name), figure.panels(result->tables), figure.columns, batch);
    if (IsWriteError(drawn)) {
      *error = drawn.message;
      return false;
    }
    result->not_drawn.push_back(drawn.drawn ? "" : drawn.message);
  }
  return true;
}

bool IsWanted(const ReproductionSpec& spec, const std::string& name) {
  return spec.only.empty() ||
         std::find(spec.only.begin(), spec.only.end(), name) != spec.only.end();
}

bool RunOne(const Reproduction& reproduction, const Experiment& experiment,
            const ReproductionSpec& spec, ExperimentResult* result, std::string* error) {
  result->experiment = &experiment;
  result->taken_over = spec.resume && TakeOver(reproduction, experiment, spec, &result->tables);
  if (!result->taken_over) {
    result->tables.clear();
    RunRecorder recorder(spec.folder, experiment.name);
    ExperimentRun run = spec.run;
    run.recorder = &recorder;
    if (!experiment.run(run, &result->tables, error)) return false;
    if (InterruptRequested()) return true;
    // First: with tables in its folder an experiment counts as finished.
    if (!recorder.Commit(error)) return false;
  }
  FileBatch batch;
  if (!result->taken_over &&
      !WriteTables(Stamp(reproduction, experiment, spec), spec, *result, &batch, error)) {
    return false;
  }
  if (!DrawFigures(spec, result, &batch, error) || !batch.Commit(error)) return false;
  result->judgements = JudgeClaims(experiment, result->tables);
  return true;
}

}  // namespace

const char* ToString(ClaimVerdict verdict) {
  switch (verdict) {
    case ClaimVerdict::kHolds:
      return "holds";
    case ClaimVerdict::kInPart:
      return "holds in part";
    case ClaimVerdict::kDoesNotHold:
      return "does not hold";
    case ClaimVerdict::kUndecided:
      break;
  }
  return "undecided";
}

const std::vector<Reproduction>& Reproductions() {
  static const auto& reproductions = *new std::vector<Reproduction>{
      AcceleratedGim(), AndersonPaper(), BezierPaper(), FairingPaper()};
  return reproductions;
}

const Reproduction* FindReproduction(const std::string& name) {
  for (const Reproduction& reproduction : Reproductions()) {
    if (reproduction.name == name) return &reproduction;
  }
  return nullptr;
}

std::vector<Judgement> JudgeClaims(const Experiment& experiment, const ExperimentTables& tables) {
  std::vector<Judgement> judgements;
  for (const SourceClaim& claim : experiment.claims) judgements.push_back(claim.judge(tables));
  return judgements;
}

bool Reproduce(const Reproduction& reproduction, const ReproductionSpec& spec,
               ReproductionResult* result, std::string* error) {
  *result = ReproductionResult();
  const std::vector<Experiment>& all = reproduction.experiments;
  const auto count = static_cast<double>(spec.only.empty() ? all.size() : spec.only.size());
  for (const Experiment& experiment : all) {
    if (!IsWanted(spec, experiment.name)) continue;
    ReproductionSpec part = spec;
    if (spec.run.progress) {
      const auto done = static_cast<double>(result->experiments.size());
      part.run.progress = [&spec, &experiment, done, count](double fraction,
                                                            const std::string& text) {
        spec.run.progress((done + fraction) / count, experiment.name + ": " + text);
      };
    }
    ExperimentResult experiment_result;
    if (!RunOne(reproduction, experiment, part, &experiment_result, error)) return false;
    result->interrupted = InterruptRequested();
    if (result->interrupted) return true;
    result->experiments.push_back(std::move(experiment_result));
  }
  return WritePage(reproduction, result->experiments, spec.folder, error);
}

}  // namespace batten
