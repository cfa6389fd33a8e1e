#ifndef BATTEN_TESTS_EXPERIMENTS_HAND_MADE_BENCH_H_
#define BATTEN_TESTS_EXPERIMENTS_HAND_MADE_BENCH_H_

#include <sstream>
#include <string>
#include <vector>

#include "experiments/bench_results.h"
#include "tests/problems/scratch_folder.h"

namespace batten {

/// A row of a trace as far as targets look at it.
struct TracePoint {
  int evaluations = 0;
  double seconds = 0.0;
  double energy = 0.0;
};

/// Results of `bench` written down by hand.
class HandMadeBench {
 public:
  explicit HandMadeBench(const std::vector<double>& gaps) {
    data_.folder = folder_.path();
    data_.manifest = {{"format", "batten.manifest/1"}, {"suite", "by hand"}, {"gap_targets", gaps}};
  }

  /// With a direct answer, unless `minimum` is null.
  nlohmann::json& AddInstance(const std::string& problem, const nlohmann::json& minimum) {
    nlohmann::json& instance = data_.instances["instance " + problem];
    instance = {{"num_variables", 4},        {"evaluation_seconds", 0.1},
                {"reference_seconds", 2e-4}, {"minimum_energy", minimum},
                {"truth_energy", nullptr},   {"noise", 0.0}};
    return instance;
  }

  /// A repetition that ran; E at the start and at the end are those of the trace. The row may be
  /// changed until the next one is added.
  nlohmann::json& AddRun(const std::string& problem, const std::string& solver,
                         const std::vector<TracePoint>& trace) {
    nlohmann::json& row = AddRow(problem, solver, "gradient_small");
    row["trace_rows"] = trace.size();
    row["iterations"] = trace.size() - 1;
    row["start_energy"] = trace.front().energy;
    row["energy"] = trace.back().energy;
    row["seconds"] = trace.back().seconds;
    row["energy_calls"] = trace.back().evaluations;
    std::ostringstream text;
    text.precision(17);
    text << "iteration,energy_calls,gradient_calls,jacobian_calls,products,projections,seconds,"
            "cpu_seconds,energy,gradient_norm\n";
    for (const TracePoint& point : trace) {
      text << "0," << point.evaluations << ",0,0,0,0," << point.seconds << ",0," << point.energy
           << ",1\n";
    }
    folder_.Write("traces/" + row["key"].get<std::string>() + ".csv", text.str());
    return row;
  }

  /// A repetition without a result: "crashed", "wall_limit", or "skipped".
  nlohmann::json& AddRow(const std::string& problem, const std::string& solver,
                         const std::string& stop) {
    const std::string key = "key" + std::to_string(data_.rows.size());
    data_.rows.push_back({{"key", key},
                          {"problem", problem},
                          {"terms", "own"},
                          {"solver", solver},
                          {"seed", 1},
                          {"parameter_kind", "fixed"},
                          {"instance", "instance " + problem},
                          {"stop", stop},
                          {"message", ""},
                          {"trace_rows", 0},
                          {"overlapped", false}});
    return data_.rows.back();
  }

  BenchResults Results() {
    data_.num_cells = data_.rows.size();
    return CollectResults(data_);
  }
  const ScratchFolder& folder() const { return folder_; }

 private:
  ScratchFolder folder_;
  BenchData data_;
};

}  // namespace batten

#endif  // BATTEN_TESTS_EXPERIMENTS_HAND_MADE_BENCH_H_
