// What the runner of scripted benchmarks costs beside the cells it runs: their process, its answer,
// and the line in the file. Targets: below 5 ms for a cell that does nothing, below 2 % of a cell
// of one second.
#include <benchmark/benchmark.h>
#include <poll.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>

#include "experiments/bench_store.h"
#include "experiments/child_process.h"

namespace batten {
namespace {

double Seconds(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// A cell that takes so much wall time, and answers with what a row has; returns all of its time
/// less its own.
double CostOfCell(double seconds, AppendOnlyFile* file) {
  constexpr std::size_t kRow = 2500;  // bytes
  std::string error;
  double own = 0.0;
  const double all = Seconds([&] {
    const auto child = ChildProcess::Start(
        {60.0, 60.0, 4096}, "/dev/null",
        [seconds] {
          const double spent = Seconds([seconds] {
            for (double left = seconds; left > 0.0;) left -= Seconds([] {});
          });
          std::string row = std::to_string(spent);
          row.resize(kRow, ' ');
          return row;
        },
        &error);
    for (bool ended = child == nullptr; !ended;) {
      pollfd ready = {child->file(), POLLIN, 0};
      poll(&ready, 1, 100);
      ended = child->Attend();
    }
    const std::string row = child->Finish().answer;
    own = std::strtod(row.c_str(), nullptr);
    file->Append(row, &error);
  });
  return all - own;
}

void BM_RunnerCost(benchmark::State& state) {
  const double seconds = 1e-3 * static_cast<double>(state.range(0));
  const std::string path =
      std::filesystem::temp_directory_path() / ("runner_benchmark_" + std::to_string(getpid()));
  std::string error;
  double cost = 0.0;
  {
    AppendOnlyFile file;
    file.Open(
        path, [](const std::string&) {}, &error);
    for (auto _ : state) {
      const double one = CostOfCell(seconds, &file);
      cost += one;
      state.SetIterationTime(seconds + one);
    }
  }
  unlink(path.c_str());
  const double mean = cost / static_cast<double>(state.iterations());
  state.counters["cost_ms"] = 1e3 * mean;
  if (seconds > 0.0) state.counters["cost_percent"] = 100.0 * mean / seconds;
}
BENCHMARK(BM_RunnerCost)
    ->ArgName("cell_ms")
    ->Arg(0)
    ->Arg(1000)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace batten

BENCHMARK_MAIN();
