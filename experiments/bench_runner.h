#ifndef BATTEN_EXPERIMENTS_BENCH_RUNNER_H_
#define BATTEN_EXPERIMENTS_BENCH_RUNNER_H_

#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/bench_cell.h"
#include "experiments/bench_records.h"
#include "experiments/bench_store.h"
#include "experiments/machine_use.h"

namespace batten {

/// Runs the cells that are not finished yet, each in its own process, and keeps what is finished.
class BenchRunner {
 public:
  /// Told now and then, and before each cell; seconds_left is NaN before anything is known.
  using Progress =
      std::function<void(int done, int total, double seconds_left, const std::string& running)>;

  /// `suite` must outlive this. `jobs` cells at once; with more than 1 all are marked overlapped,
  /// as are those beside which another program measured on this machine (MachineUse).
  BenchRunner(const BenchSuite& suite, std::vector<BenchCell> cells, BenchFolder folder, int jobs);

  /// Makes the folders, takes over what is finished. False with one sentence in `error`.
  bool Open(std::string* error);
  /// False with one sentence in `error` where something cannot be written or no process made; what
  /// is finished stays. Ends early, with true, once InterruptRequested().
  bool Run(const Progress& progress, std::string* error);

  std::size_t num_cells() const { return cells_.size(); }
  std::size_t num_finished() const { return rows_.size(); }
  std::size_t num_taken_over() const { return num_taken_over_; }
  /// Of finished cells, in the order of the matrix; null where one is not finished.
  std::vector<const nlohmann::json*> Rows() const;
  /// By instance key.
  const std::map<std::string, nlohmann::json>& instances() const { return instances_; }
  const std::vector<BenchCell>& cells() const { return cells_; }

 private:
  struct Running {
    std::size_t cell = 0;
    std::unique_ptr<ChildProcess> process;
    bool overlapped = false;
  };
  void TakeOver(const std::string& line);
  BenchRecords RecordsOf(std::size_t cell) const;
  bool MeasureInstances(const Progress& progress, std::string* error);
  bool MeasureOne(const BenchCell& cell, const std::string& key, std::string* error);
  bool StartNext(std::vector<Running>* running, std::string* error);
  void LookForOthers(std::vector<Running>* running) const;
  bool Attend(std::vector<Running>* running, const Progress& progress, std::string* error);
  bool FinishCell(const Running& ended, ChildEnd end, std::string* error);
  void Tell(const Progress& progress, const std::vector<Running>& running) const;
  std::string MessageOf(const ChildEnd& end, const std::string& log) const;

  const BenchSuite& suite_;
  MachineUse machine_;
  std::vector<BenchCell> cells_;
  std::vector<std::string> keys_;  // of the cells
  BenchFolder folder_;
  int jobs_;
  AppendOnlyFile cell_file_;
  AppendOnlyFile instance_file_;
  std::map<std::string, nlohmann::json> rows_;  // by key
  std::map<std::string, nlohmann::json> instances_;
  std::map<std::string, std::size_t> wanted_;  // key to cell
  std::size_t num_taken_over_ = 0;
  std::size_t next_ = 0;
  double started_ = 0.0;
  std::size_t finished_at_start_ = 0;
};

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_BENCH_RUNNER_H_
