#ifndef BATTEN_EXPERIMENTS_RUN_RECORDER_H_
#define BATTEN_EXPERIMENTS_RUN_RECORDER_H_

#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "experiments/comparison_reference.h"
#include "experiments/run.h"

namespace batten {

/// What an experiment knows of one of its runs.
struct RecordedRun {
  std::string label;  ///< Of the problem, as in the experiment's tables.
  std::shared_ptr<const Problem> problem;
  const DirectReference* reference = nullptr;  ///< Of `problem`.
  std::string solver;                          ///< As written, NAME/OPTION=VALUE.
  RunSpec spec;
  double seconds = NAN;        ///< Median over the repetitions.
  double setup_seconds = NAN;  ///< Of the run that has it.
  double times_cholesky = NAN;
  int repetitions = 1;
};

/// Keeps the runs of one experiment of a reproduction as `compare` keeps its own: rows of
/// cells.jsonl, traces/KEY.csv, iterates/KEY.jsonl and curves/INSTANCE.json (docs/formats.md).
class RunRecorder {
 public:
  /// The files are those of `folder`. Nothing is written before Commit().
  RunRecorder(std::string folder, std::string experiment)
      : folder_(std::move(folder)), experiment_(std::move(experiment)) {}

  /// Measures and audits the end of `result`, off the clock; it is as it was afterwards.
  void Add(const RecordedRun& run, RunResult* result);
  /// So many coordinates of control points at most have runs whose iterates are kept.
  static constexpr Eigen::Index kMostCoordinates = 1000;
  /// Whether the iterates of runs on `problem` under `spec` are wanted: of those with a trace.
  static bool WantsIterates(const Problem& problem, const RunSpec& spec);

  /// Writes the files; of cells.jsonl the rows of other experiments stay, and what cannot be read
  /// goes. False with one sentence in `error`.
  bool Commit(std::string* error) const;

 private:
  /// Owners compare by what they own, so that no address is taken for that of a problem that is
  /// gone.
  using KnownProblem = std::weak_ptr<const Problem>;

  std::string NameOf(const RecordedRun& run);
  std::string InstanceOf(const RecordedRun& run);
  void AddIterates(const std::string& key, const RecordedRun& run, const RunResult& result);

  std::string folder_;
  std::string experiment_;
  std::map<KnownProblem, std::string, std::owner_less<KnownProblem>> names_;
  std::map<KnownProblem, std::string, std::owner_less<KnownProblem>> instances_;
  std::map<std::string, int> num_named_;  // problems of one name, runs of one name and solver
  std::vector<std::string> rows_;
  std::map<std::string, std::string> files_;  // by name in the folder; empty: goes
};

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_RUN_RECORDER_H_
