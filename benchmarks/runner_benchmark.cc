// What the runner of scripted benchmarks costs beside the solvers it runs: all of BenchRunner's
// time less the solver's own seconds. That is the process of a cell, its problem made anew, the
// audit of its end, its trace, its row; not the warm-up, nor what is done once per instance or in
// the first repetition alone: work unit, iterates, polishing, checks of plugins. Targets: below 5
// ms for a cell whose solver does nothing, below 2 % of one whose solver takes a second.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>

#include "experiments/bench_runner.h"
#include "solvers/solver_registry.h"

namespace batten {
namespace {

using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Books its start and then is busy with nothing.
class Idle final : public Solver {
 public:
  static SolverInfo ClassInfo() {
    SolverInfo info;
    info.name = "idle";
    info.summary = "does nothing for a while";
    info.source = "benchmarks/runner_benchmark.cc";
    info.options = {OptionInfo::Real("seconds", 0.0, 0.0, 10.0, "for which it is busy")};
    return info;
  }
  explicit Idle(const OptionValues& options) : seconds_(options.Real("seconds")) {}
  SolverInfo Info() const override { return ClassInfo(); }
  std::string WhyUnsupported(const Objective& /*objective*/) const override { return ""; }

 private:
  Outcome DoMinimize(Objective* /*objective*/, RunContext* context, Eigen::VectorXd* x) override {
    context->Iterate(*x);
    const Clock::time_point begin = Clock::now();
    while (SecondsSince(begin) < seconds_) {
    }
    return {StopReason::kNativeStop, ""};
  }

  double seconds_;
};

/// A folder that is gone at the end.
class Folder {
 public:
  Folder()
      : path_(std::filesystem::temp_directory_path() /
              ("runner_benchmark_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

bool ReadSuite(const Folder& folder, double seconds, int repetitions, BenchSuite* suite,
               std::string* error) {
  const std::string path = folder / "suite.json";
  std::ofstream(path) << R"({"format": "batten.suite/1", "name": "idle", "warm_up": 0,)"
                      << R"("problems": [{"synthetic": "star", "name": "star", "points": 60,)"
                      << R"("control_points": 10}], "solvers": ["idle/seconds=)" << seconds
                      << R"("], "repetitions": )" << repetitions << "}";
  return ReadBenchSuite(path, suite, error);
}

/// Seconds that the runner itself takes, per cell that it has run, and how many these were.
double CostPerCell(const Folder& folder, double seconds, int repetitions, int* cells,
                   std::string* error) {
  BenchSuite suite;
  if (!ReadSuite(folder, seconds, repetitions, &suite, error)) return 0.0;
  const Clock::time_point begin = Clock::now();
  BenchRunner runner(suite, BenchMatrix(suite), {folder / "out"}, 1);
  if (!runner.Open(error) || !runner.Run(nullptr, error)) return 0.0;
  const double all = SecondsSince(begin);
  double own = 0.0;
  for (const nlohmann::json* row : runner.Rows()) {
    if ((*row)["repetition"] != 1) own += (*row)["seconds"].get<double>();
  }
  *cells = static_cast<int>(runner.num_cells() - runner.num_taken_over());
  return (all - own) / *cells;
}

void BM_RunnerCost(benchmark::State& state) {
  const double seconds = 1e-3 * static_cast<double>(state.range(0));
  const int cells = static_cast<int>(state.range(1));
  for (auto _ : state) {
    const Folder folder;
    std::string error;
    int num_run = 0;
    // The work unit of the problem is measured once, with the first repetition.
    CostPerCell(folder, seconds, 1, &num_run, &error);
    const double cost = CostPerCell(folder, seconds, 1 + cells, &num_run, &error);
    if (!error.empty() || num_run != cells) {
      state.SkipWithError(error.empty() ? "cells are missing" : error.c_str());
      return;
    }
    state.SetIterationTime(seconds + cost);
    state.counters["cost_ms"] = 1e3 * cost;
    if (seconds > 0.0) state.counters["cost_percent"] = 100.0 * cost / seconds;
  }
}
BENCHMARK(BM_RunnerCost)
    ->ArgNames({"cell_ms", "cells"})
    ->Args({0, 200})
    ->Args({1000, 10})
    ->Iterations(1)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace batten

int main(int argc, char** argv) {
  batten::SolverRegistry::Global().Register(batten::MakeSolverEntry<batten::Idle>());
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
